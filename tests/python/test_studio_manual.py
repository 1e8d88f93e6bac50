# SPDX-License-Identifier: Apache-2.0
"""The manual of the studio: its keys are the program's, its pictures are there, its panels exist."""

from __future__ import annotations

import re

import pytest

import photonloupe as pl
from manual_tables import STUDIO_MANUAL, fill_tables

TEXT = STUDIO_MANUAL.read_text(encoding="utf-8")
NO_PANEL = "Status line"  # is drawn as "Status"


def test_commands_of_the_manual_are_those_of_the_program() -> None:
    assert fill_tables(TEXT) == TEXT, "run tests/python/manual_tables.py"
    assert all(f"`{name}`" in TEXT for name, _, _ in pl.Studio.commands())


def test_pictures_of_the_manual_are_there_and_all_are_shown() -> None:
    shown = re.findall(r"\(pictures/(studio_\w+\.png)\)", TEXT)
    assert sorted(shown) == sorted(path.name for path in (STUDIO_MANUAL.parent / "pictures").glob("studio_*.png"))


def test_panels_of_the_manual_are_those_that_can_be_exported() -> None:
    table = TEXT[TEXT.index("| panel |") : TEXT.index("Three ways")]
    named = [row.split("|")[1].strip() for row in table.splitlines()[2:] if row]
    with pl.Studio(offscreen=True, size=(200, 150)) as studio:
        for name in named:
            studio.panel(name.replace(NO_PANEL, "Status"), (200, 150))
        with pytest.raises(pl.PhotonLoupeError, match="there is no panel") as refused:
            studio.panel("none")
    assert all(name.replace(NO_PANEL, "Status") in str(refused.value) for name in named)
