# SPDX-License-Identifier: Apache-2.0
"""``script`` and ``render --script``: what they print and write, and one message for each mistake."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from conftest import SCENES
from test_api_cli import check_message, run

RING = SCENES / "ring" / "ring.gltf"
GOOD = """
size = 2;
expose size range 0, 10
declarePhotonParameter(3, -20, 20, "right");
for (i = 0; i < getNumPhotons(); i++) {
    setPhotonParameter(i, 3, size * getPhotonPosition(i, X));
    setPhotonColourEncoding(i, 1, 0.5, 0);
    histogram("right", getPhotonPosition(i, X), -2, 2, 8);
}
print("photons", getNumPhotons());
"""
BAD = "for (i = 0; i < getNumPhotons(); i++)\n  x = getPathVertx(i, 0, X);\n"
SERIAL = "last = 0;\nfor (i = 0; i < getNumPhotons(); i++)\n  last = last * 0.5 + i;\n"


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Scripts, and a small map of the ring."""
    path = tmp_path_factory.mktemp("script")
    for name, text in (("good", GOOD), ("bad", BAD), ("serial", SERIAL)):
        (path / f"{name}.photon").write_text(text)
    pl.trace_photons(pl.load_scene(RING), 2_000, seed=4).save(path / "ring.zarr")
    return path


def read_json(capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    return json.loads(capsys.readouterr().out)


def test_script_checks_without_a_map(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("script", folder / "good.photon") == 0
    assert "parallel" in capsys.readouterr().out


def test_script_prints_the_errors_and_answers_2(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("script", folder / "bad.photon") == 2
    shown = capsys.readouterr().err
    assert "bad.photon:2:7: error E004" in shown
    assert "      ^^^^^^^^^^^^ did you mean 'getPathVertex(photon, vertex, axis)'?" in shown


def test_script_json_lists_the_diagnostics(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("script", folder / "bad.photon", "--json") == 2
    first = read_json(capsys)["diagnostics"][0]
    assert (first["code"], first["line"], first["column"]) == ("E004", 2, 7)


def test_script_says_why_a_loop_is_serial(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("script", folder / "serial.photon") == 0
    captured = capsys.readouterr()
    assert "serial" in captured.out
    assert "last" in captured.err
    assert "warning W" in captured.err


def test_script_prints_its_passes_as_glsl(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("script", folder / "good.photon", "--glsl") == 0
    shown = capsys.readouterr().out
    assert "void main()" in shown
    assert "// 6: setPhotonParameter(i, 3, size * getPhotonPosition(i, X));" in shown


def test_script_runs_over_a_map_and_writes_it(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    output = folder / "out.zarr"
    assert run("script", folder / "good.photon", folder / "ring.zarr", "-o", output, "--set", "size=3", "--json") == 0
    result = read_json(capsys)
    assert result["exposed_values"] == {"size": 3.0}
    assert result["parameters"] == ["right"]
    written = pl.load_photons(output)
    np.testing.assert_array_equal(written.parameters[:, 0], 3 * written.positions[:, 0])
    assert sum(result["histograms"]["right"]["counts"]) + sum(
        result["histograms"]["right"][side] for side in ("below", "above")
    ) == len(written)
    assert result["prints"] == [f"photons {len(written)}"]


def test_limits_of_a_run_are_taken(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    taken: dict[str, float] = {}
    run_script = pl.PhotonMap.run_script

    def watch(photons: pl.PhotonMap, script: pl.Script, **keywords: Any) -> pl.ScriptRun:
        taken.update(keywords["limits"])
        return run_script(photons, script, **keywords)

    monkeypatch.setattr(pl.PhotonMap, "run_script", watch)
    options = ("--fuel", 5000, "--exhausted", 7, "--seconds", 2.5)
    assert run("script", folder / "good.photon", folder / "ring.zarr", *options) == 0
    assert taken == {"fuel": 5000, "exhausted": 7, "seconds": 2.5}


def test_script_prints_a_report(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("script", folder / "good.photon", folder / "ring.zarr") == 0
    shown = capsys.readouterr().out
    for part in ("photons ", "right: ", "-20 to 20", "pass 1, line 5: parallel", "####"):
        assert part in shown


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("good.photon", "ring.zarr", "--set", "size=11"), "size.*10"),
        (("good.photon", "ring.zarr", "--set", "size"), "NAME=V"),
        (("good.photon", "ring.zarr", "--set", "width=1"), "no exposed variable 'width'"),
        (("good.photon", "-o", "x.zarr"), "no MAP"),
        (("absent.photon",), "absent.photon"),
        (("good.photon", "absent.zarr"), "absent.zarr"),
        (("good.photon", "ring.zarr", "--fuel", "0"), "fuel"),
        (("good.photon", "ring.zarr", "--exhausted", "0"), "exhausted"),
        (("good.photon", "ring.zarr", "--seconds", "0"), "seconds"),
    ],
)
def test_mistakes_get_one_message(
    folder: Path, arguments: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    paths = [folder / word if word.endswith((".photon", ".zarr")) else word for word in arguments]
    assert run("script", *paths) == 2
    assert re.search(message, check_message(capsys))


def test_render_runs_a_script_and_shows_its_colors(folder: Path, tmp_path: Path) -> None:
    picture = tmp_path / "a.exr"
    options = ("--photons", 2_000, "--width", 24, "--height", 24, "--samples", 1, "--camera", "top")
    code = run("render", RING, "-o", picture, "--script", folder / "good.photon", "--mode", "false-color", *options)
    assert code == 0
    pixels = np.asarray(pl.load_image(picture))
    lit = pixels[pixels[..., 0] > 0.01]
    assert len(lit) > 10
    np.testing.assert_allclose(lit[:, 1], 0.5 * lit[:, 0], rtol=1e-4)


def test_render_relaxes_with_the_parameters_of_the_script(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ("--photons", 2_000, "--width", 8, "--height", 8, "--samples", 1, "--relax", 1, "--json")
    assert run("render", RING, "-o", tmp_path / "a.png", "--script", folder / "good.photon", *options) == 0
    assert read_json(capsys)["relaxation"]["constraint"] == "parameter"


def test_render_shows_relaxed_photons_in_the_colors_of_the_script(folder: Path, tmp_path: Path) -> None:
    options = ("--photons", 2_000, "--width", 8, "--height", 8, "--samples", 1, "--relax", 1, "--mode", "false-color")
    assert run("render", RING, "-o", tmp_path / "a.png", "--script", folder / "good.photon", *options) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--mode", "false-color"), "--script"),
        (("--set", "size=1"), "--script"),
        (("--script", "good.photon", "--mode", "direct"), "direct"),
        (("--script", "good.photon", "--set", "size=-1"), "size"),
    ],
)
def test_render_refuses_what_a_script_cannot(
    folder: Path, tmp_path: Path, arguments: tuple[str, ...], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    words = [folder / word if word.endswith(".photon") else word for word in arguments]
    assert run("render", RING, "-o", tmp_path / "a.png", *words) == 2
    assert re.search(message, check_message(capsys))


def test_render_shows_a_scripts_errors(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("render", RING, "-o", tmp_path / "a.png", "--script", folder / "bad.photon") == 2
    assert "bad.photon:2:7: error E004" in capsys.readouterr().err
    assert not (tmp_path / "a.png").exists()
