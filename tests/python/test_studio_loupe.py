# SPDX-License-Identifier: Apache-2.0
"""The loupe in the view: what it finds under the cursor, its size and space, pins, a range locked to one filament."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import photonloupe as pl
from studio_driver import (
    TRAJECTORY,
    aim_loupe,
    change_state,
    choose,
    crop,
    drag_within,
    find_place,
    look_down,
    move_to,
    open_ring,
    place_pixel,
    read_state,
    show_panel,
)

# Behind the cusp at (0, 0, -0.4) the light of the two halves of the wall and of its middle crosses
# (scenes/ring/README.md).
CROSSING = (0.0, 0.0, -0.6)


def read_point(studio: pl.Studio) -> tuple[float, ...]:
    return tuple(read_state(studio)["loupe"]["point"])


def find_nearest(studio: pl.Studio, k: int) -> np.ndarray:
    """Brute force in double precision around the loupe's point."""
    offset = np.asarray(studio.photons.positions, dtype=np.float64) - read_point(studio)
    return np.argsort((offset**2).sum(axis=1), kind="stable")[:k]


def measure_gap(values: np.ndarray) -> float:
    """Measure what parts clusters: the widest gap along the direction of greatest spread."""
    centered = values.astype(np.float64) - values.mean(axis=0)
    along = np.sort(centered @ np.linalg.svd(centered, full_matrices=False)[2][0])
    return float(np.diff(along).max())


def test_cursor_lays_the_loupe_on_the_place_it_points_at() -> None:
    with open_ring() as studio:
        look_down(studio, CROSSING, 2.0)
        aim_loupe(studio, CROSSING)
        np.testing.assert_allclose(read_point(studio), CROSSING, atol=0.006)  # one pixel
        place = (0.3, 0.0, 0.1)
        aim_loupe(studio, place)
        np.testing.assert_allclose(read_point(studio), place, atol=0.006)


def test_loupe_finds_what_brute_force_finds() -> None:
    with open_ring() as studio:
        look_down(studio, CROSSING, 2.0)
        aim_loupe(studio, CROSSING)
        assert set(studio.loupe_ids.tolist()) == set(find_nearest(studio, 250).tolist())
        np.testing.assert_array_equal(studio.loupe_ids, pl.inspect.loupe(studio.photons, read_point(studio)).ids)


@pytest.mark.parametrize("space", ["world", "parameter", "constrained"])
def test_loupe_finds_what_python_finds_in_every_space(space: str) -> None:
    with open_ring(TRAJECTORY) as studio:
        look_down(studio, CROSSING, 2.0)
        aim_loupe(studio, CROSSING)
        while read_state(studio)["loupe"]["space"] != space:
            studio.key("q")
        found = pl.inspect.loupe(studio.photons, read_point(studio), 250, space, normal=(0, 1, 0))
        np.testing.assert_array_equal(studio.loupe_ids, found.ids)
        assert len(found.ids) == 250


def test_wheel_changes_the_number_of_photons() -> None:
    with open_ring() as studio:
        move_to(studio, "View/Picture")
        studio.wheel(1)
        studio.frame()
        larger = read_state(studio)["loupe"]["k"]
        assert larger > 250
        assert len(studio.loupe_ids) == larger
        for _ in range(3):
            studio.wheel(-1)
            studio.frame()
        assert len(studio.loupe_ids) == read_state(studio)["loupe"]["k"] < 250


def test_wheel_stays_within_one_and_a_thousand() -> None:
    with open_ring() as studio:
        move_to(studio, "View/Picture")
        loupe = read_state(studio)["loupe"]
        for steps, begin, k in ((1, 900, 1000), (-1, 2, 1)):
            change_state(studio, loupe=loupe | {"k": begin})
            for _ in range(3):
                studio.wheel(steps)
                studio.frame()
            assert read_state(studio)["loupe"]["k"] == len(studio.loupe_ids) == k


def test_wheel_with_ctrl_moves_the_camera_and_not_the_loupe() -> None:
    with open_ring() as studio:
        move_to(studio, "View/Picture")
        before = read_state(studio)
        x, y = find_place(studio, "View/Picture", 0.5, 0.5)
        studio._native.hold_key("ctrl", True)
        studio.wheel(1)
        studio.frame()
        studio._native.hold_key("ctrl", False)
        studio.frame()
        after = read_state(studio)
        assert after["view"]["camera"]["distance"] < before["view"]["camera"]["distance"]
        assert after["loupe"]["k"] == 250
        assert (x, y) == find_place(studio, "View/Picture", 0.5, 0.5)


def test_space_is_chosen_from_the_list() -> None:
    with open_ring(TRAJECTORY) as studio:
        choose(studio, "Loupe/space", "parameter")
        assert read_state(studio)["loupe"]["space"] == "parameter"


@pytest.fixture(scope="module")
def locked() -> Iterator[pl.Studio]:
    """Lock the range of 40 photons to one that was pinned where three filaments cross."""
    with open_ring(TRAJECTORY, photons=20_000) as studio:
        look_down(studio, CROSSING, 2.0)
        for _ in range(8):
            studio.key("down")
        studio.click(*place_pixel(studio, CROSSING))
        studio.key("l")
        yield studio


@pytest.mark.parametrize("place", [CROSSING, (0.03, 0.0, -0.62), (-0.04, 0.0, -0.7), (0.05, 0.0, -0.5)])
def test_range_locked_to_a_pin_shows_one_filament_where_several_cross(
    locked: pl.Studio, place: tuple[float, float, float]
) -> None:
    """[SJL15] figure 7 i: without the lock the photons around the cursor are of several filaments, with it of one."""
    loupe = read_state(locked)["loupe"]
    assert (loupe["lock"], loupe["space"], len(loupe["pins"])) == ("pin", "constrained", 1)
    aim_loupe(locked, place)
    parameters = np.asarray(locked.photons.parameters)
    loose = pl.inspect.loupe(locked.photons, read_point(locked), loupe["k"]).ids
    assert measure_gap(parameters[loose]) > 0.15  # of trajectories, rad
    assert measure_gap(parameters[locked.loupe_ids]) < 0.05
    assert len(locked.loupe_ids) == len(loose) == loupe["k"]
    expected = pl.inspect.loupe(
        locked.photons, read_point(locked), loupe["k"], "constrained", loupe["beta"], center=loupe["pins"][0]
    )
    np.testing.assert_array_equal(locked.loupe_ids, expected.ids)


def test_range_locked_to_brushes_holds_while_the_cursor_moves() -> None:
    with open_ring(TRAJECTORY, photons=20_000) as studio:
        look_down(studio, CROSSING, 2.0)
        choose(studio, "Parallel coordinates/Source", "all")
        drag_within(studio, "Parallel coordinates/right", (0.5, 0.49), (0.5, 0.42))
        axis = next(axis for axis in read_state(studio)["parallel"]["axes"] if axis["name"] == "right")
        ((low, high),) = axis["brushes"]
        studio.key("shift+l")
        assert read_state(studio)["loupe"]["lock"] == "brushes"
        parameters = np.asarray(studio.photons.parameters)
        offsets = np.asarray(studio.photons.positions, dtype=np.float64)
        for place in (CROSSING, (0.1, 0.0, -0.7)):
            aim_loupe(studio, place)
            right = parameters[studio.loupe_ids, 0]
            assert low <= right.min() <= right.max() <= high
            # The nearest 250 of those within the interval.
            within = np.flatnonzero((parameters[:, 0] >= low) & (parameters[:, 0] <= high))
            distance = ((offsets[within] - read_point(studio)) ** 2).sum(axis=1)
            assert set(studio.loupe_ids.tolist()) == set(within[np.argsort(distance)[:250]].tolist())


def test_click_pins_and_several_pins_compare() -> None:
    with open_ring() as studio:
        move_to(studio, "View/Picture")
        empty = crop(studio, "Loupe/Table")
        pins = []
        for across in (0.4, 0.6):
            studio.click(*find_place(studio, "View/Picture", across, 0.6))
            pins.append(int(studio.loupe_ids[0]))
        assert read_state(studio)["loupe"]["pins"] == pins
        assert not np.array_equal(crop(studio, "Loupe/Table")[:20], empty[:20])
        studio.key("shift+p")
        assert read_state(studio)["loupe"]["pins"] == []


def test_paths_are_drawn_on_demand() -> None:
    with open_ring() as studio:
        move_to(studio, "View/Picture")
        before = crop(studio, "View/Picture")
        studio.key("t")
        assert not np.array_equal(crop(studio, "View/Picture"), before)
        studio.key("t")
        np.testing.assert_array_equal(crop(studio, "View/Picture"), before)


def test_numbers_are_chosen_in_the_menu() -> None:
    with open_ring() as studio:
        move_to(studio, "View/Picture")
        studio.press("Loupe/Numbers")
        studio.press("Loupe/Numbers/tortuosity")
        studio.press("Loupe/Numbers/position")
        numbers = read_state(studio)["loupe"]["numbers"]
        assert "tortuosity" in numbers
        assert "position" not in numbers


def test_missing_parameters_are_said_and_leave_the_studio_usable() -> None:
    with open_ring() as studio:
        move_to(studio, "View/Picture")
        studio.key("q")
        assert read_state(studio)["loupe"]["space"] == "parameter"
        assert len(studio.loupe_ids) == 0
        studio.key("q")
        studio.key("q")
        assert len(studio.loupe_ids) == 250


def test_loupe_shows_the_world_and_parameter_space_side_by_side() -> None:
    with open_ring(TRAJECTORY) as studio:
        move_to(studio, "View/Picture")
        show_panel(studio, "Parameter space")
        studio.press("Parameter space/Pair")
        assert read_state(studio)["scatter"]["shows_pair"]
        before = studio.image()
        move_to(studio, "View/Picture", 0.4, 0.6)
        _x, y, _width, height = (round(v) for v in studio.widget("Parameter space/Pair"))
        below = np.s_[y + 2 * height :, 285:900]
        assert not np.array_equal(before[below], studio.image()[below])
