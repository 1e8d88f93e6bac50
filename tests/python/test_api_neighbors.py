# SPDX-License-Identifier: Apache-2.0
"""Neighbors are exactly those of brute force: nearest first, ties by id, padded, on nasty inputs too."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial import cKDTree

import photonloupe as pl
import twins

QUERIES = 300


def build(positions: NDArray[np.float64]) -> pl.PhotonMap:
    count = len(positions)
    return pl.PhotonMap.from_arrays(
        positions=positions, normals=np.tile((0.0, 1.0, 0.0), (count, 1)), power=np.ones((count, 3))
    )


def make_random(count: int, seed: int = 0) -> NDArray[np.float64]:
    return np.random.default_rng(seed).random((count, 3)).astype(np.float32).astype(np.float64)


def make_lattice(side: int) -> NDArray[np.float64]:
    """A grid, whose distances are exact and tie everywhere."""
    axis = np.arange(side, dtype=np.float64)
    return np.stack(np.meshgrid(axis, axis, axis), axis=-1).reshape(-1, 3)


@pytest.mark.parametrize("k", [1, 6, 50, 250])
def test_distances_equal_scipy(k: int) -> None:
    positions, points = make_random(20_000), make_random(QUERIES, 1)
    _, distances = build(positions).neighbors(points, k)
    truth, _ = cKDTree(positions).query(points, k)
    np.testing.assert_allclose(distances, truth.reshape(QUERIES, k), rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize("k", [1, 20, 250])
def test_ids_equal_brute_force(k: int) -> None:
    positions, points = make_random(5_000), make_random(QUERIES, 2)
    ids, _ = build(positions).neighbors(points, k)
    truth, distances = twins.find_neighbors(positions, points, k)
    # In 32 bits two photons may be equally far that are not in 64: then either order is right.
    differ = ids != truth
    reached = np.linalg.norm(positions[ids] - points[:, None], axis=2)
    np.testing.assert_allclose(reached[differ], distances[differ], rtol=1e-6)


def test_ties_come_by_id() -> None:
    positions = make_lattice(8)
    ids, distances = build(positions).neighbors(positions, 27)
    truth, far = twins.find_neighbors(positions, positions, 27)
    np.testing.assert_array_equal(ids, truth)
    np.testing.assert_array_equal(distances, far.astype(np.float32))


@pytest.mark.parametrize("k", [1, 50, 700])
def test_ties_of_crowds_come_by_id(k: int) -> None:
    """Some 500 photons at each of 12 places, several of which are equally far."""
    random = np.random.default_rng(3)
    positions = make_lattice(3)[random.integers(12, size=6_000)]
    ids, _ = build(positions).neighbors(positions[:40], k)
    np.testing.assert_array_equal(ids, twins.find_neighbors(positions, positions[:40], k)[0])
    asked = np.arange(40)
    ids, _ = build(positions).neighbors(asked, k)
    np.testing.assert_array_equal(ids, twins.find_neighbors(positions, positions[:40], k, excluded=asked)[0])


@pytest.mark.parametrize("columns", [1, 2])
@pytest.mark.parametrize("k", [1, 50, 700])
def test_ties_of_few_parameters_come_by_id(k: int, columns: int) -> None:
    """Photons of discrete parameters, spread out in space."""
    values = np.random.default_rng(4).integers(4, size=(6_000, columns)).astype(np.float64)
    photons = build(make_random(6_000))
    photons.set_parameters(values)
    asked = np.arange(40)
    ids, _ = photons.neighbors(asked, k, space="parameter")
    np.testing.assert_array_equal(ids, twins.find_neighbors(values, values[:40], k, excluded=asked)[0])


def test_photon_is_not_its_own_neighbor() -> None:
    positions = make_lattice(6)
    every = np.arange(len(positions))
    ids, _ = build(positions).neighbors(every, 10)
    truth, _ = twins.find_neighbors(positions, positions, 10, excluded=every)
    np.testing.assert_array_equal(ids, truth)


def test_point_at_a_photon_finds_it() -> None:
    positions = make_random(100)
    ids, distances = build(positions).neighbors(positions[:5], 1)
    assert ids[:, 0].tolist() == [0, 1, 2, 3, 4]
    assert not distances.any()


@pytest.mark.parametrize("count", [0, 1, 2, 5])
def test_too_few_photons_are_padded(count: int) -> None:
    ids, distances = build(make_random(count)).neighbors(make_random(3, 1), 7)
    assert (ids[:, count:] == -1).all()
    assert np.isinf(distances[:, count:]).all()


def test_k_of_a_thousand_on_fewer_photons() -> None:
    ids, _ = build(make_random(600)).neighbors(make_random(2, 1), 1000)
    np.testing.assert_array_equal(np.sort(ids[:, :600], axis=1), np.tile(np.arange(600), (2, 1)))


def test_no_points_give_no_rows() -> None:
    ids, distances = build(make_random(10)).neighbors(np.zeros((0, 3)), 4)
    assert (ids.shape, distances.shape) == ((0, 4), (0, 4))


def test_photons_at_one_point_come_by_id() -> None:
    ids, distances = build(np.full((500, 3), 0.25)).neighbors([[0.25, 0.25, 0.25]], 60)
    assert ids[0].tolist() == list(range(60))
    assert not distances.any()


def test_photons_on_a_line() -> None:
    positions = np.zeros((4_000, 3))
    positions[:, 0] = np.random.default_rng(3).permutation(4_000)
    ids, _ = build(positions).neighbors(positions[:50], 9)
    np.testing.assert_array_equal(ids, twins.find_neighbors(positions, positions[:50], 9)[0])


@pytest.mark.parametrize("exponent", [-20, 20])
def test_scaling_by_a_power_of_two_changes_no_neighbor(exponent: int) -> None:
    positions, points = make_random(3_000), make_random(50, 4)
    ids, distances = build(positions).neighbors(points, 30)
    factor = 2.0**exponent
    scaled_ids, scaled = build(positions * factor).neighbors(points * factor, 30)
    np.testing.assert_array_equal(scaled_ids, ids)
    np.testing.assert_array_equal(scaled, distances * np.float32(factor))


def test_far_point_still_finds_all() -> None:
    positions = make_random(200)
    ids, _ = build(positions).neighbors([[1e6, 0.0, 0.0]], 200)
    assert np.sort(ids[0]).tolist() == list(range(200))


def test_neighbors_on_the_ring_equal_scipy(ring_map: pl.PhotonMap) -> None:
    ids = np.arange(0, len(ring_map), len(ring_map) // QUERIES)[:QUERIES]
    _, distances = ring_map.neighbors(ids, 50)
    positions = ring_map.positions.astype(np.float64)
    truth, _ = cKDTree(positions).query(positions[ids], 51)
    np.testing.assert_allclose(distances, truth[:, 1:], rtol=1e-5, atol=1e-7)


@pytest.mark.parametrize("k", [0, 1001, 2.5, "five"])
def test_k_out_of_range_is_refused(k: object) -> None:
    with pytest.raises(pl.ArgumentError, match="k must"):
        build(make_random(10)).neighbors([[0, 0, 0.0]], k)  # type: ignore[arg-type]


@pytest.mark.parametrize("points", [[[0.0, np.nan, 0.0]], [[0.0, 0.0]], [-1], [10], [0.5], "all", [[0, 0, np.inf]]])
def test_wrong_points_are_refused(points: object) -> None:
    with pytest.raises(pl.ArgumentError):
        build(make_random(10)).neighbors(points, 3)  # type: ignore[arg-type]


def test_tree_holds_every_photon_once(ring_map: pl.PhotonMap) -> None:
    tree = ring_map.tree
    assert np.sort(tree["order"]).tolist() == list(range(len(ring_map)))
