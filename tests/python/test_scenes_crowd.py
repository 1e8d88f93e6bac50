# SPDX-License-Identifier: Apache-2.0
"""A crowd of bodies and lamps: a million triangles are loaded and traced, and every lamp and body takes part."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import photonloupe as pl
from conftest import SCENES
from crowded_floor import CROWD
from gltf import Mesh

KINDS = ("ring", "prism", "ball")


@pytest.fixture(scope="module")
def scene(tmp_path_factory: pytest.TempPathFactory) -> pl.Scene:
    folder = tmp_path_factory.mktemp("crowd")
    command = [sys.executable, str(SCENES / "generate.py"), "crowd", "-o", str(folder)]
    subprocess.run(command, check=True, capture_output=True)
    return pl.load_scene(folder / "crowd" / "crowd.gltf")


@pytest.fixture(scope="module")
def photons(scene: pl.Scene) -> pl.PhotonMap:
    return pl.trace_photons(scene, 100_000, seed=1)


def test_crowd_has_a_million_triangles_in_forty_bodies(scene: pl.Scene) -> None:
    bodies = [each for each in scene.objects if each["name"].split()[0] in KINDS]
    assert len(bodies) == CROWD.rows * CROWD.columns == 40
    assert sum(each["triangle_count"] for each in bodies) >= 1_000_000
    assert {each["name"].split()[0] for each in bodies} == set(KINDS)
    assert len(scene.lights) == CROWD.lamp_count


@pytest.mark.parametrize("kind", KINDS)
def test_bodies_are_where_their_places_are(kind: str) -> None:
    body: Mesh = CROWD.build_bodies()[kind]
    reach = np.hypot(body.positions[:, 0], body.positions[:, 2]).max()
    assert body.positions[:, 1].min() == pytest.approx(CROWD.gap, abs=1e-9)
    places = CROWD.list_places()[:, :2]
    gaps = np.linalg.norm(places[:, None] - places[None], axis=2) + 10.0 * np.eye(len(places))
    assert gaps.min() > 2.0 * reach  # none runs into another


def test_every_lamp_lights_every_kind_by_its_power(scene: pl.Scene, photons: pl.PhotonMap) -> None:
    names = np.array([each["name"].split()[0] for each in scene.objects])
    first = photons.path_objects[photons.path_offsets[:-1] + 1]
    for lamp in range(CROWD.lamp_count):
        met = names[first[photons.emitter == lamp]]
        assert {kind for kind in KINDS if np.count_nonzero(met == kind) > 100} == set(KINDS)
    flux = np.bincount(photons.emitter, photons.power[:, 0], CROWD.lamp_count)
    # The outer lamps light what lies below them about alike; they send from half to three halves.
    assert np.corrcoef(flux, [light["intensity"][0] for light in scene.lights])[0, 1] > 0.9


def test_every_body_throws_light(scene: pl.Scene, photons: pl.PhotonMap) -> None:
    first = photons.path_objects[photons.path_offsets[:-1] + 1]
    counts = np.bincount(first, minlength=len(scene.objects))
    assert (counts[:40] > 200).all()


def test_flux_is_balanced(photons: pl.PhotonMap) -> None:
    flux = photons.report["flux"]
    ends = np.sum([flux[end] for end in ("deposited", "escaped", "truncated")], axis=0)
    np.testing.assert_allclose(ends, flux["emitted"], rtol=1e-5)
