# SPDX-License-Identifier: Apache-2.0
"""Irradiance equals its naive twin for every kernel, and leaves other surfaces out."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
import twins
from photonloupe.settings import list_settings

KERNELS = list_settings("irradiance")["kernel"].choices
UP = np.array([0.0, 1.0, 0.0])
# Distances are 32-bit in the engine: the smallest radius here is some 1e-2 of the scene.
TOLERANCE = 2e-4


def build(positions: NDArray[np.float64], normals: NDArray[np.float64], power: NDArray[np.float64]) -> pl.PhotonMap:
    return pl.PhotonMap.from_arrays(positions=positions, normals=normals, power=power)


def make_floor(count: int, seed: int = 0) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Photons of unequal flux on a square floor of side 1."""
    rng = np.random.default_rng(seed)
    positions = rng.random((count, 3)) * (1.0, 0.0, 1.0)
    return positions, np.tile(UP, (count, 1)), rng.random((count, 3)) / count


def check_against_twin(
    columns: tuple[NDArray[np.float64], ...],
    points: NDArray[np.float64],
    facing: NDArray[np.float64],
    k: int,
    kernel: str,
) -> None:
    rounded = tuple(column.astype(np.float32).astype(np.float64) for column in columns)
    estimate = build(*columns).irradiance(points, facing, k=k, kernel=kernel)
    truth = twins.estimate_irradiance(*rounded, points.astype(np.float32), facing, k, kernel)
    np.testing.assert_allclose(estimate, truth, rtol=TOLERANCE, atol=TOLERANCE * max(float(truth.max()), 1e-30))


@pytest.mark.parametrize("k", [1, 2, 10, 50, 300])
@pytest.mark.parametrize("kernel", KERNELS)
def test_estimate_equals_its_twin(kernel: str, k: int) -> None:
    points = np.random.default_rng(1).random((100, 3)) * (1.0, 0.0, 1.0)
    check_against_twin(make_floor(3_000), points, np.tile(UP, (100, 1)), k, kernel)


@pytest.mark.parametrize("count", [2, 10, 11])
@pytest.mark.parametrize("kernel", ["epanechnikov", "cone", "gaussian"])
def test_few_photons_are_all_used(kernel: str, count: int) -> None:
    points = np.array([[0.4, 0.0, 0.3]])
    check_against_twin(make_floor(count), points, UP[None], 10, kernel)


def test_single_photon_lies_at_the_kernels_edge() -> None:
    # r is its distance times 1 + 1e-6: the kernel is 2e-6 of its peak there, some 17 float spacings.
    positions, normals, power = make_floor(1)
    point = np.array([[0.4, 0.0, 0.3]])
    estimate = build(positions, normals, power).irradiance(point, UP, k=10)
    peak = 2.0 * power / (np.pi * np.sum((positions - point) ** 2))
    np.testing.assert_allclose(estimate, 2e-6 * peak, rtol=0.1)


def test_no_photon_gives_nothing() -> None:
    empty = build(*(column[:0] for column in make_floor(1)))
    assert not empty.irradiance([[0, 0, 0.0]], [UP], k=5).any()


def test_photons_facing_away_are_left_out() -> None:
    positions, normals, power = make_floor(500)
    normals[::2] = (1.0, 0.0, 0.0)
    points = np.array([[0.5, 0.0, 0.5]])
    check_against_twin((positions, normals, power), points, UP[None], 20, "epanechnikov")


def test_map_of_another_surface_gives_nothing() -> None:
    photons = build(*make_floor(500))
    assert not photons.irradiance([[0.5, 0.0, 0.5]], [[1.0, 0.0, 0.0]], k=20).any()


def test_table_top_gathers_little_from_the_floor() -> None:
    floor, table = make_floor(2_000), make_floor(2_000, 1)
    table[0][:, 1] = 0.2
    columns = tuple(np.concatenate(pair) for pair in zip(floor, table, strict=True))
    points = np.array([[0.5, 0.2, 0.5], [0.3, 0.0, 0.6]])
    check_against_twin(columns, points, np.tile(UP, (2, 1)), 40, "epanechnikov")


def test_uneven_surface_equals_its_twin() -> None:
    positions, normals, power = make_floor(2_000)
    positions[:, 1] = 0.02 * np.random.default_rng(5).random(2_000)
    points = np.random.default_rng(6).random((50, 3)) * (1.0, 0.02, 1.0)
    check_against_twin((positions, normals, power), points, np.tile(UP, (50, 1)), 25, "epanechnikov")


@pytest.mark.parametrize("kernel", ["epanechnikov", "disc"])
def test_uniform_photons_give_the_uniform_irradiance(kernel: str) -> None:
    rng = np.random.default_rng(7)
    count, k = 40_000, 50
    photons = build(rng.random((count, 3)) * (1.0, 0.0, 1.0), np.tile(UP, (count, 1)), np.full((count, 3), 1.0 / count))
    points = (0.1 + 0.8 * rng.random((2_000, 3))) * (1.0, 0.0, 1.0)
    estimate = photons.irradiance(points, UP, k=k, kernel=kernel)[:, 0]
    # Estimates overlap: about count / k are independent, each varies by a good 1/√k; four of these deviations.
    assert abs(estimate.mean() - 1.0) < 4.0 * np.sqrt(1.2 / k) / np.sqrt(count / k)


def test_one_normal_serves_all_points() -> None:
    photons = build(*make_floor(100))
    points = np.array([[0.2, 0.0, 0.2], [0.7, 0.0, 0.1]])
    np.testing.assert_array_equal(
        photons.irradiance(points, UP, k=10), photons.irradiance(points, np.tile(UP, (2, 1)), k=10)
    )


def test_length_of_a_normal_does_not_matter() -> None:
    photons = build(*make_floor(100))
    points = np.array([[0.2, 0.0, 0.2]])
    np.testing.assert_array_equal(photons.irradiance(points, 5 * UP, k=10), photons.irradiance(points, UP, k=10))


@pytest.mark.parametrize("scale", [1e-30, 1e30])
def test_extreme_flux_scales_through(scale: float) -> None:
    positions, normals, power = make_floor(500)
    points = np.array([[0.5, 0.0, 0.5]])
    usual = build(positions, normals, power).irradiance(points, UP, k=20).astype(np.float64)
    extreme = build(positions, normals, power * scale).irradiance(points, UP, k=20)
    np.testing.assert_allclose(extreme, usual * scale, rtol=1e-5)


def test_default_k_gives_an_estimate(ring_map: pl.PhotonMap) -> None:
    assert ring_map.irradiance([[0.0, 0.0, -0.3]], UP)[0, 0] > 0.0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"k": 0}, "k must"),
        ({"kernel": "box"}, "kernel"),
        ({"normals": [[0.0, 0.0, 0.0]]}, "normals"),
        ({"normals": [[0.0, np.nan, 0.0]]}, "normals"),
        ({"points": [[np.inf, 0.0, 0.0]]}, "points"),
        ({"points": [[0.0, 0.0]]}, "points"),
        ({"normals": np.tile(UP, (2, 1))}, "normals"),
    ],
)
def test_wrong_query_is_refused_by_name(change: dict, message: str) -> None:
    query = {"points": [[0.5, 0.0, 0.5]], "normals": [UP], "k": 5, **change}
    with pytest.raises(pl.ArgumentError, match=message):
        build(*make_floor(10)).irradiance(**query)
