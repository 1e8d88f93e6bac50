# SPDX-License-Identifier: Apache-2.0
"""Relaxation step by step in the studio is that of Python, bit for bit; before and after, undo, reset."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import photonloupe as pl
from studio_driver import (
    TRAJECTORY,
    borrow,
    choose,
    crop,
    drag_slider,
    drag_within,
    open_ring,
    read_state,
    show_panel,
)


@pytest.fixture(scope="module")
def opened() -> Iterator[pl.Studio]:
    with open_ring(TRAJECTORY) as studio:
        yield studio


@pytest.fixture
def studio(opened: pl.Studio) -> Iterator[pl.Studio]:
    """Show the relaxation of the ring with its trajectories; a run is of three steps."""
    choices = read_state(opened)["relax"]["choices"] | {"steps": 3}
    with borrow(opened, relax={"choices": choices}) as lent:
        show_panel(lent, "Relaxation")
        yield lent


def relax_alike(studio: pl.Studio, steps: int) -> pl.PhotonMap:
    """Step as Python does, with what the session says of the settings."""
    used = read_state(studio)["relax"]["used"]
    relaxation = pl.Relaxation(studio.photons, **used)
    for _ in range(steps):
        relaxation.step()
    return relaxation.photons


def check_relaxed(studio: pl.Studio, steps: int) -> None:
    assert studio.relaxed is not None
    expected = relax_alike(studio, steps)
    for name in ("positions", "normals", "power", "drift", "pressure", "constraint_basis", "constraint_weights"):
        np.testing.assert_array_equal(getattr(studio.relaxed, name), getattr(expected, name), err_msg=name)


def test_steps_are_those_of_python(studio: pl.Studio) -> None:
    for step in (1, 2, 3):
        studio.press("Relaxation/Step")
        assert read_state(studio)["relax"]["made"] == step
        check_relaxed(studio, step)


def test_run_makes_all_steps(studio: pl.Studio) -> None:
    studio.press("Relaxation/Run")
    assert read_state(studio)["relax"]["made"] == 3
    check_relaxed(studio, 3)


def test_other_settings_are_used(studio: pl.Studio) -> None:
    drag_within(studio, "Relaxation/neighbors", (0.5, 0.5), (0.3, 0.5))
    choose(studio, "Relaxation/descriptor", "pca")
    choose(studio, "Relaxation/constraint", "world")
    studio.press("Relaxation/diffuse_flux")
    choices = read_state(studio)["relax"]["choices"]
    assert (choices["descriptor"], choices["constraint"], choices["diffuse_flux"]) == ("pca", "world", True)
    assert choices["neighbors"] < 20
    studio.press("Relaxation/Step")
    check_relaxed(studio, 1)


def test_changed_setting_begins_again_with_the_next_step(studio: pl.Studio) -> None:
    studio.press("Relaxation/Step")
    studio.press("Relaxation/Step")
    choose(studio, "Relaxation/repel", "parameter")
    assert read_state(studio)["relax"]["made"] == 2  # what is shown stays until the next step
    studio.press("Relaxation/Step")
    assert read_state(studio)["relax"]["made"] == 1
    check_relaxed(studio, 1)


def test_constraint_is_measured_alone(studio: pl.Studio) -> None:
    studio.press("Relaxation/Measure")
    assert studio.relaxed is not None
    np.testing.assert_array_equal(studio.relaxed.positions, studio.photons.positions)
    assert np.isfinite(studio.relaxed.constraint_weights).all()


def test_tab_shows_the_photons_before_and_after(studio: pl.Studio) -> None:
    studio.mouse_move(5, 5)
    before = crop(studio, "View/Picture")
    studio.press("Relaxation/Run")
    studio.mouse_move(5, 5)
    studio.frame()
    after = crop(studio, "View/Picture")
    assert not np.array_equal(before, after)
    studio.key("tab")
    np.testing.assert_array_equal(crop(studio, "View/Picture"), before)
    studio.key("tab")
    np.testing.assert_array_equal(crop(studio, "View/Picture"), after)


def test_split_shows_both_and_its_line_is_dragged(studio: pl.Studio) -> None:
    studio.press("Relaxation/Run")
    studio.mouse_move(5, 5)
    studio.frame()
    after = crop(studio, "View/Picture")
    studio.key("tab")
    before = crop(studio, "View/Picture")
    studio.key("s")
    middle = before.shape[1] // 2
    split = crop(studio, "View/Picture")
    np.testing.assert_array_equal(split[40:, : middle - 4], before[40:, : middle - 4])
    np.testing.assert_array_equal(split[40:, middle + 4 :], after[40:, middle + 4 :])
    camera = read_state(studio)["view"]["camera"]
    drag_within(studio, "View/Picture", (0.5, 0.5), (0.25, 0.5))
    view = read_state(studio)["view"]
    assert view["split_at"] == pytest.approx(0.25, abs=0.01)
    assert view["camera"] == camera


def test_undo_and_redo_of_steps_give_the_same_photons(studio: pl.Studio) -> None:
    positions, states = [], []
    for _ in range(3):
        studio.press("Relaxation/Step")
        assert studio.relaxed is not None
        positions.append(np.asarray(studio.relaxed.positions).copy())
        states.append(studio.state)
    for step in (1, 0):
        studio.key("ctrl+z")
        assert studio.state == states[step]
        np.testing.assert_array_equal(studio.relaxed.positions, positions[step])
    for step in (1, 2):
        studio.key("ctrl+y")
        assert studio.state == states[step]
        np.testing.assert_array_equal(studio.relaxed.positions, positions[step])


@pytest.mark.parametrize("way", ["reset", "undo"])
def test_reset_goes_back_to_the_traced_photons(studio: pl.Studio, way: str) -> None:
    studio.mouse_move(5, 5)
    studio.frame()
    before = crop(studio, "View/Picture")
    studio.press("Relaxation/Step")
    if way == "reset":
        studio.press("Relaxation/Reset")
    else:
        studio.key("ctrl+z")
    assert not read_state(studio)["relax"]["is_measured"]
    assert read_state(studio)["relax"]["made"] == 0
    assert studio.relaxed is None
    # There is nothing behind the key any more.
    studio.key("tab")
    assert "relaxed" in studio.message
    assert not read_state(studio)["view"]["shows_relaxed"]
    studio.mouse_move(5, 5)
    studio.frame()
    np.testing.assert_array_equal(crop(studio, "View/Picture"), before)
    studio.press("Relaxation/Step")
    check_relaxed(studio, 1)


def test_script_that_runs_again_is_relaxed_again(studio: pl.Studio) -> None:
    studio.press("Relaxation/Step")
    assert studio.relaxed is not None
    positions = np.asarray(studio.relaxed.positions).copy()
    drag_slider(studio, "Script/zoom", 0.9)
    assert read_state(studio)["relax"]["made"] == 1
    assert studio.relaxed is not None
    np.testing.assert_array_equal(studio.relaxed.positions, positions)  # the parameters are the same
    np.testing.assert_array_equal(studio.relaxed.colors, studio.photons.colors)


def test_curve_of_each_step_is_drawn(studio: pl.Studio) -> None:
    assert "Relaxation/Curves" not in studio.widgets()
    studio.press("Relaxation/Step")
    one = crop(studio, "Relaxation/Curves")
    studio.press("Relaxation/Step")
    assert not np.array_equal(crop(studio, "Relaxation/Curves"), one)


def test_selection_and_loupe_are_of_the_photons_shown(studio: pl.Studio) -> None:
    studio.press("Relaxation/Step")
    x, y, width, height = studio.widget("View/Picture")
    studio.mouse_move(x + 0.5 * width, y + 0.6 * height)
    studio.frame()
    assert studio.relaxed is not None
    point = read_state(studio)["loupe"]["point"]
    np.testing.assert_array_equal(studio.loupe_ids, pl.inspect.loupe(studio.relaxed, point, normal=(0, 1, 0)).ids)
    studio.key("tab")
    np.testing.assert_array_equal(studio.loupe_ids, pl.inspect.loupe(studio.photons, point, normal=(0, 1, 0)).ids)
