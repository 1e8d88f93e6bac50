# SPDX-License-Identifier: Apache-2.0
"""Lights and floors that a file lacks: added by Python, the command line and the studio, kept by maps and sessions."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from conftest import write_scene
from gltf import GltfWriter
from lit_scenes import (
    add_optics,
    build_panel,
    load,
    make_lamp,
    render_below,
)


def test_added_lights_are_those_of_files(tmp_path: Path) -> None:
    pairs: list[tuple[Callable[[GltfWriter], Any], dict[str, Any]]] = [
        (
            lambda writer: writer.add_point_light("lamp", (0.1, 1.0, 0.2), 4.0),
            {"kind": "point", "position": (0.1, 1.0, 0.2), "intensity": 4.0},
        ),
        (
            lambda writer: writer.add_spot_light("spot", (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), 4.0, 0.1, 0.4),
            {"kind": "spot", "position": (0, 1, 0), "direction": (1, -1, 0), "intensity": 4.0, "cone": (0.1, 0.4)},
        ),
        (
            lambda writer: writer.add_directional_light("sun", (1.0, -1.0, 0.0), 2.0),
            {"kind": "directional", "direction": (1, -1, 0), "intensity": 2.0},
        ),
        (
            lambda writer: writer.add_mesh("panel", build_panel(0.25, 1.0), make_lamp(8.0)),
            {"kind": "area", "position": (0, 1, 0), "size": (0.5, 0.5), "intensity": 8.0, "color": (1, 0.5, 0.25)},
        ),
    ]
    for number, (change, told) in enumerate(pairs):
        filed = load(tmp_path / f"filed {number}", change)
        added = load(tmp_path / f"bare {number}", lambda writer: None)
        before = added.hash
        added.add_light(**told)
        assert added.hash != before
        assert added.additions[0]["kind"] == told["kind"]
        assert [light["kind"] for light in added.lights] == [told["kind"]]
        np.testing.assert_allclose(render_below(added, 256), render_below(filed, 256), rtol=0.02)
        flux = [pl.trace_photons(scene, 10_000, store="all").report["flux"]["emitted"] for scene in (added, filed)]
        np.testing.assert_allclose(flux[0], flux[1], rtol=1e-5)


def test_added_light_and_floor_come_back_with_the_map(tmp_path: Path) -> None:
    path = write_scene(tmp_path, "bare", add_optics, lamp=False, floor=False)
    scene = pl.load_scene(path)
    with pytest.raises(pl.SceneError, match="no emitter; add one"):
        pl.trace_photons(scene, 1000)
    scene.add_floor()
    scene.add_light("auto")
    photons = pl.trace_photons(scene, 5000)
    assert {scene.objects[i]["name"] for i in np.unique(photons.object)} <= {"added floor", "wall"}
    photons.save(tmp_path / "map.zarr")
    loaded = pl.load_photons(tmp_path / "map.zarr")
    np.testing.assert_array_equal(loaded.path_vertices, photons.path_vertices)  # traced again, in the same scene
    relaxed = loaded.relax(2)
    assert relaxed.report is not None
    for damaged in ("lava", [3], [{"add": "lava"}], [{"add": "light"}], [{"add": "light", "kind": []}]):
        loaded._provenance["scene_additions"], loaded._scene = damaged, None
        with pytest.raises(pl.PhotonLoupeError):
            loaded.find_surface()
    assert np.ptp(relaxed.positions[relaxed.object == photons.object.max()][:, 1]) < 1e-5  # still on the floor


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"kind": "lava"}, "kind"),
        ({"kind": "environment", "color": (1, -1, 1)}, "color"),
        ({"kind": "point", "intensity": -1.0}, "intensity"),
        ({"kind": "point", "position": (0, 1)}, "position"),
        ({"kind": "point", "position": (0, 1, np.nan)}, "position"),
        ({"kind": "spot", "direction": (0, 0, 0)}, "no direction"),
        ({"kind": "spot", "cone": (0.4, 0.2)}, "inner angle"),
        ({"kind": "area", "size": (0, 1)}, "size"),
        ({"kind": "area", "size": (1e25, 1e25)}, "area"),
        ({"kind": "area", "size": (1e-30, 1e-30), "position": (1, 1, 1)}, "area"),
    ],
)
def test_wrong_additions_are_refused(tmp_path: Path, told: dict[str, Any], message: str) -> None:
    scene = load(tmp_path, lambda writer: None)
    before = scene.hash
    with pytest.raises(pl.PhotonLoupeError, match=message):
        scene.add_light(**told)
    assert scene.hash == before


def test_sessions_bring_no_code_and_no_nonsense(tmp_path: Path) -> None:
    path = write_scene(tmp_path, "bare", add_optics, lamp=False)
    code = '{"add":"floor","y":-1.0,"y=print(1))#":1}'
    for addition in (code, '{"add":5}', "lava", "[", '{"add":"light","kind":{}}', '{"add":"light"}'):
        with pl.Studio(scene=path, offscreen=True, size=(400, 300), photons=1000) as studio:
            state = json.loads(studio.state)
            state["trace"]["additions"] = [addition]
            studio.set_state(json.dumps(state))
            studio.frame()
            assert studio.has_failed
            assert "print" not in studio.python()
            studio.command("edit.copy_python")


def test_bare_scene_is_lit_and_rendered_from_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    from photonloupe.cli import main  # noqa: PLC0415

    path = write_scene(tmp_path, "bare", lamp=False)
    picture = tmp_path / "bare.png"
    size = ["--width", "32", "--height", "32", "--samples", "1"]
    assert main(["render", str(path), "-o", str(picture), *size]) == 2
    assert "--light auto" in capsys.readouterr().err
    assert main(["render", str(path), "-o", str(picture), *size, "--light", "auto", "--exposure", "auto"]) == 0
    assert "nothing specular" in caplog.text
    pixels = np.asarray(pl.load_image(picture))
    assert 0.3 < pixels.max() <= 1.0
    caplog.clear()
    assert main(["render", str(path), "-o", str(picture), *size, "--light", "point 0,1,0 1e4"]) == 0
    assert "--exposure auto" in caplog.text
    for wrong in ("lava", "point 0,1", "point 0,1,x", "spot 0,1,0 0,0,0", "point 0,0,0 1 2 3", ""):
        assert main(["render", str(path), "-o", str(picture), *size, "--light", wrong]) == 2
    assert main(["trace", str(path), "-o", str(tmp_path / "m.zarr"), "--light", "auto", "--store", "all"]) == 0
    assert main(["render", str(path), "-o", str(picture), *size, "--map", str(tmp_path / "m.zarr")]) == 0


def test_studio_offers_a_light_to_a_scene_without_one(tmp_path: Path) -> None:
    path = write_scene(tmp_path, "dark", add_optics, lamp=False)
    with pl.Studio(scene=path, offscreen=True, size=(1000, 700), photons=5000) as studio:
        studio.frame()
        assert "no emitter" in studio.message
        studio.press("Status/Add light")
        studio.frame()
        assert len(studio.photons) >= 5000
        assert studio.scene is not None
        assert [light["name"] for light in studio.scene.lights] == ["key light"]
        assert 'scene.add_light("auto")' in studio.python()
        state = studio.state
        picture = studio.photons.positions.copy()
        studio.command("edit.undo")
        studio.frame()
        assert "no emitter" in studio.message
    with pl.Studio(offscreen=True, size=(1000, 700)) as other:
        other.set_state(state)
        other.frame()
        np.testing.assert_array_equal(other.photons.positions, picture)
        program = other.python().split("camera =")[0]
    names: dict[str, Any] = {}
    exec(program, names)
    np.testing.assert_array_equal(names["photons"].positions, picture)
