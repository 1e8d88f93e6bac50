# SPDX-License-Identifier: Apache-2.0
"""The leaf's normals are exact, the marble rests on it, and light passes it where its texture says."""

from __future__ import annotations

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene
from gltf import Mesh
from marble_leaf import LEAF, build_blade, paint_veins


@pytest.fixture(scope="module")
def scene() -> pl.Scene:
    return pl.load_scene(find_scene("leaf"))


@pytest.fixture(scope="module")
def blade() -> Mesh:
    return build_blade(LEAF)[0]


def test_leaf_loads_with_nothing_left_out_but_specular_lobes(scene: pl.Scene) -> None:
    assert [line for line in scene.report["ignored"] if "lobe" not in line] == []
    assert {"translucency", "textures"} <= set(scene.report["requires"])


def test_marble_has_enough_triangles(scene: pl.Scene) -> None:
    assert next(each["triangle_count"] for each in scene.objects if each["name"] == "marble") >= 20_000


def test_normals_are_those_of_the_height_over_the_plane(blade: Mesh) -> None:
    """Against differences of the heights; and every triangle faces up."""
    x, _, z = blade.positions.T
    step = 1e-6
    along = (LEAF.find_height(x + step, z)[0] - LEAF.find_height(x - step, z)[0]) / (2.0 * step)
    sideways = (LEAF.find_height(x, z + step)[0] - LEAF.find_height(x, z - step)[0]) / (2.0 * step)
    upward = np.stack([-along, np.ones_like(x), -sideways], axis=1)
    np.testing.assert_allclose(blade.normals, upward / np.linalg.norm(upward, axis=1, keepdims=True), atol=1e-6)
    a, b, c = (blade.positions[blade.indices[:, i]] for i in range(3))
    assert (np.cross(b - a, c - a)[:, 1] > 0.0).all()


def test_marble_rests_on_the_leaf_and_the_leaf_above_the_plane(blade: Mesh) -> None:
    middle, radius = np.array(LEAF.marble_place), LEAF.marble_radius
    x, z = np.meshgrid(*[np.linspace(-radius, radius, 601)] * 2)
    height, _, _ = LEAF.find_height(middle[0] + x, middle[2] + z)
    nearest = np.sqrt(x**2 + z**2 + (height - middle[1]) ** 2).min()
    assert radius < nearest < radius + 2e-4
    assert blade.positions[:, 1].min() > 0.001


def test_veins_pass_less_light_than_the_blade_between_them() -> None:
    share = paint_veins(LEAF)[..., 3] / 255.0
    middle = share[LEAF.texture_height // 2]
    assert middle.mean() < 0.5 * np.median(share)
    assert abs(np.median(share) - LEAF.passing_share) < 0.05


def test_the_marbles_light_is_brightest_beside_it_away_from_the_lamp(scene: pl.Scene) -> None:
    photons = pl.trace_photons(scene, 50_000, seed=1)
    names = [each["name"] for each in scene.objects]
    on_leaf = photons.positions[photons.object == names.index("leaf")].astype(np.float64)
    middle = np.median(on_leaf - np.array(LEAF.marble_place), axis=0)[[0, 2]]
    away = -np.array([LEAF.light[0], LEAF.light[2]])
    assert middle @ away / np.linalg.norm(middle) / np.linalg.norm(away) > 0.95
    assert 0.3 * LEAF.marble_radius < np.linalg.norm(middle) < 1.5 * LEAF.marble_radius
    assert len(on_leaf) > 0.5 * len(photons)


def test_light_that_passed_the_leaf_lands_green_on_the_plane(scene: pl.Scene) -> None:
    photons = pl.trace_photons(scene, 20_000, seed=1, store="indirect", emission="random")
    names = [each["name"] for each in scene.objects]
    starts = photons.path_offsets[:-1]
    last = photons.path_offsets[1:] - 2
    passed = (photons.object == names.index("floor")) & (photons.path_objects[last] == names.index("leaf"))
    passed &= (last - starts == 1) & (photons.path_interactions[last] == 2)
    power = photons.power[passed].astype(np.float64).sum(axis=0)
    assert passed.sum() > 500
    # Between the veins' color and the blade's, nearer to the blade's, which most of it met.
    assert LEAF.blade[0] / LEAF.blade[1] < power[0] / power[1] < LEAF.vein[0] / LEAF.vein[1]
    assert power[2] < 0.5 * power[1]
