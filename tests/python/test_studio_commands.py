# SPDX-License-Identifier: Apache-2.0
"""Commands and keys: one key, one meaning; each runs on anything, and undo takes back exactly what it did."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from studio_driver import (
    SHADES,
    TRAJECTORY,
    borrow,
    change_state,
    choose,
    crop,
    drag_slider,
    drag_within,
    find_place,
    move_to,
    open_empty,
    open_ring,
    read_state,
    show_panel,
)

COMMANDS = [name for name, _, _ in pl.Studio.commands()]
# What starts seconds of rendering is not needed to see that a command runs.
SLOW = {"view.render", "view.colored_render", "relax.run"}
# Those that change no choice.
SILENT = {"edit.undo", "edit.redo", "edit.copy_python", "session.save", "help.keys", "export.figure"}


@pytest.fixture(scope="module")
def opened() -> Iterator[pl.Studio]:
    with open_ring(TRAJECTORY) as studio:
        yield studio


@pytest.fixture
def studio(opened: pl.Studio) -> Iterator[pl.Studio]:
    with borrow(opened) as lent:
        yield lent


def test_every_key_has_one_meaning() -> None:
    keys = [keys for _, keys, _ in pl.Studio.commands() if keys]
    assert len(keys) == len(set(keys)) > 20
    assert len(COMMANDS) == len(set(COMMANDS))
    assert all(about.endswith(("", ".")) and about[0].isupper() for _, _, about in pl.Studio.commands())


def test_every_command_runs_on_an_empty_studio(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with open_empty(size=(600, 400)) as studio:
        for name in COMMANDS:
            studio.command(name)
        for _, keys, _ in pl.Studio.commands():
            if keys:
                studio.key(keys)
        assert studio.image().any()


def test_every_command_runs_on_photons(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with open_ring(TRAJECTORY) as studio:
        move_to(studio, "View/Picture", 0.5, 0.6)
        for name in COMMANDS:
            if name not in SLOW:
                studio.command(name)


@pytest.mark.parametrize("name", [name for name in COMMANDS if name not in SLOW | SILENT])
def test_undo_and_redo_of_a_command_give_the_states_exactly(studio: pl.Studio, name: str) -> None:
    move_to(studio, "View/Picture", 0.5, 0.6)
    before = studio.state
    studio.command(name)
    after = studio.state
    steps = 0
    while studio.state != before:
        assert steps < 3, "undo does not lead back"
        studio.command("edit.undo")
        steps += 1
    for _ in range(steps):
        studio.command("edit.redo")
    assert studio.state == after


def drop_point(text: str) -> dict[str, Any]:
    """Leave out where the loupe is: it follows the mouse, whatever is undone."""
    state = json.loads(text)
    del state["loupe"]["point"], state["loupe"]["has_point"]
    return state


def press_toggle(name: str) -> Callable[[pl.Studio], None]:
    return lambda studio: studio.press(name)


def edit_relaxation(studio: pl.Studio) -> None:
    show_panel(studio, "Relaxation")
    drag_within(studio, "Relaxation/neighbors", (0.5, 0.5), (0.2, 0.5))


def edit_histogram(studio: pl.Studio) -> None:
    choose(studio, "Histogram/Column", "z")
    drag_within(studio, "Histogram/Bins", (0.5, 0.5), (0.2, 0.5))


def drag_threshold(studio: pl.Studio) -> None:
    choose(studio, "Histogram/Column", "x")
    drag_within(studio, "Histogram/Threshold", (0.5, 0.5), (5.0, 0.5))
    assert read_state(studio)["histogram"]["threshold"] != 0


GESTURES: dict[str, Callable[[pl.Studio], None]] = {
    "orbit": lambda studio: drag_within(studio, "View/Picture", (0.1, 0.1), (0.2, 0.3)),
    "pan": lambda studio: drag_within(studio, "View/Picture", (0.1, 0.1), (0.2, 0.3), button="right"),
    "pin": lambda studio: studio.click(*find_place(studio, "View/Picture", 0.5, 0.6)),
    "slider": lambda studio: drag_slider(studio, "Script/zoom", 0.8),
    "point size": lambda studio: drag_within(studio, "View/Size", (0.1, 0.5), (0.8, 0.5)),
    "loupe k": lambda studio: drag_within(studio, "Loupe/k", (0.8, 0.5), (0.3, 0.5)),
    "loupe space": lambda studio: choose(studio, "Loupe/space", "constrained"),
    "drift": press_toggle("Loupe/Drift"),
    "brush": lambda studio: drag_within(studio, "Parallel coordinates/x", (0.5, 0.2), (0.5, 0.5)),
    "plotted photons": lambda studio: choose(studio, "Parallel coordinates/Source", "selection"),
    "relaxation": edit_relaxation,
    "histogram": edit_histogram,
    "threshold": drag_threshold,
    "share below": press_toggle("Histogram/Cdf"),
    "view mode": lambda studio: choose(studio, "View/Mode", "3 kd-tree"),
    "example": lambda studio: choose(studio, "Script/Examples", "signature"),
}


@pytest.mark.parametrize("gesture", GESTURES)
def test_undo_and_redo_of_a_gesture_give_the_states_exactly(studio: pl.Studio, gesture: str) -> None:
    change_state(studio, parallel={"source": "all"})
    studio.mouse_move(1, 1)
    move_to(studio, "View/Picture", 0.5, 0.6)
    before = studio.state
    GESTURES[gesture](studio)
    after = studio.state
    assert drop_point(after) != drop_point(before)
    steps = 0
    while drop_point(studio.state) != drop_point(before):
        assert steps < 4, "undo does not lead back"
        studio.command("edit.undo")
        steps += 1
    for _ in range(steps):
        studio.command("edit.redo")
    assert drop_point(studio.state) == drop_point(after)


def test_undo_with_nothing_left_says_so() -> None:
    with open_empty(size=(600, 400)) as studio:
        studio.key("ctrl+z")
        assert "nothing to undo" in studio.message
        studio.key("ctrl+y")
        assert "nothing to redo" in studio.message


def test_new_change_after_undo_ends_redo(studio: pl.Studio) -> None:
    studio.key("2")
    studio.key("ctrl+z")
    studio.key("3")
    state = studio.state
    studio.key("ctrl+y")
    assert studio.state == state


def test_question_mark_lists_every_key_and_hides_it_again(studio: pl.Studio) -> None:
    before = studio.image()
    studio.key("?")
    assert "Keys" in studio.widgets()
    _, _, _, height = studio.widget("Keys")
    assert height > 300
    assert not np.array_equal(studio.image(), before)
    studio.key("?")
    assert "Keys" not in studio.widgets()


@pytest.mark.parametrize("chord", ["", "+", "ctrl+", "hyper+a", "ctrl+ctrl", "ä", "F99", "ctrl+enter+a", "a" * 1000])
def test_unknown_key_is_refused(studio: pl.Studio, chord: str) -> None:
    if chord in ("ctrl+ctrl",):
        studio.key(chord)  # the modifier alone
        return
    with pytest.raises(pl.PhotonLoupeError, match="not a key"):
        studio.key(chord)


def test_unknown_names_are_refused_naming_what_there_is(studio: pl.Studio) -> None:
    with pytest.raises(pl.PhotonLoupeError, match=r"script\.run"):
        studio.command("make.coffee")
    with pytest.raises(pl.PhotonLoupeError, match="View"):
        studio.panel("Coffee")
    with pytest.raises(pl.PhotonLoupeError, match="no widget"):
        studio.widget("Coffee/Make")


@pytest.mark.parametrize("value", [float("nan"), float("inf"), -float("inf")])
def test_input_that_is_not_finite_is_refused(studio: pl.Studio, value: float) -> None:
    with pytest.raises(pl.PhotonLoupeError):
        studio.mouse_move(value, 0)
    with pytest.raises(pl.PhotonLoupeError):
        studio.wheel(value)


def test_modifiers_may_be_held_together_and_any_key_be_named(studio: pl.Studio) -> None:
    for keys in ("ctrl+shift", "?", "alt", "space"):
        drag_within(studio, "View/Picture", (0.1, 0.1), (0.2, 0.2), keys=keys)
    drag_within(studio, "View/Picture", (-50.0, -50.0), (50.0, 50.0))
    studio.wheel(1e6)
    studio.frame()


def test_view_looks_straight_and_frames(studio: pl.Studio) -> None:
    move_to(studio, "View/Picture", 0.5, 0.6)
    studio.key("r")
    assert read_state(studio)["view"]["camera"]["pitch"] == pytest.approx(np.pi / 2, abs=1e-3)
    studio.selection = [0, 1, 2]
    studio.key("f")
    near = read_state(studio)["view"]["camera"]
    chosen = np.asarray(studio.photons.positions)[:3]
    np.testing.assert_allclose(near["target"], (chosen.min(axis=0) + chosen.max(axis=0)) / 2, atol=1e-5)


@pytest.mark.parametrize("mode", [1, 2, 3, 4, 7])
def test_each_mode_draws_another_picture(studio: pl.Studio, mode: int) -> None:
    change_state(studio, view={"map_column": "z"})
    pictures = {}
    for key in (mode, 1 if mode != 1 else 2):
        studio.key(str(key))
        pictures[key] = crop(studio, "View/Picture")
    first, second = pictures.values()
    assert not np.array_equal(first, second)
    assert len(np.unique(first.reshape(-1, 3), axis=0)) > 20


def test_empty_panels_say_why() -> None:
    """Words differ from an empty ground: each panel of an empty studio draws some."""
    with open_empty() as studio:
        for name in ("View", "Loupe", "Parallel coordinates", "Parameter space", "Histogram", "Relaxation", "Image"):
            picture = studio.panel(name, (500, 400)).astype(int)
            below = picture[33:]
            assert (np.abs(below - below[-1, -1]).max(axis=2) > 60).sum() > 100, name


def test_render_in_false_color_without_colors_says_what_to_do() -> None:
    with open_ring(size=(600, 400), photons=1_000) as studio:
        change_state(studio, view={"mode": "colored_points"})
        assert studio.image().any()


def test_script_without_exposed_variables_has_no_sliders() -> None:
    with open_ring(SHADES.replace("expose shade range 0, 1\n", ""), size=(800, 600)) as studio:
        assert "Script/shade" not in studio.widgets()
