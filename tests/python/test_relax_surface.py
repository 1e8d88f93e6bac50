# SPDX-License-Identifier: Apache-2.0
"""Relaxed photons stay on the surface they were stored on: a sphere stays covered, a border clips."""

from __future__ import annotations

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from gltf import Mesh, build_box, build_quad
from relax_surfaces import build_sphere, cast_onto_facets, find_planes, load_surface, measure_height, place_photons
from twin_pairs import UP, scatter_sphere

Doubles = NDArray[np.float64]

COUNT, STEPS = 3_000, 10
DIVISIONS = 4
REPULSION = (2.0, 1.2)
# Floats: places and unit normals of size 1.
ROUNDING = 2e-6


@cache
def get_mesh() -> Mesh:
    return build_sphere(DIVISIONS)


@pytest.fixture(scope="module")
def sphere(tmp_path_factory: pytest.TempPathFactory) -> pl.Scene:
    return load_surface(tmp_path_factory.mktemp("sphere"), get_mesh())


@pytest.fixture(scope="module")
def covered(sphere: pl.Scene) -> pl.PhotonMap:
    """Random photons on the sphere's facets."""
    directions, _ = scatter_sphere(COUNT, 1)
    return place_photons(sphere, cast_onto_facets(get_mesh(), directions), directions)


@pytest.fixture(scope="module", params=["none", "pca"])
def evened(covered: pl.PhotonMap, request: pytest.FixtureRequest) -> pl.PhotonMap:
    return covered.relax(STEPS, 6, descriptor=request.param, limit=None, over_relaxation=REPULSION)


def measure_unevenness(photons: pl.PhotonMap) -> float:
    """Deviation over mean of the distance to the nearest neighbor."""
    nearest = photons.neighbors(np.arange(len(photons)), 1)[1].astype(np.float64)
    return float(nearest.std() / nearest.mean())


# Sphere


def test_mesh_of_the_sphere_is_closed_and_faces_outward() -> None:
    mesh = build_sphere(2)
    edges = np.sort(mesh.indices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (len(mesh.indices), set(np.unique(edges, axis=0, return_counts=True)[1])) == (320, {2})
    assert find_planes(mesh)[1].min() > 0.9


def test_all_photons_are_on_the_sphere(evened: pl.PhotonMap) -> None:
    assert evened.relaxation["off_surface"] == 0


def test_photons_lie_on_the_facets(evened: pl.PhotonMap) -> None:
    np.testing.assert_allclose(measure_height(get_mesh(), evened.positions.astype(np.float64)), 0.0, atol=ROUNDING)


def test_normals_are_those_of_the_sphere_where_photons_land(evened: pl.PhotonMap) -> None:
    # Interpolated over a facet the normal differs from the exact one by a small share of its angle.
    directions = evened.positions.astype(np.float64)
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    np.testing.assert_allclose(evened.normals, directions, atol=2e-4)


def test_basis_of_constraints_turns_with_the_normals(covered: pl.PhotonMap) -> None:
    moved = covered.relax(STEPS, 6, descriptor="pca", limit=None, over_relaxation=REPULSION)
    axes = np.concatenate([moved.constraint_basis, moved.normals[:, None]], axis=1).astype(np.float64)
    np.testing.assert_allclose(axes @ axes.transpose(0, 2, 1), np.tile(np.eye(3), (COUNT, 1, 1)), atol=1e-5)


def test_photons_are_spread_more_evenly(covered: pl.PhotonMap, evened: pl.PhotonMap) -> None:
    # Random points: 0.52.
    assert measure_unevenness(covered) > 0.45
    assert measure_unevenness(evened) < 0.25


def test_largest_hole_on_the_sphere_shrinks(covered: pl.PhotonMap, evened: pl.PhotonMap) -> None:
    # Random points leave holes of some √(4 ln n / n), even ones of a spacing.
    probes, _ = scatter_sphere(8_000, 9)
    before, after = (photons.neighbors(probes, 1)[1].max() for photons in (covered, evened))
    assert before > 0.08
    assert after < 0.75 * before


def test_without_its_surface_a_sphere_loses_its_photons(covered: pl.PhotonMap) -> None:
    # So that the tests above tell something: tangent planes lead away.
    moved = covered.relax(STEPS, 6, descriptor="none", limit=None, over_relaxation=REPULSION, surface="tangent")
    assert np.linalg.norm(moved.positions, axis=1).max() > 1.01


@pytest.mark.parametrize("descriptor", ["none", "pca"])
def test_photons_just_off_their_surface_count_as_on_it(sphere: pl.Scene, descriptor: str) -> None:
    # On the exact sphere, above its facets by up to a hundredth of the distance between photons.
    off = place_photons(sphere, *scatter_sphere(COUNT, 1))
    assert off.relax(1, 6, descriptor=descriptor).relaxation["off_surface"] == 0


def test_photons_just_off_their_surface_land_on_it(sphere: pl.Scene) -> None:
    off = place_photons(sphere, *scatter_sphere(COUNT, 1))
    moved = off.relax(1, 6, descriptor="pca", constraint_neighbors=50, over_relaxation=REPULSION)
    np.testing.assert_allclose(measure_height(get_mesh(), moved.positions.astype(np.float64)), 0.0, atol=ROUNDING)


# Border


@cache
def crowd_border() -> Doubles:
    """Photons of the square |x|, |z| <= 1, most of them near its border."""
    rng = np.random.default_rng(2)
    flat = np.sign(rng.random((1_500, 2)) - 0.5) * (1.0 - 0.999 * rng.random((1_500, 2)) ** 3)
    return np.stack([flat[:, 0], np.zeros(1_500), flat[:, 1]], axis=1)


@pytest.fixture(scope="module")
def square(tmp_path_factory: pytest.TempPathFactory) -> pl.PhotonMap:
    scene = load_surface(tmp_path_factory.mktemp("square"), build_quad(1.0))
    return place_photons(scene, crowd_border(), np.tile(UP, (1_500, 1)))


@pytest.mark.parametrize("limit", [None, 0.3])
def test_photons_near_a_border_never_leave_it(square: pl.PhotonMap, limit: float | None) -> None:
    relaxation = pl.Relaxation(
        square, steps=STEPS, neighbors=6, descriptor="none", limit=limit, over_relaxation=REPULSION
    )
    for _ in range(STEPS):
        relaxation.step()
        assert np.abs(relaxation.photons.positions).max() <= 1.0 + ROUNDING


def test_border_clips_moves_that_lead_beyond_it(square: pl.PhotonMap) -> None:
    moved = square.relax(STEPS, 6, descriptor="none", over_relaxation=REPULSION)
    assert (np.abs(moved.positions) == 1.0).any()


def test_without_a_surface_photons_leave_the_square(square: pl.PhotonMap) -> None:
    moved = square.relax(STEPS, 6, descriptor="none", over_relaxation=REPULSION, surface="tangent")
    assert np.abs(moved.positions).max() > 1.0


def test_photons_stay_on_their_side_of_an_edge(tmp_path: Path) -> None:
    scene = load_surface(tmp_path, build_box((-1.0, -1.0, -1.0), (1.0, 0.0, 1.0)))
    moved = place_photons(scene, crowd_border(), np.tile(UP, (1_500, 1))).relax(STEPS, 6, descriptor="none")
    np.testing.assert_array_equal(moved.normals, np.tile(UP, (1_500, 1)))
    assert np.abs(moved.positions[:, 1]).max() <= ROUNDING


def test_underside_keeps_its_normals(tmp_path: Path) -> None:
    scene = load_surface(tmp_path, build_quad(1.0))
    moved = place_photons(scene, crowd_border(), np.tile((0.0, -1.0, 0.0), (1_500, 1))).relax(2, 6, descriptor="none")
    np.testing.assert_array_equal(moved.normals, np.tile((0.0, -1.0, 0.0), (1_500, 1)))


def test_photons_stay_on_their_own_object(tmp_path: Path) -> None:
    quad = build_quad(1.0)
    halves = [replace(quad, positions=quad.positions * (0.5, 1.0, 1.0) + (side, 0.0, 0.0)) for side in (-0.5, 0.5)]
    places = crowd_border()
    is_right = places[:, 0] > 0.0
    photons = place_photons(load_surface(tmp_path, *halves), places, np.tile(UP, (1_500, 1)), is_right.astype(np.int64))
    moved = photons.relax(STEPS, 6, descriptor="none", over_relaxation=REPULSION)
    assert moved.positions[is_right, 0].min() == 0.0
    assert moved.positions[~is_right, 0].max() == 0.0
