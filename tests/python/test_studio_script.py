# SPDX-License-Identifier: Apache-2.0
"""The script's panel: typing, errors that leave the last good run, sliders that run live, undo."""

from __future__ import annotations

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene
from studio_driver import (
    PHOTONS,
    SHADES,
    choose,
    drag_slider,
    find_place,
    open_empty,
    open_ring,
    read_state,
)

TYPED = 'declarePhotonParameter(3, 0, 1, "a");\nfor (i = 0; i < getNumPhotons(); i++) setPhotonParameter(i, 3, 0.5);'


def trace_alike() -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene("ring")), PHOTONS, seed=1)


def write_in_editor(studio: pl.Studio, text: str) -> None:
    """Replace the editor's text by typing."""
    studio.click(*find_place(studio, "Script/Editor", 0.6, 0.3))
    studio.key("ctrl+a")
    studio.key("delete")
    studio.type(text)


def read_colors(studio: pl.Studio) -> np.ndarray:
    return np.asarray(studio.photons.colors).copy()


def test_typed_script_runs_as_in_python() -> None:
    with open_ring() as studio:
        write_in_editor(studio, TYPED)
        assert read_state(studio)["script"]["ran"] == ""
        studio.key("ctrl+enter")
        expected = trace_alike()
        expected.run_script(TYPED)
        np.testing.assert_array_equal(studio.photons.positions, expected.positions)
        np.testing.assert_array_equal(studio.photons.parameters, expected.parameters)
        assert "".join(read_state(studio)["script"]["ran"].split()) == "".join(TYPED.split())


def test_button_runs_the_script_as_the_key_does() -> None:
    with open_ring() as studio:
        write_in_editor(studio, TYPED)
        studio.press("Script/Run")
        assert studio.photons.parameter_names == ("a",) or list(studio.photons.parameter_names) == ["a"]


def test_error_is_marked_and_leaves_the_last_good_run() -> None:
    with open_ring(SHADES) as studio:
        before, parameters = read_colors(studio), np.asarray(studio.photons.parameters).copy()
        assert "Script/Errors" not in studio.widgets()
        studio.click(*find_place(studio, "Script/Editor", 0.6, 0.3))
        studio.key("ctrl+end")
        studio.type("oops(")
        assert "Script/Errors" in studio.widgets()
        studio.key("ctrl+enter")
        assert "errors" in studio.message
        assert read_state(studio)["script"]["ran"] == SHADES
        np.testing.assert_array_equal(read_colors(studio), before)
        np.testing.assert_array_equal(studio.photons.parameters, parameters)
        # The slider of the good run goes with the text that has it.
        assert "Script/shade" not in studio.widgets()


def test_mended_script_runs_again() -> None:
    with open_ring(SHADES) as studio:
        before = read_colors(studio)
        studio.click(*find_place(studio, "Script/Editor", 0.6, 0.3))
        studio.key("ctrl+end")
        studio.type("oops(")
        for _ in range(len("oops(")):
            studio.key("backspace")
        assert "Script/Errors" not in studio.widgets()
        studio.type("\nsetPhotonColorEncoding(0, 0.75, 0.5, 0.25);")
        studio.key("ctrl+enter")
        expected = before.copy()
        expected[0] = (0.75, 0.5, 0.25)
        np.testing.assert_array_equal(read_colors(studio), expected)


def test_error_stands_at_its_line_in_the_editor() -> None:
    # The marker covers the wrong line and no other.
    with open_empty() as studio:
        write_in_editor(studio, "a = 1;\nb = 2;\nc = 3;\nd = 4;\n")
        clean = studio.image()
        write_in_editor(studio, "a = 1;\nb = 2;\nc = (;\nd = 4;\n")
        x, y, _, height = (round(v) for v in studio.widget("Script/Editor"))
        rows = np.flatnonzero((studio.image() != clean)[y : y + height, x : x + 200].any(axis=(1, 2)))
        assert 0 < rows.min() < rows.max() < 5 * 20
        assert rows.max() - rows.min() < 2 * 18  # one line, and its squiggle


def test_slider_runs_the_script_live_and_undo_takes_it_back() -> None:
    with open_ring(SHADES) as studio:
        state, before = studio.state, read_colors(studio)
        drag_slider(studio, "Script/shade", 0.9)
        moved_state, moved = studio.state, read_colors(studio)
        shade = read_state(studio)["script"]["values"]["shade"]
        assert shade == pytest.approx(0.9, abs=0.05)
        np.testing.assert_allclose(moved[:, 0], shade, rtol=1e-6)
        assert not np.array_equal(before, moved)
        studio.key("ctrl+z")
        assert studio.state == state
        np.testing.assert_array_equal(read_colors(studio), before)
        studio.key("ctrl+y")
        assert studio.state == moved_state
        np.testing.assert_array_equal(read_colors(studio), moved)


def test_slider_runs_during_the_drag() -> None:
    with open_ring(SHADES) as studio:
        x, y = find_place(studio, "Script/shade", 0.5, 0.5)
        studio.mouse_move(x, y)
        studio.frame()
        studio.mouse_button("left", True)
        studio.frame()
        studio.mouse_move(x + 40, y)
        studio.frame()
        during = read_colors(studio)[0, 0]
        assert during == np.float32(read_state(studio)["script"]["values"]["shade"])
        studio.mouse_move(x + 80, y)
        studio.frame()
        assert read_colors(studio)[0, 0] > during


def test_run_with_values_is_that_of_python() -> None:
    with open_ring(SHADES) as studio:
        drag_slider(studio, "Script/shade", 0.7)
        expected = trace_alike()
        expected.run_script(SHADES, values=read_state(studio)["script"]["values"])
        np.testing.assert_array_equal(read_colors(studio), expected.colors)


def test_undo_of_the_only_run_gives_the_traced_photons_back() -> None:
    with open_ring() as studio:
        write_in_editor(studio, TYPED)
        studio.key("ctrl+enter")
        assert studio.photons.parameters.shape[1] == 1
        studio.click(*find_place(studio, "View/Picture", 0.02, 0.02))  # out of the editor
        studio.command("loupe.unpin")
        while read_state(studio)["script"]["ran"]:
            studio.key("ctrl+z")
        assert "parameters" not in studio.photons.recorded
        assert len(studio.photons) == len(trace_alike())


def test_typing_within_a_text_runs_no_command() -> None:
    with open_ring(SHADES) as studio:
        before = read_state(studio)
        studio.click(*find_place(studio, "Script/Editor", 0.6, 0.3))
        studio.type("2 f r p q n")
        after = read_state(studio)
        assert "2 f r p q n" in after["script"]["text"]
        assert {**after, "script": None} == {**before, "script": None}


def test_examples_are_opened_from_the_menu() -> None:
    with open_ring() as studio:
        choose(studio, "Script/Examples", "tortuosity")
        script = read_state(studio)["script"]
        assert script["path"].endswith("tortuosity.photon")
        assert "tortuosity" in script["text"]
        studio.key("ctrl+enter")
        assert list(studio.photons.parameter_names) == ["tortuosity"]


def test_script_that_faults_says_so_in_the_status_line() -> None:
    with open_ring(SHADES) as studio:
        before = read_colors(studio)
        write_in_editor(studio, "i = 0; while (i < 1) { i = i * 1; }")
        studio.key("ctrl+enter")
        assert studio.message.startswith("script: ")
        np.testing.assert_array_equal(read_colors(studio), before)
