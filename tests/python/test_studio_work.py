# SPDX-License-Identifier: Apache-2.0
"""Work in the background: frames keep coming, cancel stops it, closing ends it; pictures are the same in two runs."""

from __future__ import annotations

import gc
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene
from studio_driver import (
    SHADES,
    TRAJECTORY,
    change_state,
    crop,
    find_middle,
    open_empty,
    open_ring,
    read_state,
    wait_until,
)

# It takes its fuel far too long to be waited for.
ENDLESS = """shade = 0.25;
expose shade range 0, 1
declarePhotonParameter(3, 0, 1, "a");
a = 0;
for (j = 0; j < 1000000000; j++) { for (i = 0; i < getNumPhotons(); i++) setPhotonParameter(i, 3, shade); }
"""


def open_background(**options: Any) -> pl.Studio:
    return pl.Studio(
        scene=find_scene("ring"), offscreen=True, size=(800, 600), photons=5_000, background=True, **options
    )


def has_photons(studio: pl.Studio) -> bool:
    return "photons yet" not in repr(studio) and " 0 photons" not in repr(studio)


def test_endless_script_is_canceled_and_the_last_good_run_stays() -> None:
    with open_background(script=SHADES) as studio:
        wait_until(studio, lambda: has_photons(studio) and "colors" in studio.photons.recorded, "the first run")
        wait_until(studio, lambda: not studio.is_busy, "the end of the first work")
        before = np.asarray(studio.photons.colors).copy()
        change_state(studio, script={"text": ENDLESS})
        studio.command("script.run")
        frames = wait_until(studio, lambda: "Status/Cancel" in studio.widgets(), "the progress of the script")
        for _ in range(20):  # the interface answers meanwhile
            studio.frame()
        studio.key("4")
        assert read_state(studio)["view"]["mode"] == "colored_points"
        assert studio.is_busy
        assert frames >= 1
        studio.press("Status/Cancel")
        wait_until(studio, lambda: not studio.is_busy, "the end of the canceled script")
        studio.frame()
        assert "stopped on request" in studio.message
        np.testing.assert_array_equal(studio.photons.colors, before)
        # It is not begun again, and the studio works on.
        for _ in range(5):
            studio.frame()
        assert not studio.is_busy
        change_state(studio, script={"text": SHADES.replace("0.25", "0.75")})
        studio.command("script.run")
        wait_until(studio, lambda: bool(studio.photons.colors[0, 0] == np.float32(0.75)), "the next script")


def test_closing_during_work_ends_it() -> None:
    studio = open_background(script=ENDLESS)
    wait_until(studio, lambda: "Status/Cancel" in studio.widgets(), "work")
    studio.close()
    assert not studio.is_busy
    studio.close()
    with pytest.raises(pl.PhotonLoupeError, match="closed"):
        studio.frame()


def test_background_gives_what_waiting_gives() -> None:
    with open_ring(TRAJECTORY, size=(800, 600)) as waiting, open_background(script=TRAJECTORY) as studio:
        wait_until(studio, lambda: has_photons(studio) and "parameters" in studio.photons.recorded, "the script")
        np.testing.assert_array_equal(studio.photons.parameters, waiting.photons.parameters)


def test_work_in_the_background_is_done_once() -> None:
    with open_background(script=SHADES) as studio:
        wait_until(studio, lambda: "script" in studio._native.job_counts and not studio.is_busy, "the script")
        for _ in range(5):
            studio.frame()
        assert studio._native.job_counts == {"trace": 1, "script": 1}


def test_failing_work_says_so_and_is_not_begun_again() -> None:
    with open_ring(size=(800, 600)) as studio:
        change_state(studio, trace={"scene": "/nowhere/a.gltf"})
        message = studio.message
        assert message.startswith("trace: ")
        assert len(studio.photons) > 0
        studio.command("edit.undo")
        assert read_state(studio)["trace"]["scene"] == str(find_scene("ring"))


def test_same_input_gives_the_same_bytes() -> None:
    pictures = []
    for _ in range(2):
        with open_ring(TRAJECTORY) as studio:
            studio.mouse_move(*find_middle(studio, "View/Picture"))
            studio.frame()
            studio.key("4")
            studio.click(*find_middle(studio, "Script/Editor"))
            studio.type("// hello")
            pictures.append((studio.image(), studio.panel("Parallel coordinates", (700, 300), 1.5), studio.state))
    np.testing.assert_array_equal(pictures[0][0], pictures[1][0])
    np.testing.assert_array_equal(pictures[0][1], pictures[1][1])
    assert pictures[0][2] == pictures[1][2]


def test_frames_without_input_do_not_change_the_picture() -> None:
    with open_ring(TRAJECTORY) as studio:
        first = studio.image()
        for _ in range(3):
            studio.frame()
        np.testing.assert_array_equal(studio.image(), first)


def test_panels_are_written_at_any_size_and_scale(tmp_path: Path) -> None:
    with open_ring(TRAJECTORY) as studio:
        studio.export_panel("View", tmp_path / "view.png", (320, 200), 2.0)
        assert np.asarray(pl.load_image(tmp_path / "view.png")).shape == (200, 320, 3)
        change_state(studio, parallel={"source": "all"})
        studio.export_panel("Parallel coordinates", tmp_path / "plot.svg", (640, 300))
        assert "<svg" in (tmp_path / "plot.svg").read_text()[:400]
        for name, path in (("View", "view.jpg"), ("View", "view.svg")):
            with pytest.raises(pl.PhotonLoupeError):
                studio.export_panel(name, tmp_path / path)
        assert not (tmp_path / "view.jpg").exists()
        # The interface itself is as it was.
        before = crop(studio, "View/Picture")
        studio.frame()
        np.testing.assert_array_equal(crop(studio, "View/Picture"), before)


@pytest.mark.parametrize("size", [(63, 100), (100, 8193), (0, 0), (-1, 100), (100,), "big", (1.5, 100), None])
def test_wrong_sizes_are_refused(size: Any) -> None:
    with pytest.raises(pl.PhotonLoupeError):
        pl.Studio(offscreen=True, size=size)


@pytest.mark.parametrize("scale", [0, 0.4, 4.1, float("nan"), "large"])
def test_wrong_scales_are_refused(scale: Any) -> None:
    with pytest.raises(pl.PhotonLoupeError):
        pl.Studio(offscreen=True, scale=scale)


def test_studios_live_side_by_side_and_are_freed() -> None:
    with open_empty(size=(400, 300)) as first:
        blank = first.image()
        for _ in range(3):
            with open_empty(size=(300, 200)) as second:
                second.key("2")
                first.frame()
            del second
            gc.collect()
        first.frame()
        np.testing.assert_array_equal(first.image(), blank)
