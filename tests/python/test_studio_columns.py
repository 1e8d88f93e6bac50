# SPDX-License-Identifier: Apache-2.0
"""Columns that the studio plots are those of the photons in view, also after a script has run over them again."""

from __future__ import annotations

import json
from collections.abc import Iterator

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene

# "tortuosity" is a column of the paths too: the parameter is then "parameter.tortuosity".
SCRIPT = """
shift = 0;
expose shift range 0, 1
declarePhotonParameter(3, 0, 2, "moved");
declarePhotonParameter(4, 0, 2, "tortuosity");
for (i = 0; i < getNumPhotons(); i++) {
    setPhotonParameter(i, 3, 0.25 + 0.5 * shift);
    setPhotonParameter(i, 4, 0.75 - 0.5 * shift);
}
"""


@pytest.fixture
def studio() -> Iterator[pl.Studio]:
    with pl.Studio(scene=find_scene("ring"), script=SCRIPT, photons=2_000, offscreen=True, size=(900, 600)) as opened:
        opened.frame()
        yield opened


def set_shift(studio: pl.Studio, shift: float) -> None:
    state = json.loads(studio.state)
    state["script"]["values"] = {"shift": shift}
    studio.set_state(json.dumps(state))
    studio.frame()


def count_below_axis_middle(studio: pl.Studio, name: str) -> int:
    """Brush the lower half of an axis from 0 to 1 with the mouse; photons selected."""
    state = json.loads(studio.state)
    axis = {"low": 0.0, "high": 1.0, "is_flipped": False, "is_closed": False, "periods": 1, "brushes": []}
    state["parallel"] |= {"source": "all", "axes": [{"name": "x", **axis}, {"name": name, **axis}]}
    studio.set_state(json.dumps(state))
    studio.frame()
    x, y, width, height = studio.widget(f"Parallel coordinates/{name}")
    studio.drag(x + width / 2, y + height - 1, x + width / 2, y + height / 2)
    assert studio.selection is not None
    count = len(studio.selection)
    studio.command("selection.clear")
    return count


@pytest.mark.parametrize(("name", "first"), [("moved", True), ("parameter.tortuosity", False)])
def test_parameters_are_those_of_the_last_run(studio: pl.Studio, name: str, first: bool) -> None:
    total = len(studio.photons)
    assert count_below_axis_middle(studio, name) == total * first
    set_shift(studio, 1.0)
    assert count_below_axis_middle(studio, name) == total * (not first)
    set_shift(studio, 0.0)
    assert count_below_axis_middle(studio, name) == total * first


def test_what_paths_tell_stays(studio: pl.Studio) -> None:
    expected = int(np.sum(pl.inspect.column(studio.photons, "tortuosity").values <= 0.5))
    before = count_below_axis_middle(studio, "tortuosity")
    set_shift(studio, 1.0)
    assert count_below_axis_middle(studio, "tortuosity") == before
    assert before == pytest.approx(expected, abs=20)  # a pixel of the axis
