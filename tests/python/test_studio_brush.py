# SPDX-License-Identifier: Apache-2.0
"""Brushes and lassos: the selection they make is that of a NumPy mask, and every view shows it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from studio_driver import (
    TRAJECTORY,
    aim_loupe,
    borrow,
    change_state,
    crop,
    drag_within,
    find_place,
    open_ring,
    read_state,
    show_panel,
)

AXIS = "Parallel coordinates/{}"


def brush(studio: pl.Studio, name: str, start: float, end: float, keys: str = "") -> None:
    """Drag along an axis between shares of its height, from the top."""
    drag_within(studio, AXIS.format(name), (0.5, start), (0.5, end), keys=keys)


def read_brushes(studio: pl.Studio) -> dict[str, list[list[float]]]:
    return {axis["name"]: axis["brushes"] for axis in read_state(studio)["parallel"]["axes"] if axis["brushes"]}


def mask_brushes(studio: pl.Studio) -> np.ndarray:
    """Or-ed within an axis, and-ed between axes."""
    mask = np.ones(len(studio.photons), dtype=bool)
    for name, intervals in read_brushes(studio).items():
        values = pl.inspect.column(studio.photons, name).values
        mask &= np.any([(values >= low) & (values <= high) for low, high in intervals], axis=0)
    return mask


@pytest.fixture(scope="module")
def opened() -> Iterator[pl.Studio]:
    with open_ring(TRAJECTORY) as studio:
        yield studio


@pytest.fixture
def studio(opened: pl.Studio) -> Iterator[pl.Studio]:
    """Plot all photons of the ring with their trajectories."""
    with borrow(opened, parallel={"source": "all"}) as lent:
        yield lent


def test_brush_selects_what_a_mask_selects(studio: pl.Studio) -> None:
    brush(studio, "x", 0.3, 0.45)
    ((low, high),) = read_brushes(studio)["x"]
    top, bottom = np.max(studio.photons.positions[:, 0]), np.min(studio.photons.positions[:, 0])
    assert low == pytest.approx(top + 0.45 * (bottom - top), abs=0.03)
    assert high == pytest.approx(top + 0.3 * (bottom - top), abs=0.03)
    assert studio.selection is not None
    assert 100 < len(studio.selection) < len(studio.photons) - 100
    np.testing.assert_array_equal(studio.selection, np.flatnonzero(mask_brushes(studio)))


def test_ctrl_adds_an_interval_and_without_it_the_last_replaces_all(studio: pl.Studio) -> None:
    brush(studio, "x", 0.3, 0.4)
    brush(studio, "x", 0.6, 0.7, keys="ctrl")
    assert len(read_brushes(studio)["x"]) == 2
    np.testing.assert_array_equal(studio.selection, np.flatnonzero(mask_brushes(studio)))
    brush(studio, "x", 0.1, 0.2)
    assert len(read_brushes(studio)["x"]) == 1
    np.testing.assert_array_equal(studio.selection, np.flatnonzero(mask_brushes(studio)))


def test_brushes_of_several_axes_are_both_required(studio: pl.Studio) -> None:
    brush(studio, "x", 0.3, 0.6)
    alone = studio.selection
    brush(studio, "up", 0.5, 0.7)
    assert list(read_brushes(studio)) == ["x", "up"]
    assert alone is not None
    assert studio.selection is not None
    assert 0 < len(studio.selection) < len(alone)
    np.testing.assert_array_equal(studio.selection, np.flatnonzero(mask_brushes(studio)))


def test_brush_over_the_loupe_selects_among_its_photons(opened: pl.Studio) -> None:
    with borrow(opened) as studio:
        aim_loupe(studio, (0.0, 0.0, -0.3))
        seen = np.sort(studio.loupe_ids)
        brush(studio, "x", 0.0, 0.5)
        expected = np.intersect1d(seen, np.flatnonzero(mask_brushes(studio)))
        assert 0 < len(expected) < len(seen)
        np.testing.assert_array_equal(studio.selection, expected)


def test_click_on_an_axis_takes_its_brushes_away(studio: pl.Studio) -> None:
    brush(studio, "x", 0.3, 0.6)
    brush(studio, "up", 0.5, 0.7)
    studio.click(*find_place(studio, AXIS.format("x"), 0.5, 0.5))
    assert list(read_brushes(studio)) == ["up"]
    np.testing.assert_array_equal(studio.selection, np.flatnonzero(mask_brushes(studio)))


@pytest.mark.parametrize("mode", ["1", "2", "4", "7"])
def test_selection_lights_up_in_the_view(studio: pl.Studio, mode: str) -> None:
    change_state(studio, view={"map_column": "z"})
    studio.key(mode)
    view = crop(studio, "View/Picture")
    studio.selection = np.arange(0, len(studio.photons), 2)
    studio.frame()
    assert not np.array_equal(crop(studio, "View/Picture"), view)
    studio.selection = None
    studio.frame()
    np.testing.assert_array_equal(crop(studio, "View/Picture"), view)


def test_selection_lights_up_in_the_plots(studio: pl.Studio) -> None:
    plot = crop(studio, "Parallel coordinates/Plot")
    studio.selection = np.arange(len(studio.photons) // 2)
    studio.frame()
    assert not np.array_equal(crop(studio, "Parallel coordinates/Plot"), plot)
    show_panel(studio, "Parameter space")
    chosen = studio.image()
    studio.selection = None
    studio.frame()
    assert not np.array_equal(chosen, studio.image())


def test_unselected_photons_stay_as_context(studio: pl.Studio) -> None:
    """Focus and context: what is not selected is still drawn, in grey."""
    studio.selection = [0]
    studio.frame()
    plot = crop(studio, "Parallel coordinates/Plot")[40:-40].astype(int)
    grey = (np.ptp(plot, axis=2) < 12) & (plot.mean(axis=2) > 40)
    assert grey.mean() > 0.05


def test_watcher_is_called_with_each_selection_and_not_without_a_change(studio: pl.Studio) -> None:
    told: list[np.ndarray | None] = []
    studio.watch_selection(told.append)
    studio.key("2")
    studio.press("Script/Run")
    assert told == []
    studio.selection = [3, 1]
    studio.frame()
    studio.frame()
    assert [None if ids is None else ids.tolist() for ids in told] == [[1, 3]]
    studio.key("ctrl+z")
    studio.frame()
    assert [None if ids is None else ids.tolist() for ids in told] == [[1, 3], None]


def test_watcher_sees_what_a_brush_selects(studio: pl.Studio) -> None:
    told: list[np.ndarray | None] = []
    studio.watch_selection(told.append)
    brush(studio, "x", 0.3, 0.6)
    np.testing.assert_array_equal(told[-1], studio.selection)


def test_escape_selects_nothing_and_undo_brings_it_back(studio: pl.Studio) -> None:
    brush(studio, "x", 0.3, 0.6)
    state, chosen = studio.state, studio.selection
    studio.key("escape")
    assert studio.selection is None
    assert read_brushes(studio) == {}
    studio.key("ctrl+z")
    assert studio.state == state
    np.testing.assert_array_equal(studio.selection, chosen)


def test_one_drag_of_a_brush_is_one_command(studio: pl.Studio) -> None:
    before = studio.state
    brush(studio, "x", 0.3, 0.6)
    studio.key("ctrl+z")
    assert studio.state == before
    assert studio.selection is None


def test_lasso_selects_the_photons_it_encloses(studio: pl.Studio) -> None:
    show_panel(studio, "Parameter space")
    x, y, width, height = (round(value) for value in studio.widget("Parameter space/Plot"))
    left, right, top, bottom = int(0.3 * width), int(0.7 * width), int(0.3 * height), int(0.7 * height)
    studio.mouse_move(x + left, y + top)
    studio.frame()
    studio.mouse_button("left", True)
    studio.frame()
    for column, row in ((right, top), (right, bottom), (left, bottom)):
        studio.mouse_move(x + column, y + row)
        studio.frame()
    studio.mouse_button("left", False)
    studio.frame()
    assert studio.selection is not None
    plot = pl.inspect.scatter(studio.photons, "x", "z", size=(width, height))
    places = np.asarray(studio.photons.positions)[:, [0, 2]]
    ends = np.array([plot.to_data(left, top), plot.to_data(right, bottom)])
    inside = ((places >= ends.min(axis=0)) & (places <= ends.max(axis=0))).all(axis=1)
    assert 100 < inside.sum() < len(places) - 100
    np.testing.assert_array_equal(studio.selection, np.flatnonzero(inside))
    studio.click(x + 0.5 * width, y + 0.5 * height)
    assert studio.selection is None


def test_selection_is_named_and_chosen_again(studio: pl.Studio) -> None:
    studio.selection = [5, 6, 7]
    studio.frame()
    studio.press("Selection/Menu")
    studio.press("Selection/Name")
    studio.type("three")
    studio.press("Selection/Keep")
    assert read_state(studio)["named"] == {"three": [5, 6, 7]}
    studio.key("escape")
    studio.selection = None
    studio.frame()
    if "Selection/three" not in studio.widgets():
        studio.press("Selection/Menu")
    studio.press("Selection/three")
    assert studio.selection is not None
    assert studio.selection.tolist() == [5, 6, 7]


def test_selection_of_python_takes_the_place_of_brushes(studio: pl.Studio) -> None:
    brush(studio, "x", 0.3, 0.6)
    studio.selection = [1, 2]
    studio.key("2")
    assert studio.selection is not None
    assert studio.selection.tolist() == [1, 2]
    assert read_brushes(studio) == {}


@pytest.mark.parametrize("ids", [[-1], [10**9], [0.5], "all"])
def test_wrong_ids_are_refused_and_the_selection_stays(studio: pl.Studio, ids: Any) -> None:
    studio.selection = [4]
    with pytest.raises(pl.PhotonLoupeError):
        studio.selection = ids
    assert studio.selection is not None
    assert studio.selection.tolist() == [4]
