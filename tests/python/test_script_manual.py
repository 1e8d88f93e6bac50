# SPDX-License-Identifier: Apache-2.0
"""The manual of the language: its tables are the engine's, its examples run."""

from __future__ import annotations

import re

import numpy as np

import photonloupe as pl
from manual_tables import MANUAL, fill_tables


def test_tables_of_the_manual_are_those_of_the_engine() -> None:
    text = MANUAL.read_text(encoding="utf-8")
    assert fill_tables(text) == text, "run tests/python/manual_tables.py"
    assert "getPathVertex(photon, vertex, axis)" in text
    assert "| E004 |" in text


def test_first_example_of_the_manual_runs() -> None:
    example = re.search(r"```c\n(.*?)```", MANUAL.read_text(encoding="utf-8"), re.DOTALL)
    assert example
    photons = pl.PhotonMap.from_arrays(
        positions=np.zeros((1, 3)),
        normals=[[0, 1, 0]],
        power=np.ones((1, 3)),
        path_offsets=[0, 3],
        path_vertices=[[0, 1, 0], [1, 2.5, 0], [0, 0, 0]],
    )
    run = photons.run_script(example[1], scale=2)
    assert run.parameter_names == ("top",)
    assert photons.parameters[0, 0] == 5.0
    assert [row["kind"] for row in pl.compile_script(example[1]).passes] == ["parallel"]
