# SPDX-License-Identifier: Apache-2.0
"""The examples in the docstrings of `photonloupe.inspect` give what they say."""

from __future__ import annotations

import doctest
import importlib
import pkgutil
from pathlib import Path

import pytest

import photonloupe as pl

REPOSITORY = Path(__file__).parents[2]
MODULES = ["photonloupe.inspect", *(f"photonloupe.inspect.{m.name}" for m in pkgutil.iter_modules(pl.inspect.__path__))]


@pytest.mark.parametrize("name", MODULES)
def test_examples_run(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(REPOSITORY)
    # By their file: some modules have the name of their function, which the package shows in their place.
    result = doctest.testmod(importlib.import_module(name), optionflags=doctest.NORMALIZE_WHITESPACE)
    assert result.attempted > 0
    assert result.failed == 0
