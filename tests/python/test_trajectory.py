# SPDX-License-Identifier: Apache-2.0
"""Primal trajectories are those of [SJL15] eq. 3, one plane for each light."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl

Doubles = NDArray[np.float64]

COUNT = 3_000
# Directions come from 32-bit vertices metres apart.
TOLERANCE = 2e-6


def build(directions: Doubles, emitter: Sequence[int] | None = None, *, length: float = 2.0) -> pl.PhotonMap:
    """Photons that flew from the origin along unit vectors, then on to a floor."""
    count = len(directions)
    ends = np.tile([[0.0, -5.0, 0.0]], (count, 1))
    vertices = np.stack([np.zeros((count, 3)), length * directions, ends], axis=1).reshape(-1, 3)
    return pl.PhotonMap.from_arrays(
        positions=ends,
        normals=np.tile([[0.0, 1.0, 0.0]], (count, 1)),
        power=np.ones((count, 3)),
        emitter=emitter,
        path_offsets=3 * np.arange(count + 1),
        path_vertices=vertices,
    )


def make_cone(axis: Sequence[float], seed: int = 0, count: int = 50) -> Doubles:
    """Unit vectors around an axis."""
    directions = np.asarray(axis, dtype=float) + 0.3 * np.random.default_rng(seed).normal(size=(count, 3))
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)


def find_basis(w: Doubles) -> tuple[Doubles, Doubles]:
    """Tangents as printed by Duff et al.: listing 3, scalar by scalar."""
    x, y, z = (float(value) for value in w)
    sign = math.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return np.array([1.0 + sign * x * x * a, sign * b, -sign * x]), np.array([b, sign + y * y * a, -y])


def find_trajectory(directions: Doubles) -> Doubles:
    """Equation 3 photon by photon, from its definition."""
    w = np.sum(directions, axis=0)
    w /= math.sqrt(w @ w)
    u, v = find_basis(w)
    rows = []
    for t in directions:
        theta = math.acos(max(-1.0, min(1.0, float(t @ w))))
        phi = math.atan2(float(t @ u), float(t @ v))
        rows.append((theta * math.sin(phi), theta * math.cos(phi)))
    return np.array(rows)


def find_first_segments(photons: pl.PhotonMap) -> Doubles:
    rows = []
    for first in photons.path_offsets[:-1]:
        start, end = photons.path_vertices[first : first + 2].astype(float)
        rows.append((end - start) / np.linalg.norm(end - start))
    return np.array(rows)


def test_trajectory_of_the_ring_is_that_of_equation_three(ring: pl.Scene) -> None:
    photons = pl.trace_photons(ring, COUNT, seed=3)
    expected = find_trajectory(find_first_segments(photons))
    np.testing.assert_allclose(pl.find_primal_trajectory(photons), expected, atol=TOLERANCE)


@pytest.mark.parametrize("axis", [(0, 0, 1), (0, 0, -1), (0, -1, 0), (1, 1, -1), (-0.2, 0.3, 0.9)])
def test_trajectory_holds_around_every_axis(axis: tuple[float, ...]) -> None:
    directions = make_cone(axis)
    np.testing.assert_allclose(
        pl.find_primal_trajectory(build(directions)), find_trajectory(directions), atol=TOLERANCE
    )


def test_first_coordinate_is_along_u() -> None:
    # Around w = z the basis is u = x, v = y; the pair is even about w.
    tilt = 0.1
    pair = np.array([[math.sin(tilt), 0.0, math.cos(tilt)], [-math.sin(tilt), 0.0, math.cos(tilt)]])
    np.testing.assert_allclose(pl.find_primal_trajectory(build(pair)), [[tilt, 0.0], [-tilt, 0.0]], atol=TOLERANCE)


def test_distance_from_the_middle_is_the_angle_to_the_mean_direction() -> None:
    directions = make_cone((0, -1, 0))
    mean = directions.mean(axis=0) / np.linalg.norm(directions.mean(axis=0))
    lengths = np.linalg.norm(pl.find_primal_trajectory(build(directions)), axis=1)
    np.testing.assert_allclose(lengths, np.arccos(directions @ mean), atol=TOLERANCE)


def test_each_emitter_has_a_mean_direction_of_its_own() -> None:
    one, two = make_cone((0, -1, 0), 1), make_cone((1, 0, 0), 2)
    photons = build(np.concatenate([one, two]), [0] * len(one) + [7] * len(two))
    expected = np.concatenate([find_trajectory(one), find_trajectory(two)])
    np.testing.assert_allclose(pl.find_primal_trajectory(photons), expected, atol=TOLERANCE)


def test_length_of_the_first_segment_does_not_matter() -> None:
    directions = make_cone((0, -1, 0))
    near, far = (pl.find_primal_trajectory(build(directions, length=length)) for length in (0.5, 1024.0))
    np.testing.assert_allclose(near, far, atol=TOLERANCE)


def test_direction_opposite_to_the_mean_is_at_pi() -> None:
    directions = np.array([[0.0, 0.0, 1.0]] * 3 + [[0.0, 0.0, -1.0]])
    assert np.linalg.norm(pl.find_primal_trajectory(build(directions))[3]) == pytest.approx(math.pi, abs=1e-6)


def test_directions_that_cancel_still_have_trajectories() -> None:
    assert np.isfinite(pl.find_primal_trajectory(build(np.array([[0.0, 0.0, 1.0], [0.0, 0.0, -1.0]])))).all()


def test_path_without_a_first_segment_is_unset() -> None:
    directions = make_cone((0, -1, 0))
    directions[4] = 0.0
    assert np.flatnonzero(np.isnan(pl.find_primal_trajectory(build(directions))).any(axis=1)).tolist() == [4]


def test_path_of_one_vertex_is_unset() -> None:
    directions = make_cone((0, -1, 0), count=3)
    photons = build(directions)
    short = pl.PhotonMap.from_arrays(
        positions=photons.positions,
        normals=photons.normals,
        power=photons.power,
        path_offsets=[0, 3, 4, 7],
        path_vertices=photons.path_vertices[[0, 1, 2, 3, 6, 7, 8]],
    )
    assert np.isnan(pl.find_primal_trajectory(short)).any(axis=1).tolist() == [False, True, False]


def test_map_without_photons_has_no_trajectories() -> None:
    assert pl.find_primal_trajectory(build(np.zeros((0, 3)))).shape == (0, 2)


def test_map_without_paths_is_refused() -> None:
    photons = pl.PhotonMap.from_arrays(positions=[[0, 0, 0]], normals=[[0, 1, 0]], power=[[1, 1, 1]])
    with pytest.raises(pl.PhotonLoupeError, match="paths"):
        pl.find_primal_trajectory(photons)


def test_relaxed_map_keeps_its_trajectories(ring: pl.Scene) -> None:
    photons = pl.trace_photons(ring, COUNT, seed=3)
    relaxed = photons.relax(steps=2)
    np.testing.assert_array_equal(pl.find_primal_trajectory(relaxed), pl.find_primal_trajectory(photons))
