# SPDX-License-Identifier: Apache-2.0
"""The verb `studio`: pictures without a window, exit codes, and a real window under Xvfb."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import photonloupe as pl
from conftest import find_scene, write_scene
from photonloupe.cli import main
from studio_driver import SHADES, TRAJECTORY, open_ring

PANELS = (
    "Script",
    "View",
    "Loupe",
    "Parallel coordinates",
    "Parameter space",
    "Histogram",
    "Relaxation",
    "Image",
    "Status",
)
SMALL = ("--size", "640x480", "--photons", "2000")
SECONDS = 120.0  # until a child is given up


def run(*arguments: object) -> int:
    return main(["studio", *(str(argument) for argument in arguments)])


def check_message(capsys: pytest.CaptureFixture[str]) -> str:
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("photonloupe")
    assert captured.err.count("\n") == 1
    return captured.err


def read_picture(path: Path) -> np.ndarray:
    return np.asarray(pl.load_image(path))


def test_screenshot_is_the_same_bytes_twice(tmp_path: Path) -> None:
    for name in ("a.png", "b.png"):
        assert run(find_scene("ring"), "--script", TRAJECTORY, "--screenshot", tmp_path / name, *SMALL) == 0
    assert (tmp_path / "a.png").read_bytes() == (tmp_path / "b.png").read_bytes()
    assert read_picture(tmp_path / "a.png").shape == (480, 640, 3)


def test_screenshot_tells_what_it_wrote_as_json(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--screenshot", tmp_path / "a.png", "--size", "320x240", "--json") == 0
    assert json.loads(capsys.readouterr().out) == {
        "screenshot": str(tmp_path / "a.png"),
        "width": 320,
        "height": 240,
    }


@pytest.mark.parametrize("panel", [panel for panel in PANELS if panel != "Image"])
def test_each_panel_is_drawn_alone(tmp_path: Path, panel: str) -> None:
    options = ("--photons", "1000", "--size", "400x300", "--panel", panel)
    assert run(find_scene("ring"), "--screenshot", tmp_path / "a.png", *options) == 0
    picture = read_picture(tmp_path / "a.png")
    assert picture.shape == (300, 400, 3)
    assert len(np.unique(picture.reshape(-1, 3), axis=0)) > 10


def test_saved_maps_and_sessions_are_opened(tmp_path: Path) -> None:
    with open_ring(SHADES, size=(640, 480), photons=2_000) as studio:
        studio.photons.save(tmp_path / "map.zarr")
        studio.save_session(tmp_path / "a.loupe")
        shown = studio.image()
    assert run(tmp_path / "a.loupe", "--screenshot", tmp_path / "a.png", "--size", "640x480") == 0
    view = np.s_[40:250, 160:400]
    with Image.open(tmp_path / "a.png") as drawn:
        np.testing.assert_array_equal(np.asarray(drawn)[view], shown[view])
    assert run(tmp_path / "map.zarr", "--screenshot", tmp_path / "b.png", "--size", "640x480") == 0


@pytest.mark.parametrize(
    "arguments",
    [
        ("--size", "big"),
        ("--size", "10x10"),
        ("--size", "100x99999"),
        ("--size", "640"),
        ("--size", "-640x480"),
        ("--scale", "9"),
        ("--scale", "nan"),
        ("--photons", "0"),
        ("--photons", "99999999999", str(find_scene("ring"))),
        ("--frames", "0"),
        ("--panel", "Coffee"),
        ("--device", "no such device"),
        ("missing.gltf",),
        ("missing.zarr",),
        ("missing.loupe",),
        ("a.txt",),
        ("damaged.zarr",),
        ("dark.gltf",),
        ("--script", "missing.photon"),
        ("--script", "wrong.photon"),
    ],
    ids=" ".join,
)
def test_mistake_is_one_message_and_exit_code_two(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, arguments: tuple[str, ...]
) -> None:
    monkeypatch.chdir(tmp_path)
    Path("a.txt").write_text("nothing")
    Path("wrong.photon").write_text("oops(")
    Path("damaged.zarr").mkdir()
    write_scene(tmp_path, "dark", lamp=False)
    code = run(*arguments, "--screenshot", "out.png")
    assert code == (3 if arguments[0] == "--device" else 2)
    if arguments[-1] != "wrong.photon":  # its diagnostics take more lines
        check_message(capsys)
    assert not Path("out.png").exists()


@pytest.mark.parametrize("name", ["a.jpg", "a", "no/folder/a.png"])
def test_screenshot_that_cannot_be_written_is_a_mistake(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, name: str
) -> None:
    monkeypatch.chdir(tmp_path)
    assert run("--screenshot", name, "--size", "100x100") == 2
    check_message(capsys)


def test_panel_without_a_screenshot_is_a_mistake(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("--panel", "View") == 2
    assert "--screenshot" in check_message(capsys)


def run_program(*arguments: object, display: str | None) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    if display is not None:
        environment["DISPLAY"] = display
    return subprocess.run(
        [sys.executable, "-m", "photonloupe", "studio", *map(str, arguments)],
        env=environment,
        capture_output=True,
        text=True,
        timeout=SECONDS,
        check=False,
    )


@pytest.mark.parametrize("display", [None, ":987"])
def test_without_a_screen_the_message_names_the_way_out(display: str | None) -> None:
    told = run_program(find_scene("ring"), display=display)
    assert told.returncode == 3, told.stderr
    assert "--screenshot" in told.stderr
    assert "Traceback" not in told.stderr
    assert len(told.stderr.strip().splitlines()) == 1


@pytest.fixture(scope="module")
def screen() -> Iterator[str]:
    """Start an X server without a screen, on a display that no other run of these tests takes."""
    program = shutil.which("Xvfb")
    if program is None:
        pytest.skip("Xvfb is not installed")
    reading, writing = os.pipe()
    display = f":{1000 + os.getpid() % 50_000}"
    options = ["-displayfd", str(writing), "-noreset", "-screen", "0", "1280x800x24", "-nolisten", "tcp"]
    server = subprocess.Popen(
        [program, display, *options],
        pass_fds=(writing,),
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    try:
        with os.fdopen(reading) as told:
            number = told.readline().strip()
        assert number, "Xvfb did not start"
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()


def test_window_opens_draws_and_closes(screen: str) -> None:
    told = run_program(
        find_scene("ring"), "--frames", 20, "--json", "--photons", 2_000, "--size", "640x480", display=screen
    )
    assert told.returncode == 0, told.stderr
    result = json.loads(told.stdout)
    assert result["frames"] == 20
    assert len(result["milliseconds"]) == 20
    assert told.stderr == ""


def test_empty_window_opens_with_a_script(screen: str) -> None:
    told = run_program("--frames", 3, "--json", "--script", TRAJECTORY, "--size", "640x480", display=screen)
    assert told.returncode == 0, told.stderr
    assert json.loads(told.stdout)["frames"] == 3
