# SPDX-License-Identifier: Apache-2.0
"""Animations at a time: keys, interpolations, what a map remembers, and what is wrong with a file."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from gltf import GltfWriter, build_quad, make_diffuse

Doubles = NDArray[np.float64]
TIMES = np.array([1.0, 2.0, 4.0])


def write_animated(folder: Path, path: str, values: Doubles, interpolation: str = "LINEAR", **changes: Any) -> Path:
    """A square of half side 1 whose node is animated."""
    writer = GltfWriter("moving")
    writer.add_mesh("square", build_quad(1.0), make_diffuse("plaster", 0.5))
    writer.add_point_light("lamp", (0.0, 5.0, 0.0), 1.0)
    kind = {3: "VEC3", 4: "VEC4"}[values.shape[-1]]
    times = writer._add_accessor(TIMES.astype("<f4"), 5126, "SCALAR", 34962)
    keys = writer._add_accessor(values.astype("<f4").reshape(-1, values.shape[-1]), 5126, kind, 34962)
    writer.write(folder)
    file = folder / "moving.gltf"
    document = json.loads(file.read_text())
    sampler = {"input": times, "output": keys, "interpolation": interpolation, **changes}
    channel = {"sampler": 0, "target": {"node": 0, "path": path}}
    document["animations"] = [{"samplers": [sampler], "channels": [channel]}, {"samplers": [], "channels": []}]
    file.write_text(json.dumps(document))
    return file


def find_middle(scene: pl.Scene) -> Doubles:
    return np.asarray(scene.bounds, dtype=np.float64).mean(axis=0)


PLACES = np.array([[0.0, 0.0, 0.0], [1.0, 2.0, 0.0], [5.0, 0.0, 4.0]])


@pytest.mark.parametrize(
    ("time", "linear", "step"),
    [
        (-3.0, PLACES[0], PLACES[0]),
        (1.25, 0.75 * PLACES[0] + 0.25 * PLACES[1], PLACES[0]),
        (2.0, PLACES[1], PLACES[1]),
        (3.0, 0.5 * PLACES[1] + 0.5 * PLACES[2], PLACES[1]),
        (100.0, PLACES[2], PLACES[2]),
    ],
)
def test_things_are_where_keys_have_them(tmp_path: Path, time: float, linear: Doubles, step: Doubles) -> None:
    for interpolation, truth in (("LINEAR", linear), ("STEP", step)):
        file = write_animated(tmp_path, "translation", PLACES, interpolation)
        np.testing.assert_allclose(find_middle(pl.load_scene(file, time=time)), truth, atol=1e-6)
    at_rest = pl.load_scene(file)
    np.testing.assert_allclose(find_middle(at_rest), 0.0, atol=1e-6)
    assert any("at rest" in line for line in at_rest.report["ignored"])
    assert at_rest.hash != pl.load_scene(file, time=time).hash


def test_rotations_take_the_shorter_arc(tmp_path: Path) -> None:
    """From none to 60 degrees about z, given with the quaternion's other sign."""
    half = np.radians(30.0)
    turned = -np.array([0.0, 0.0, np.sin(half), np.cos(half)])
    file = write_animated(tmp_path, "rotation", np.array([[0.0, 0.0, 0.0, 1.0], turned, turned]))
    bounds = np.asarray(pl.load_scene(file, time=1.5).bounds)
    np.testing.assert_allclose(bounds[1], [np.cos(half), np.sin(half), 1.0], atol=1e-6)


def test_splines_pass_their_keys_with_their_tangents(tmp_path: Path) -> None:
    tangents = np.array([[0.0, 3.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, -2.0]])
    keys = np.stack([0.5 * tangents, PLACES, tangents], axis=1)
    file = write_animated(tmp_path, "translation", keys, "CUBICSPLINE")
    share, seconds = 0.25, 2.0
    h = [2 * share**3 - 3 * share**2 + 1, share**3 - 2 * share**2 + share]
    h += [-2 * share**3 + 3 * share**2, share**3 - share**2]
    truth = h[0] * PLACES[1] + seconds * h[1] * tangents[1] + h[2] * PLACES[2] + seconds * h[3] * 0.5 * tangents[2]
    np.testing.assert_allclose(find_middle(pl.load_scene(file, time=2.5)), truth, atol=1e-6)


def test_scales_and_maps_remember_the_time(tmp_path: Path) -> None:
    file = write_animated(tmp_path, "scale", np.array([[1.0, 1.0, 1.0], [3.0, 1.0, 2.0], [3.0, 1.0, 2.0]]))
    scene = pl.load_scene(file, time=2.0)
    np.testing.assert_allclose(scene.bounds[1], [3.0, 0.0, 2.0], atol=1e-6)
    photons = pl.trace_photons(scene, 2000, store="all", seed=3)
    photons.save(tmp_path / "map.zarr")
    loaded = pl.load_photons(tmp_path / "map.zarr")
    np.testing.assert_array_equal(loaded.path_vertices, photons.path_vertices)  # traced again, at the same time


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"interpolation": "BEZIER"}, "is no interpolation"),
        ({"input": 99}, "accessor"),
        ({"output": 0}, "do not fit|times"),
        ({"interpolation": "CUBICSPLINE"}, "do not fit"),
    ],
)
def test_broken_animations_are_refused_when_a_time_is_asked(
    tmp_path: Path, changes: dict[str, Any], message: str
) -> None:
    file = write_animated(tmp_path, "translation", PLACES, **changes)
    pl.load_scene(file)  # at rest nobody looks
    with pytest.raises(pl.SceneError, match=message):
        pl.load_scene(file, time=1.0)


def test_the_time_comes_first(tmp_path: Path) -> None:
    scene = pl.load_scene(write_animated(tmp_path, "translation", PLACES))
    scene.add_floor()
    with pytest.raises(pl.SceneError, match="give the time first"):
        scene.restore([{"add": "time", "time": 1.0}])
    with pytest.raises(pl.ArgumentError, match="time"):
        pl.load_scene(scene.path, time=float("nan"))


def test_a_file_that_changed_meanwhile_is_another_scene(tmp_path: Path) -> None:
    scene = pl.load_scene(write_animated(tmp_path, "translation", PLACES))
    before = pl.load_scene(scene.path, time=2.0)
    lifted = PLACES + np.array([0.0, 7.0, 0.0])
    write_animated(tmp_path, "translation", lifted)
    scene.restore([{"add": "time", "time": 2.0}])
    np.testing.assert_allclose(find_middle(scene), lifted[1], atol=1e-6)
    assert scene.hash != before.hash
