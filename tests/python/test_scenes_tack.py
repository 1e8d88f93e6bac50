# SPDX-License-Identifier: Apache-2.0
"""The tack is a closed solid with exact normals; constraints keep what relaxation alone blurs."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from conftest import SCENES, find_scene
from gltf import Mesh
from thumb_tack import TACK
from turning import build_profile, turn_profile

COUNT = 50_000
REFERENCE_COUNT = 1_000_000


@pytest.fixture(scope="module")
def scene() -> pl.Scene:
    return pl.load_scene(find_scene("tack"))


@pytest.fixture(scope="module")
def photons(scene: pl.Scene) -> pl.PhotonMap:
    return pl.trace_photons(scene, COUNT, seed=1, emission="random")


def find_facets(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Twice the area times the normal of every triangle, and the middle of its vertices."""
    a, b, c = (mesh.positions[mesh.indices[:, i]] for i in range(3))
    return np.cross(b - a, c - a), (a + b + c) / 3.0


@pytest.mark.parametrize("corners", [TACK.list_corners(), TACK.list_pin_corners()])
def test_plastic_and_pin_are_closed_and_face_outward(corners: list) -> None:
    mesh = turn_profile(build_profile(corners), 24)
    edges = np.sort(mesh.indices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    areas, middles = find_facets(mesh)
    middle = 0.5 * (mesh.positions.min(axis=0) + mesh.positions.max(axis=0))
    assert np.einsum("ij,ij->", areas, middles - middle) > 0.0


def test_curved_parts_have_enough_triangles(scene: pl.Scene) -> None:
    assert sum(each["triangle_count"] for each in scene.objects) >= 20_000


def test_pin_stands_on_the_board_without_touching_it_and_reaches_into_the_plastic() -> None:
    assert 0.0 < TACK.pin_gap < 0.001
    assert TACK.collar_bottom < TACK.pin_top < TACK.neck_top


def test_tack_loads_with_nothing_left_out_but_the_boards_lobe(scene: pl.Scene) -> None:
    assert [line for line in scene.report["ignored"] if "lobe" not in line] == []


def test_flux_that_leaves_the_lamp_arrives_or_escapes(photons: pl.PhotonMap) -> None:
    flux = photons.report["flux"]
    ends = np.sum([flux[end] for end in ("deposited", "escaped", "truncated")], axis=0)
    np.testing.assert_allclose(ends, flux["emitted"], rtol=1e-5)


def test_constraints_keep_what_relaxation_alone_blurs(scene: pl.Scene, photons: pl.PhotonMap) -> None:
    middle, half = np.array(TACK.close_center), TACK.close_half
    x, z = (axis.ravel() for axis in np.meshgrid(*[half * np.linspace(-1.0, 1.0, 96)] * 2))
    points = middle + np.stack([x, 0.0 * x, z], axis=1)
    truth = pl.trace_photons(scene, REFERENCE_COUNT, seed=99).irradiance(points, [0, 1, 0], k=40)[:, 0]

    def find_error(relaxed: pl.PhotonMap, k: int) -> float:
        return float(np.abs(relaxed.irradiance(points, [0, 1, 0], k=k)[:, 0] - truth).mean() / truth.mean())

    raw = min(find_error(photons, k) for k in (20, 50, 100))
    naive = find_error(photons.relax(descriptor="none"), 11)
    scripted = pl.trace_photons(scene, COUNT, seed=1, emission="random")
    scripted.run_script(SCENES / "scripts" / "primal_trajectory.photon")
    constrained = find_error(scripted.relax(constraint="parameter"), 11)
    assert constrained < 0.9 * raw
    assert naive > 1.2 * raw
