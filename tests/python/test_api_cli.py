# SPDX-License-Identifier: Apache-2.0
"""The program: what each verb writes, and one message with its exit code for each mistake."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from conftest import write_scene
from gltf import build_quad, make_mirror
from photonloupe.cli import main

SMALL = ("--photons", "5000", "--width", "32", "--height", "32", "--samples", "1")


def run(*arguments: object) -> int:
    return main([str(argument) for argument in arguments])


def check_message(capsys: pytest.CaptureFixture[str]) -> str:
    """One line on stderr, nothing on stdout, no traceback."""
    captured = capsys.readouterr()
    assert captured.out == ""
    assert captured.err.startswith("photonloupe")
    assert captured.err.count("\n") == 1
    return captured.err


def write_pictures(folder: Path) -> tuple[Path, Path]:
    pixels = np.random.default_rng(0).random((16, 16, 3))
    pl.Image(pixels).save(folder / "a.exr")
    pl.Image(pixels + 0.1).save(folder / "b.exr")
    return folder / "a.exr", folder / "b.exr"


def test_render_writes_a_picture(ring_path: Path, tmp_path: Path) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL) == 0
    assert np.asarray(pl.load_image(tmp_path / "a.exr")).shape == (32, 32, 3)


def test_render_takes_every_option(ring_path: Path, tmp_path: Path) -> None:
    options = "--camera view --mode caustic --quality draft --exposure 1 --seed 2 --k 9".split()  # noqa: SIM905 - reads as typed
    assert run("render", ring_path, "-o", tmp_path / "a.png", *SMALL, *options, "--device", "auto") == 0
    assert pl.load_image(tmp_path / "a.png").provenance["settings"]["k"] == 9


def test_render_reports_as_json(ring_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, "--json") == 0
    assert json.loads(capsys.readouterr().out)["photons"] >= 5000


def test_render_takes_a_kernel(ring_path: Path, tmp_path: Path) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, "--kernel", "cone") == 0
    assert pl.load_image(tmp_path / "a.exr").provenance["settings"]["kernel"] == "cone"


def test_render_of_a_saved_map_is_that_of_the_interface(ring: pl.Scene, ring_path: Path, tmp_path: Path) -> None:
    pl.trace_photons(ring, 2_000, seed=4).relax(1).save(tmp_path / "a.zarr")
    options = (*SMALL[2:], "--map", tmp_path / "a.zarr", "--mode", "caustic", "--k", 20)
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *options) == 0
    expected = pl.render(
        ring, pl.load_photons(tmp_path / "a.zarr"), width=32, height=32, samples=1, mode="caustic", k=20
    )
    np.testing.assert_array_equal(np.asarray(pl.load_image(tmp_path / "a.exr")), np.asarray(expected))


def test_render_shows_the_colors_of_a_saved_map(ring: pl.Scene, ring_path: Path, tmp_path: Path) -> None:
    photons = pl.trace_photons(ring, 2_000, seed=4)
    photons.run_script("for (i = 0; i < getNumPhotons(); i++) setPhotonColourEncoding(i, 1, 0, 0);")
    photons.save(tmp_path / "a.zarr")
    options = (*SMALL[2:], "--map", tmp_path / "a.zarr", "--mode", "false-color")
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *options) == 0
    pixels = np.asarray(pl.load_image(tmp_path / "a.exr"))
    assert pixels[..., 0].max() > 0.0
    assert pixels[..., 1].max() == 0.0


def test_map_of_another_scene_is_named(
    ring_path: Path, plate_path: Path, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    pl.trace_photons(pl.load_scene(plate_path), 2_000, store="all").save(tmp_path / "a.zarr")
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL[2:], "--map", tmp_path / "a.zarr") == 0
    assert "was not traced in" in caplog.text


def test_trace_writes_a_map(ring_path: Path, tmp_path: Path) -> None:
    options = ["--photons", "3000", "--store", "caustic", "--emission", "random", "--columns", "paths", "--seed", "2"]
    assert run("trace", ring_path, "-o", tmp_path / "a.zarr", *options) == 0
    assert "path_vertices" in pl.load_photons(tmp_path / "a.zarr").recorded


def test_trace_takes_emitted(ring_path: Path, tmp_path: Path) -> None:
    assert run("trace", ring_path, "-o", tmp_path / "a.zarr", "--emitted", 8192, "--max-bounces", 4) == 0
    assert pl.load_photons(tmp_path / "a.zarr").emitted == 8192


def test_compare_prints_its_measures(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    a, b = write_pictures(tmp_path)
    assert run("compare", a, b, "--json") == 0
    assert json.loads(capsys.readouterr().out)["rmse"] == pytest.approx(0.1, rel=1e-5)


@pytest.mark.parametrize(("limit", "code"), [("--max-rmse=0.2", 0), ("--max-rmse=0.05", 1), ("--max-flip=0.0001", 1)])
def test_compare_says_no_above_its_limits(limit: str, code: int, tmp_path: Path) -> None:
    assert run("compare", *write_pictures(tmp_path), limit) == code


@pytest.mark.parametrize("suffix", [".png", ".exr"])
def test_compare_writes_the_difference(suffix: str, tmp_path: Path) -> None:
    assert run("compare", *write_pictures(tmp_path), "-o", tmp_path / f"d{suffix}") == 0
    assert pl.load_image(tmp_path / f"d{suffix}").width == 16


def test_doctor_passes_its_self_test(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("doctor", "--json") == 0
    assert json.loads(capsys.readouterr().out)["self_test"]["ok"]


def test_doctor_says_why_the_device_was_chosen(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("doctor") == 0
    assert "chosen:" in capsys.readouterr().out


def test_doctor_describes_a_scene(ring_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("doctor", ring_path, "--json") == 0
    assert "left_out" in json.loads(capsys.readouterr().out)["scene"]["report"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["render", "{missing}", "-o", "{out}.exr"],
        ["render", "{text}", "-o", "{out}.exr"],
        ["render", "{dark}", "-o", "{out}.exr"],
        ["render", "{nowhere}", "-o", "{out}.exr"],
        ["render", "{ring}", "-o", "{out}.jpg"],
        ["render", "{ring}", "-o", "{out}/none/a.exr"],
        ["render", "{ring}", "-o", "{out}.exr", "--photons", "0"],
        ["render", "{ring}", "-o", "{out}.exr", "--photons", "many"],
        ["render", "{ring}", "-o", "{out}.exr", "--width", "0"],
        ["render", "{ring}", "-o", "{out}.exr", "--k", "0"],
        ["render", "{ring}", "-o", "{out}.exr", "--k", "1001"],
        ["render", "{ring}", "-o", "{out}.exr", "--camera", "side"],
        ["render", "{ring}", "-o", "{out}.exr", "--mode", "pretty"],
        ["render", "{ring}", "-o", "{out}.exr", "--exposure", "nan"],
        ["render", "{ring}", "-o", "{out}.exr", "--seed", "-1"],
        ["render", "{ring}", "-o", "{out}.exr", "--kernel", "box"],
        ["render", "{ring}", "-o", "{out}.exr", "--map", "{missing}.zarr"],
        ["render", "{ring}", "-o", "{out}.exr", "--map", "{missing}.zarr", "--photons", "9"],
        ["render", "{ring}", "-o", "{out}.exr", "--map", "{missing}.zarr", "--mode", "direct"],
        ["render", "{ring}"],
        ["trace", "{missing}", "-o", "{out}.zarr"],
        ["trace", "{dark}", "-o", "{out}.zarr"],
        ["trace", "{plate}", "-o", "{out}.zarr"],
        ["trace", "{ring}", "-o", "{out}.zarr", "--photons", "0"],
        ["trace", "{ring}", "-o", "{out}.zarr", "--max-bounces", "65"],
        ["trace", "{ring}", "-o", "{out}.zarr", "--columns", "speed"],
        ["trace", "{ring}", "-o", "{out}/none/a.zarr", "--photons", "100"],
        ["compare", "{missing}.exr", "{missing}.exr"],
        ["compare", "{text}", "{text}"],
        ["doctor", "{missing}"],
        ["paint"],
        [],
    ],
    ids=lambda arguments: " ".join(arguments[:2] + arguments[4:]) or "nothing",
)
def test_mistake_is_one_message_and_code_two(
    arguments: list[str], ring_path: Path, plate_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "text.gltf").write_text("no scene at all")
    places = {
        "missing": tmp_path / "missing.gltf",
        "text": tmp_path / "text.gltf",
        "dark": write_scene(tmp_path, "dark", lamp=False),
        "nowhere": write_scene(
            tmp_path,
            "nowhere",
            lambda writer: writer.add_mesh("m", build_quad(1.0), make_mirror("m", (1, 1, 1))),
            floor=False,
        ),
        "plate": plate_path,
        "ring": ring_path,
        "out": tmp_path / "out",
    }
    assert run(*(argument.format(**places) for argument in arguments)) == 2
    check_message(capsys)


def test_unknown_device_is_code_three(ring_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", "--device", "no such device") == 3
    check_message(capsys)


@pytest.mark.parametrize(
    ("error", "message", "code"),
    [
        (pl.DeviceMemoryError, "2.1 GiB needed, 1.6 free", 4),
        (MemoryError, "", 4),
        (KeyboardInterrupt, "", 130),
        (pl.Cancelled, "trace: stopped", 130),
        (RuntimeError, "a mistake of ours", 70),
    ],
)
def test_error_has_its_exit_code(
    error: type[BaseException],
    message: str,
    code: int,
    ring_path: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def fail(*_: object, **__: object) -> None:
        # Made here: one that outlives the test keeps all that its traceback saw, device and scenes among it.
        raise error(message)

    monkeypatch.setattr(pl, "trace_photons", fail)
    assert run("render", ring_path, "-o", tmp_path / "a.exr") == code
    check_message(capsys)
    assert not (tmp_path / "a.exr").exists()


def test_debug_shows_where_an_error_arose(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("render", tmp_path / "none.gltf", "-o", tmp_path / "a.exr", "--debug") == 2
    assert "Traceback" in capsys.readouterr().err


def test_more_neighbors_than_photons_is_allowed(ring_path: Path, tmp_path: Path) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, "--photons", 10, "--k", 1000) == 0


@pytest.mark.parametrize("verb", ["render", "trace", "relax", "compare", "doctor", "demo"])
def test_verb_has_help(verb: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(verb, "--help") == 0
    assert verb in capsys.readouterr().out


def test_module_is_the_program() -> None:
    done = subprocess.run(
        [sys.executable, "-m", "photonloupe", "--version"],
        capture_output=True,
        text=True,
        check=True,
        timeout=60,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)},
    )
    assert done.stdout.strip() == f"photonloupe {pl.__version__}"


def test_demo_writes_its_pictures(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, ring_path: Path) -> None:
    monkeypatch.setenv("PHOTONLOUPE_ROOT", str(ring_path.parents[2]))
    monkeypatch.setattr("photonloupe.cli.demo._SIDE", 32)
    monkeypatch.setattr("photonloupe.cli.demo._COMPARED_PHOTONS", 5_000)
    assert run("demo", "-o", tmp_path) == 0
    ring = {"caustic_top", "composite_view", "composite_top", "photons_close"}
    relaxed = {"relax", "relax_raw", "relax_unconstrained", "relax_world", "relax_parameter"}
    scripts = {"scripts", "script_tortuosity", "script_primal_trajectory", "script_ppca"}
    assert {path.stem for path in tmp_path.glob("*.png")} == ring | scripts | relaxed | {"studio"}
