# SPDX-License-Identifier: Apache-2.0
"""``relax`` and ``render --relax``: what they write and print, and one message for each mistake."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from photonloupe.cli import build_parser
from photonloupe.settings import list_settings
from test_api_cli import SMALL, check_message, run

SEARCH = list_settings("relax")["search"].choices[-1]
ALL_OPTIONS = (
    *("--steps", "2", "--neighbors", "7", "--constraint", "world", "--descriptor", "pca", "--repel", "world"),
    *("--over-relaxation", "2,1.2", "--limit", "0.25", "--constraint-neighbors", "30", "--thresholds", "0.9,0.4"),
    *("--search", "exact", "--surface", "tangent", "--period", "0,0,4", "--device", "auto"),
)


@pytest.fixture(scope="module")
def ring_zarr(ring: pl.Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small map of the ring without parameters."""
    path = tmp_path_factory.mktemp("relax") / "ring.zarr"
    pl.trace_photons(ring, 2_000, seed=4).save(path)
    return path


@pytest.fixture(scope="module")
def layered_zarr(ring: pl.Scene, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The same with primal trajectories as parameters."""
    path = tmp_path_factory.mktemp("relax") / "layered.zarr"
    photons = pl.trace_photons(ring, 2_000, seed=4)
    photons.set_parameters(pl.find_primal_trajectory(photons), ("right", "up"))
    photons.save(path)
    return path


def parse_relax(*options: str) -> dict[str, Any]:
    parsed = vars(build_parser().parse_args(["relax", "a.zarr", "-o", "b.zarr", *options]))
    return {name: value for name, value in parsed.items() if name in list_settings("relax")}


def read_json(capsys: pytest.CaptureFixture[str]) -> dict[str, Any]:
    return json.loads(capsys.readouterr().out)


def test_relax_has_an_option_for_every_keyword(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", "--help") == 0
    printed = capsys.readouterr().out.split()
    assert {f"--{name.replace('_', '-')}" for name in list_settings("relax")} <= set(printed)


def test_option_that_is_not_given_is_left_to_the_interface() -> None:
    assert parse_relax() == {}
    assert parse_relax("--steps", "3") == {"steps": 3}


def test_help_names_the_defaults_and_ranges(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", "--help") == 0
    printed = " ".join(capsys.readouterr().out.split())
    for setting in list_settings("relax").values():
        assert setting.tell_range() in printed
        assert setting.kind == "flag" or f"default {setting.tell_default()}".replace("`", "") in printed


def test_relax_writes_what_the_interface_makes(ring_zarr: Path, tmp_path: Path) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr") == 0
    expected = pl.load_photons(ring_zarr).relax()
    np.testing.assert_array_equal(pl.load_photons(tmp_path / "a.zarr").positions, expected.positions)


def test_relax_leaves_the_map_that_it_read(ring_zarr: Path, tmp_path: Path) -> None:
    before = pl.load_photons(ring_zarr).positions.tobytes()
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", "--steps", 1) == 0
    assert pl.load_photons(ring_zarr).positions.tobytes() == before


def test_relax_can_write_over_the_map_that_it_read(ring_zarr: Path, tmp_path: Path) -> None:
    pl.load_photons(ring_zarr).save(tmp_path / "a.zarr")
    assert run("relax", tmp_path / "a.zarr", "-o", tmp_path / "a.zarr", "--steps", 1) == 0
    assert len(pl.load_photons(tmp_path / "a.zarr").relaxation["steps"]) == 1


def test_relax_takes_every_option(ring_zarr: Path, tmp_path: Path) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", *ALL_OPTIONS) == 0
    assert pl.load_photons(tmp_path / "a.zarr").relaxation["settings"] == {
        "steps": 2,
        "neighbors": 7,
        "constraint": "world",
        "descriptor": "pca",
        "beta": 0.0,
        "repel": "world",
        "over_relaxation": [2.0, 1.2],
        "limit": 0.25,
        "constraint_neighbors": 30,
        "thresholds": [0.9, 0.4],
        "diffuse_flux": False,
        "search": "exact",
        "surface": "tangent",
        "period": [0.0, 0.0, 4.0],
    }


@pytest.mark.parametrize(
    ("options", "name", "value"),
    [
        ("--beta 4", "beta", 4.0),
        ("--repel parameter", "repel", "parameter"),
        ("--over-relaxation 1.5", "over_relaxation", [1.5, 1.5]),
        ("--limit none", "limit", None),
        ("--diffuse-flux", "diffuse_flux", True),
        ("--period 4,0,2.5", "period", [4.0, 0.0, 2.5]),
        (f"--search {SEARCH}", "search", SEARCH),
        ("--constraint parameter", "constraint", "parameter"),
        ("", "constraint", "parameter"),
        ("--steps 0", "steps", 0),
    ],
)
def test_option_becomes_its_setting(layered_zarr: Path, tmp_path: Path, options: str, name: str, value: object) -> None:
    steps = "" if "--steps" in options else "--steps 1"
    assert run("relax", layered_zarr, "-o", tmp_path / "a.zarr", *steps.split(), *options.split()) == 0
    assert pl.load_photons(tmp_path / "a.zarr").relaxation["settings"][name] == value


def test_beta_auto_is_found_from_the_map(layered_zarr: Path, tmp_path: Path) -> None:
    assert run("relax", layered_zarr, "-o", tmp_path / "a.zarr", "--steps", 1, "--beta", "auto") == 0
    expected = float(pl.optimal_beta(pl.load_photons(layered_zarr)))
    assert pl.load_photons(tmp_path / "a.zarr").relaxation["settings"]["beta"] == expected


def test_relax_prints_a_row_for_each_step(ring_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", "--steps", 3) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split("  ")[0] == "step"
    assert [line.split()[0] for line in lines[1:4]] == ["0", "1", "2"]


def test_relax_says_where_photons_moved(ring_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", "--steps", 1, "--surface", "tangent") == 0
    assert "moved on: tangent planes" in capsys.readouterr().out


def test_relax_says_where_space_repeats(ring_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", "--steps", 1, "--period", "4,0,4") == 0
    assert "period 4,0,4" in capsys.readouterr().out


def test_relax_says_which_beta_was_used(layered_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", layered_zarr, "-o", tmp_path / "a.zarr", "--steps", 1, "--beta", "4.25") == 0
    assert "beta 4.25," in capsys.readouterr().out


def test_relax_reports_settings_as_json(ring_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", "--steps", 2, "--json") == 0
    saved = pl.load_photons(tmp_path / "a.zarr").relaxation["settings"]
    assert read_json(capsys)["settings"] == saved


def test_relax_reports_steps_as_json(ring_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", "--steps", 2, "--json") == 0
    steps = read_json(capsys)["steps"]
    saved = pl.load_photons(tmp_path / "a.zarr").relaxation["steps"]
    assert [{name: row[name] for name in saved[0]} for row in steps] == saved


def test_relax_reports_seconds_as_json(ring_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr", "--steps", 2, "--json") == 0
    printed = read_json(capsys)
    assert {"load", "constraint", "steps", "save"} <= set(printed["seconds"])
    assert all("seconds" in row for row in printed["steps"])


@pytest.mark.parametrize(
    "arguments",
    [
        ["{missing}", "-o", "{out}.zarr"],
        ["{file}", "-o", "{out}.zarr"],
        ["{map}", "-o", "{out}/none/a.zarr"],
        ["{map}", "-o", "{file}"],
        ["{map}"],
        ["{map}", "-o", "{out}.zarr", "--constraint", "parameter"],
        ["{map}", "-o", "{out}.zarr", "--repel", "parameter"],
        ["{map}", "-o", "{out}.zarr", "--steps", "-1"],
        ["{map}", "-o", "{out}.zarr", "--steps", "few"],
        ["{map}", "-o", "{out}.zarr", "--neighbors", "0"],
        ["{map}", "-o", "{out}.zarr", "--neighbors", "999"],
        ["{map}", "-o", "{out}.zarr", "--constraint", "paths"],
        ["{map}", "-o", "{out}.zarr", "--descriptor", "best"],
        ["{map}", "-o", "{out}.zarr", "--beta", "wide"],
        ["{map}", "-o", "{out}.zarr", "--beta", "-1"],
        ["{map}", "-o", "{out}.zarr", "--over-relaxation", "0"],
        ["{map}", "-o", "{out}.zarr", "--over-relaxation", "1,2,3"],
        ["{map}", "-o", "{out}.zarr", "--over-relaxation", "2,"],
        ["{map}", "-o", "{out}.zarr", "--limit", "0"],
        ["{map}", "-o", "{out}.zarr", "--limit", "no"],
        ["{map}", "-o", "{out}.zarr", "--constraint-neighbors", "11"],
        ["{map}", "-o", "{out}.zarr", "--thresholds", "1"],
        ["{map}", "-o", "{out}.zarr", "--thresholds", "1,1"],
        ["{map}", "-o", "{out}.zarr", "--thresholds", "nan,1"],
        ["{map}", "-o", "{out}.zarr", "--search", "quick"],
        ["{map}", "-o", "{out}.zarr", "--surface", "sphere"],
        ["{map}", "-o", "{out}.zarr", "--period", "4"],
        ["{map}", "-o", "{out}.zarr", "--period", "0,0,wide"],
        ["{map}", "-o", "{out}.zarr", "--period=-1,0,0"],
    ],
    ids=" ".join,
)
def test_mistake_is_one_message_and_code_two(
    arguments: list[str], ring_zarr: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("a letter")
    places = {"missing": tmp_path / "none.zarr", "file": tmp_path / "file", "map": ring_zarr, "out": tmp_path / "out"}
    assert run("relax", *(argument.format(**places) for argument in arguments)) == 2
    check_message(capsys)


def test_path_that_cannot_be_written_is_refused_before_the_work(
    ring_zarr: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def fail(*_: object, **__: object) -> None:
        raise AssertionError("the map was read")

    monkeypatch.setattr(pl, "load_photons", fail)
    assert run("relax", ring_zarr, "-o", tmp_path / "none" / "a.zarr") == 2
    check_message(capsys)


def test_changed_scene_is_named(ring_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for path in (ring_path, ring_path.with_suffix(".bin")):
        (tmp_path / path.name).write_bytes(path.read_bytes())
    pl.trace_photons(pl.load_scene(tmp_path / "ring.gltf"), 500).save(tmp_path / "a.zarr")
    text = (tmp_path / "ring.gltf").read_text()
    (tmp_path / "ring.gltf").write_text(text.replace("lamp", "lump"))
    assert run("relax", tmp_path / "a.zarr", "-o", tmp_path / "b.zarr") == 2
    assert "ring.gltf has changed" in check_message(capsys)


@pytest.mark.parametrize("place", ["photonloupe.relaxing.Relaxation.step", "photonloupe.storage.replace_folder"])
def test_interrupt_leaves_nothing_half_written(
    place: str,
    ring_zarr: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(place, interrupt)
    assert run("relax", ring_zarr, "-o", tmp_path / "a.zarr") == 130
    check_message(capsys)
    assert list(tmp_path.iterdir()) == []


def test_relax_has_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert run("relax", "--help") == 0
    assert "best known" in " ".join(capsys.readouterr().out.split())


def test_render_relaxes_with_the_best_known_steps(ring_path: Path, tmp_path: Path) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, "--relax") == 0
    expected = pl.trace_photons(pl.load_scene(ring_path), 100).relax(constraint="world").relaxation["settings"]
    settings = pl.load_image(tmp_path / "a.exr").provenance["photons"]["relaxation"]
    assert settings == json.loads(json.dumps(expected))


def test_render_relaxes_as_often_as_asked(ring_path: Path, tmp_path: Path) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.png", *SMALL, "--relax", 3) == 0
    assert pl.load_image(tmp_path / "a.png").provenance["photons"]["relaxation"]["steps"] == 3


def test_render_shows_the_relaxed_photons(ring: pl.Scene, ring_path: Path, tmp_path: Path) -> None:
    options = ("--relax", 2, "--mode", "caustic", "--k", 20)
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, *options) == 0
    relaxed = pl.trace_photons(ring, 5_000).relax(2)
    expected = pl.render(ring, relaxed, width=32, height=32, samples=1, mode="caustic", k=20)
    np.testing.assert_array_equal(np.asarray(pl.load_image(tmp_path / "a.exr")), np.asarray(expected))


def test_render_without_relax_says_nothing_of_it(ring_path: Path, tmp_path: Path) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL) == 0
    assert "relaxation" not in pl.load_image(tmp_path / "a.exr").provenance["photons"]


def test_render_prints_the_steps(ring_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, "--relax", 2) == 0
    assert "2 steps of relaxation" in capsys.readouterr().out


@pytest.mark.parametrize("options", [["--relax", "-1"], ["--relax", "10001"], ["--relax", "x"]], ids=" ".join)
def test_render_refuses_steps_out_of_range(
    options: list[str], ring_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, *options) == 2
    assert "--relax" in check_message(capsys)


def test_render_of_direct_light_alone_has_nothing_to_relax(
    ring_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run("render", ring_path, "-o", tmp_path / "a.exr", *SMALL, "--mode", "direct", "--relax") == 2
    assert "--relax" in check_message(capsys)
