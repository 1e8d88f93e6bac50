# SPDX-License-Identifier: Apache-2.0
"""The axes of parallel coordinates: closed, flipped, moved, zoomed, removed, added, the first ones again."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from studio_driver import (
    TRAJECTORY,
    choose,
    crop,
    drag_slider,
    drag_within,
    find_middle,
    find_place,
    move_to,
    open_ring,
    read_state,
    show_panel,
)

FIRST = ["x", "y", "z", "right", "up"]


@pytest.fixture
def studio() -> Any:
    """Plot all photons of the ring with their trajectories."""
    with open_ring(TRAJECTORY) as opened:
        choose(opened, "Parallel coordinates/Source", "all")
        yield opened


def list_axes(studio: pl.Studio) -> list[str]:
    """Name the axes as drawn, from left to right."""
    drawn = {
        name.removeprefix("Parallel coordinates/"): studio.widget(name)
        for name in studio.widgets()
        if name.startswith("Parallel coordinates/") and name[21:22].islower()
    }
    return sorted(drawn, key=lambda name: drawn[name][0] + drawn[name][2] / 2)


def find_axis(studio: pl.Studio, name: str) -> dict[str, Any]:
    return next(axis for axis in read_state(studio)["parallel"]["axes"] if axis["name"] == name)


def open_menu(studio: pl.Studio, name: str) -> None:
    studio.click(*find_place(studio, f"Parallel coordinates/{name}", 0.5, 0.3), "right")


def press_in_menu(studio: pl.Studio, axis: str, entry: str) -> None:
    open_menu(studio, axis)
    studio.press(f"Parallel coordinates/{entry}")
    if f"Parallel coordinates/{entry}" in studio.widgets():
        studio.key("escape")


def test_axes_begin_with_places_and_parameters(studio: pl.Studio) -> None:
    assert list_axes(studio)[:5] == FIRST
    assert read_state(studio)["parallel"]["axes"] == []  # nobody has chosen them yet


def test_axis_closes_to_an_ellipse_with_periods(studio: pl.Studio) -> None:
    plot = crop(studio, "Parallel coordinates/Plot")
    narrow = studio.widget("Parallel coordinates/right")[2]
    open_menu(studio, "right")
    studio.press("Parallel coordinates/Closed")
    drag_slider(studio, "Parallel coordinates/Periods", 0.8)
    studio.key("escape")
    assert "Parallel coordinates/Closed" not in studio.widgets()
    axis = find_axis(studio, "right")
    assert axis["is_closed"]
    assert axis["periods"] > 1
    assert studio.widget("Parallel coordinates/right")[2] > narrow
    assert not np.array_equal(crop(studio, "Parallel coordinates/Plot"), plot)


def test_escape_closes_a_menu_and_leaves_the_selection(studio: pl.Studio) -> None:
    drag_within(studio, "Parallel coordinates/x", (0.5, 0.3), (0.5, 0.5))
    chosen = studio.selection
    assert chosen is not None
    open_menu(studio, "z")
    assert "Parallel coordinates/Closed" in studio.widgets()
    studio.key("escape")
    assert "Parallel coordinates/Closed" not in studio.widgets()
    np.testing.assert_array_equal(studio.selection, chosen)
    studio.key("escape")
    assert studio.selection is None


def test_flipped_axis_stands_on_its_head(studio: pl.Studio) -> None:
    press_in_menu(studio, "x", "Flipped")
    assert find_axis(studio, "x")["is_flipped"]
    drag_within(studio, "Parallel coordinates/x", (0.5, 0.1), (0.5, 0.2))
    ((low, high),) = find_axis(studio, "x")["brushes"]
    assert low < high < 0  # low values are at the top


def test_alt_drag_moves_an_axis(studio: pl.Studio) -> None:
    order = list_axes(studio)
    x, y = find_middle(studio, "Parallel coordinates/x")
    end, _ = find_middle(studio, f"Parallel coordinates/{order[2]}")
    studio.drag(x, y, end + 10, y, keys="alt")
    assert list_axes(studio) == [order[1], order[2], order[0], *order[3:]]
    assert studio.selection is None
    studio.key("ctrl+z")
    assert list_axes(studio) == order


def test_alt_drag_moves_an_axis_back_to_the_left(studio: pl.Studio) -> None:
    order = list_axes(studio)
    x, y = find_middle(studio, f"Parallel coordinates/{order[3]}")
    end, _ = find_middle(studio, "Parallel coordinates/x")
    studio.drag(x, y, end - 5, y, keys="alt")
    assert list_axes(studio) == [order[3], *order[:3], *order[4:]]


def test_shift_drag_zooms_an_axis_and_the_menu_shows_the_whole_range_again(studio: pl.Studio) -> None:
    drag_within(studio, "Parallel coordinates/x", (0.5, 0.4), (0.5, 0.6), keys="shift")
    axis = find_axis(studio, "x")
    whole = np.ptp(studio.photons.positions[:, 0])
    assert axis["high"] - axis["low"] == pytest.approx(0.2 * whole, rel=0.1)
    assert studio.selection is None
    plot = crop(studio, "Parallel coordinates/Plot")
    press_in_menu(studio, "x", "Whole")
    assert find_axis(studio, "x")["low"] == find_axis(studio, "x")["high"] == 0
    assert not np.array_equal(crop(studio, "Parallel coordinates/Plot"), plot)


def test_axes_are_removed_added_and_reset(studio: pl.Studio) -> None:
    order = list_axes(studio)
    press_in_menu(studio, "y", "Remove")
    assert list_axes(studio) == [name for name in order if name != "y"]
    choose(studio, "Parallel coordinates/Add", "y")
    assert list_axes(studio) == [*(name for name in order if name != "y"), "y"]
    studio.press("Parallel coordinates/Reset")
    assert list_axes(studio) == order


def test_removing_every_axis_says_what_to_do(studio: pl.Studio) -> None:
    for name in list_axes(studio)[1:]:
        press_in_menu(studio, name, "Remove")
    last = list_axes(studio)
    assert len(last) == 1
    press_in_menu(studio, last[0], "Remove")
    studio.frame()
    studio.press("Parallel coordinates/Reset")
    assert list_axes(studio)[:5] == FIRST


def test_removing_a_brushed_axis_takes_its_part_of_the_selection(studio: pl.Studio) -> None:
    drag_within(studio, "Parallel coordinates/x", (0.5, 0.3), (0.5, 0.5))
    drag_within(studio, "Parallel coordinates/z", (0.5, 0.3), (0.5, 0.8))
    press_in_menu(studio, "x", "Remove")
    low, high = find_axis(studio, "z")["brushes"][0]
    z = studio.photons.positions[:, 2]
    np.testing.assert_array_equal(studio.selection, np.flatnonzero((z >= low) & (z <= high)))


def test_same_column_may_be_added_twice(studio: pl.Studio) -> None:
    choose(studio, "Parallel coordinates/Add", "x")
    assert [axis["name"] for axis in read_state(studio)["parallel"]["axes"]].count("x") == 2
    studio.frame()


@pytest.mark.parametrize(("widget", "field", "value"), [("Density", "shows_density", False), ("Tension", "tension", 0)])
def test_density_and_tension_change_the_plot(studio: pl.Studio, widget: str, field: str, value: float) -> None:
    plot = crop(studio, "Parallel coordinates/Plot")
    if widget == "Density":
        studio.press("Parallel coordinates/Density")
    else:
        drag_within(studio, "Parallel coordinates/Tension", (0.97, 0.5), (0.0, 0.5))
    assert read_state(studio)["parallel"][field] == value
    assert not np.array_equal(crop(studio, "Parallel coordinates/Plot"), plot)


def test_curves_are_colored_by_a_column() -> None:
    with open_ring(TRAJECTORY) as studio:
        move_to(studio, "View/Picture", 0.5, 0.6)
        plot = crop(studio, "Parallel coordinates/Plot")
        choose(studio, "Parallel coordinates/Color", "z")
        assert read_state(studio)["parallel"]["color"] == "z"
        assert not np.array_equal(crop(studio, "Parallel coordinates/Plot"), plot)


def test_plot_follows_the_loupe() -> None:
    with open_ring(TRAJECTORY) as studio:
        move_to(studio, "View/Picture", 0.5, 0.6)
        plot = crop(studio, "Parallel coordinates/Plot")
        move_to(studio, "View/Picture", 0.4, 0.4)
        assert not np.array_equal(crop(studio, "Parallel coordinates/Plot"), plot)


def test_axes_of_the_scatter_are_chosen_and_made_polar(studio: pl.Studio) -> None:
    show_panel(studio, "Parameter space")
    pictures = [crop(studio, "Parameter space/Plot")]
    choose(studio, "Parameter space/X", "right")
    pictures.append(crop(studio, "Parameter space/Plot"))
    studio.press("Parameter space/Polar")
    pictures.append(crop(studio, "Parameter space/Plot"))
    scatter = read_state(studio)["scatter"]
    assert (scatter["x"], scatter["y"], scatter["is_polar"]) == ("right", "z", True)
    assert not np.array_equal(pictures[0], pictures[1])
    assert not np.array_equal(pictures[1], pictures[2])
