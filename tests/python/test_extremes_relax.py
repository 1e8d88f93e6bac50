# SPDX-License-Identifier: Apache-2.0
"""Extremes of relaxation and constraints: few, coincident, collinear, far, tiny, huge, unlimited."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from constraint_twins import constrain
from extremes_table import add_row, show
from relax_twins import Settings, Step, relax_step
from twin_pairs import Pair, make_pair, scatter_flat, scatter_sphere

Doubles = NDArray[np.float64]

COUNT = 300
REPULSION = (2.0, 1.2)
DESCRIPTORS = ("gradient", "pca", "tensor", "split")
STATE = ("positions", "normals", "drift", "pressure", "gradient", "one_sidedness", "constraint_basis")
# As a share of the radius, as in the tests of one step itself.
TOLERANCE = 1e-5
UP = (0.0, 1.0, 0.0)


def make_twin_step(pair: Pair, neighbors: int = 6) -> Step:
    return relax_step(pair.twin, Settings(steps=1, neighbors=neighbors), 0)


def measure_step(pair: Pair, neighbors: int = 6) -> float:
    """Largest error of one free step against the twin, as a share of the photon's radius."""
    moved = pair.program.relax(1, neighbors, descriptor="none", over_relaxation=REPULSION)
    twin = make_twin_step(pair, neighbors)
    assert np.isfinite(moved.positions).all()
    error = np.linalg.norm(moved.drift - twin.moves, axis=1)
    return float((error[twin.radii > 0.0] / twin.radii[twin.radii > 0.0]).max(initial=0.0))


def check_finite(photons: pl.PhotonMap) -> None:
    assert [name for name in STATE if not np.isfinite(getattr(photons, name)).all()] == []


def test_few_photons_relax_as_the_twins() -> None:
    error = max(measure_step(make_pair(*scatter_flat(count, 1))) for count in (1, 2, 7, 8))
    assert make_pair(np.empty((0, 3))).program.relax(2).positions.shape == (0, 3)
    add_row("relax-few", f"error {show(error)} radii")
    assert error < TOLERANCE


def test_fewest_and_most_neighbors_relax_as_the_twins() -> None:
    pair = make_pair(*scatter_flat(COUNT, 2))
    error = max(measure_step(pair, neighbors) for neighbors in (1, 998))
    add_row("relax-k", f"error {show(error)} radii")
    assert error < TOLERANCE


def test_neighbors_out_of_range_are_refused() -> None:
    photons = make_pair(*scatter_flat(20, 2)).program
    for neighbors in (0, 999):
        with pytest.raises(pl.ArgumentError, match="neighbors must be from 1 to 998"):
            photons.relax(1, neighbors)
    for neighbors in (11, 999):
        with pytest.raises(pl.ArgumentError, match="constraint_neighbors must be from 12 to 998"):
            photons.constrain(constraint_neighbors=neighbors)
    add_row("relax-k-limit", "message checked")


def test_photons_at_one_point_are_free_and_part() -> None:
    # So many that a workgroup has not turns enough for its photons.
    photons = make_pair(np.tile((0.5, 0.0, 0.5), (10_000, 1))).program
    few = photons.select(np.arange(1_000))
    for descriptor in DESCRIPTORS:
        found = (photons if descriptor == "tensor" else few).constrain(descriptor=descriptor)
        check_finite(found)
        assert not found.constraint_weights.any(), descriptor
        assert not found.gradient.any(), descriptor
    moved = photons.relax(2, 6, descriptor="none")
    check_finite_without_constraint(moved)
    assert (np.linalg.norm(moved.drift, axis=1) > 0.0).all()
    add_row("relax-one-point", "checked")


def test_photons_at_two_points_stay_near() -> None:
    places = np.zeros((1000, 3))
    places[500:, 0] = 0.2
    largest = 0.0
    for descriptor in DESCRIPTORS:
        moved = make_pair(places).program.relax(3, 6, descriptor=descriptor)
        check_finite(moved)
        largest = max(largest, float(np.linalg.norm(moved.drift, axis=1).max()) / 0.2)
    add_row("relax-two-points", show(largest))
    assert largest < 1e-3


def test_photons_on_one_line_are_held_across_and_stay_on_it() -> None:
    places = np.zeros((2_000, 3))
    places[:, 0] = np.random.default_rng(3).random(2_000)
    pair = make_pair(places)
    error = 0.0
    for descriptor in ("gradient", "pca", "tensor"):
        moved = pair.program.relax(3, 6, descriptor=descriptor)
        check_finite(moved)
        assert not moved.drift[:, 1:].any()
        expected = constrain(pair.twin, descriptor).constraint.weights
        error = max(error, float(np.abs(moved.constraint_weights - expected).max()))
    assert (pair.program.constrain(descriptor="pca").constraint_weights[:, 1] == 1.0).all()
    add_row("relax-one-line", f"error {show(error)}")
    assert error < 2e-5


def test_clusters_that_are_far_apart_relax_as_the_twins() -> None:
    # On a grid that floats hold at that distance.
    places = np.round(np.random.default_rng(4).random((1000, 3)) * 1024.0) / 1024.0 * (1.0, 0.0, 1.0)
    places[500:, 0] += 1e4
    places = np.unique(places, axis=0)  # photons that coincide are pushed any way
    error = measure_step(make_pair(places))
    add_row("relax-clusters", f"error {show(error)} radii")
    # A cluster's moves are rounded to the float spacing 10⁴ from the middle, 5e-4, against radii from 0.02.
    assert error < 0.05


def test_extreme_flux_relaxes_as_any() -> None:
    places, normals = scatter_flat(COUNT, 5)
    usual = np.random.default_rng(5).random((COUNT, 3))

    def build(power: Doubles) -> pl.PhotonMap:
        return pl.PhotonMap.from_arrays(positions=places, normals=normals, power=power)

    expected = build(usual).relax(3, 6).positions
    error = 0.0
    for flux in (1e-30, 1e-20, 1e20, 1e30):
        photons = build(usual * flux)
        moved = photons.relax(3, 6)
        np.testing.assert_array_equal(moved.positions, expected)
        np.testing.assert_array_equal(moved.power, photons.power)
        diffused = photons.relax(3, 6, diffuse_flux=True)
        assert np.isfinite(diffused.power).all()
        error = max(error, float(np.abs(diffused.total_flux / photons.total_flux - 1.0).max()))
    add_row("relax-flux", f"error of the sum {show(error)}")
    assert error < 1e-6


def test_photons_without_flux_relax() -> None:
    places, normals = scatter_flat(COUNT, 5)
    dark = pl.PhotonMap.from_arrays(positions=places, normals=normals, power=np.zeros((COUNT, 3)))
    assert not dark.relax(2, 6, diffuse_flux=True).power.any()


def test_any_scale_relaxes_as_the_twins() -> None:
    places, normals = scatter_flat(COUNT, 6)
    error = max(measure_step(make_pair(places * scale, normals)) for scale in (1e-6, 1e-3, 1e3, 1e6))
    add_row("relax-scale", f"error {show(error)} radii")
    assert error < TOLERANCE


def test_scale_by_powers_of_two_gives_the_same_bits() -> None:
    places, normals = scatter_flat(COUNT, 6)
    places = places.astype(np.float32).astype(np.float64)
    expected = make_pair(places, normals).program.relax(3, 6, descriptor="pca").positions
    for factor in (2.0**-20, 2.0**20):
        moved = make_pair(places * factor, normals).program.relax(3, 6, descriptor="pca")
        np.testing.assert_array_equal(moved.positions, expected * np.float32(factor))
    add_row("relax-scale-bits", "same bits")


def test_photons_far_from_the_origin_relax_as_the_twins() -> None:
    # Floats are 1/16 apart there: a map 100 wide, on that grid, from which the drift is told more finely.
    places = np.round(scatter_flat(COUNT, 7)[0] * 1600.0) / 16.0
    places = np.unique(places, axis=0)
    error = measure_step(make_pair(places + np.array([1e6, 0.0, -1e6])))
    add_row("relax-offset", f"error {show(error)} radii")
    assert error < TOLERANCE


def test_runaway_photons_stay_finite() -> None:
    photons = make_pair(*scatter_sphere(3_000, 8)).program
    moved = photons.relax(10, 6, descriptor="none", limit=None, over_relaxation=2.0)
    check_finite_without_constraint(moved)
    farthest = float(np.linalg.norm(moved.positions.astype(np.float64), axis=1).max())
    add_row("relax-runaway", show(farthest))
    assert farthest > 1.1


def test_runaway_photons_are_still_found() -> None:
    photons = make_pair(*scatter_sphere(1_000, 8)).program
    moved = photons.relax(10, 6, descriptor="none", limit=None, over_relaxation=2.0)
    places = moved.positions.astype(np.float64)
    ids, _ = moved.neighbors(np.arange(0, 1_000, 50), 1)
    for row, i in enumerate(range(0, 1_000, 50)):
        away = np.linalg.norm(places - places[i], axis=1)
        away[i] = np.inf
        assert away[ids[row, 0]] == pytest.approx(away.min(), rel=1e-5)


def check_finite_without_constraint(photons: pl.PhotonMap) -> None:
    assert [name for name in STATE[:4] if not np.isfinite(getattr(photons, name)).all()] == []
