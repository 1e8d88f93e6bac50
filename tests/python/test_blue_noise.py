# SPDX-License-Identifier: Apache-2.0
"""Measures of blue noise equal their naive twins, and what is known of lattices, jittered grids and random points."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
import twins
from photonloupe import _engine
from point_sets import make_hexagons, make_jittered, make_random, measure_wrapped, relax_points, throw_darts
from statistics_checks import Z_LIMIT

Doubles = NDArray[np.float64]

UNIT = (1.0, 1.0)
# The spectrum adds waves in single precision; its sums are compensated.
TOLERANCE = 1e-4
PACKING = np.sqrt(2.0 / np.sqrt(3.0))  # distance in a hexagonal lattice of one point per unit area


def measure_spectrum(points: Doubles, radius: tuple[float, float]) -> tuple[NDArray[np.int32], Doubles]:
    return _engine.measure_spectrum(pl.Device()._native, np.ascontiguousarray(points), list(radius))


def list_values(noise: pl.BlueNoise) -> list[Doubles]:
    return [np.atleast_1d(np.asarray(getattr(noise, field.name), float)) for field in dataclasses.fields(noise)]


def assert_close(noise: pl.BlueNoise, other: pl.BlueNoise, tolerance: float) -> None:
    for value, truth in zip(list_values(noise), list_values(other), strict=True):
        np.testing.assert_allclose(value, truth, rtol=tolerance, atol=tolerance)


def assert_same_bits(noise: pl.BlueNoise, other: pl.BlueNoise) -> None:
    for value, truth in zip(list_values(noise), list_values(other), strict=True):
        np.testing.assert_array_equal(value, truth)


SETS = {
    "random": make_random(1_001),
    "jittered": make_jittered(30),
    "darts": throw_darts(0.03, 3_000),
    "relaxed": relax_points(300),
    "nested": 0.5 + np.repeat(0.4 ** np.arange(30), 20)[:, None] * (make_random(600) - 0.5),
    "clustered": make_random(700) ** 8,
    "on a line": make_random(500) * (1.0, 0.0),
    "coincident": np.full((400, 2), 0.3),
    "hexagons": np.divide(*make_hexagons(24, 28)),
    "more than a block": make_random(40_000),
}


@pytest.mark.parametrize("name", SETS)
def test_spectrum_equals_its_twin(name: str) -> None:
    radius = (10.0, 8.0) if name == "more than a block" else (70.0, 40.5)
    waves, power = measure_spectrum(SETS[name], radius)
    truth = twins.measure_power(SETS[name], waves)
    np.testing.assert_allclose(power, truth, rtol=TOLERANCE, atol=TOLERANCE)


def test_half_plane_holds_one_of_each_pair_within_the_ellipse() -> None:
    waves, _ = measure_spectrum(make_random(1), (17.3, 9.0))
    x, y = np.meshgrid(np.arange(-20, 21), np.arange(-20, 21))
    inside = (x / 17.3) ** 2 + (y / 9.0) ** 2 <= 1.0
    wanted = {(int(i), int(j)) for i, j in zip(x[inside], y[inside], strict=True)} - {(0, 0)}
    found = {(int(i), int(j)) for i, j in waves}
    assert len(found) == len(waves)
    assert not found & {(-i, -j) for i, j in found}
    assert found | {(-i, -j) for i, j in found} == wanted


@pytest.mark.parametrize("period", [UNIT, (3.0, 0.2)])
def test_rings_average_the_twins_power(period: tuple[float, float]) -> None:
    points = throw_darts(0.05, 1_000)
    count, side = len(points), np.sqrt(period[0] * period[1])
    noise = pl.measure_blue_noise(points * period, period=period)
    reach = int(3.0 * np.sqrt(count) * np.sqrt(period[0] / period[1]) + 5)
    x, y = np.meshgrid(np.arange(-reach, reach + 1), np.arange(0, reach + 1))
    half = (y > 0) | (x > 0)
    waves = np.stack([x[half], y[half]], axis=1)
    cycles = np.linalg.norm(waves / period, axis=1) * side
    waves, cycles = waves[cycles < len(noise.power) + 0.5], cycles[cycles < len(noise.power) + 0.5]
    power = twins.measure_power(points, waves)
    np.testing.assert_allclose(noise.frequency, np.arange(1, len(noise.power) + 1) / np.sqrt(count))
    for ring in range(1, len(noise.power) + 1):
        members = power[np.abs(cycles - ring) <= 0.5]
        assert noise.power[ring - 1] == pytest.approx(members.mean(), rel=TOLERANCE)
        assert noise.anisotropy[ring - 1] == pytest.approx(members.var(ddof=1) / members.mean() ** 2, rel=TOLERANCE)
    low = power[cycles < 0.25 * np.sqrt(count)].mean()
    assert noise.low_frequency_power == pytest.approx(low, rel=TOLERANCE)


def test_random_points_have_power_and_variance_one() -> None:
    count = 16_384
    noise = pl.measure_blue_noise(make_random(count, 3), period=UNIT, frequencies=1.0)
    members = np.pi * noise.frequency * np.sqrt(count)  # of a ring; their power is exponential, so deviates by 1
    assert abs(np.average(noise.power, weights=members) - 1.0) < Z_LIMIT / np.sqrt(members.sum())
    assert (np.abs(noise.power - 1.0) < (Z_LIMIT + 1.0) / np.sqrt(members)).all()
    low = 0.25 * np.sqrt(count)
    assert noise.low_frequency_power is not None
    assert abs(noise.low_frequency_power - 1.0) < Z_LIMIT / np.sqrt(np.pi / 2.0 * low**2)
    assert abs(noise.anisotropy[10:].mean() - 1.0) < 0.05
    np.testing.assert_array_equal(noise.window_count, [1, 4, 16, 64])
    # Variance of a Poisson count's variance: (2 + 1/mean)/windows.
    deviation = np.sqrt((2.0 + 1.0 / noise.window_count) * noise.window_count / count)
    assert (np.abs(noise.count_variance - 1.0) < Z_LIMIT * deviation).all()
    assert noise.relative_radius < 0.05


def test_random_points_without_period_have_power_one() -> None:
    count = 4_096
    noise = pl.measure_blue_noise(make_random(count, 4) * (5.0, 1.0), frequencies=1.0)
    members = np.pi * noise.frequency * np.sqrt(count)
    assert abs(np.average(noise.power, weights=members) - 1.0) < Z_LIMIT / np.sqrt(members.sum())
    deviation = np.sqrt((2.0 + 1.0 / noise.window_count) * noise.window_count / count)
    assert (np.abs(noise.count_variance - 1.0) < Z_LIMIT * deviation).all()


def test_hexagonal_lattice_peaks_where_it_should() -> None:
    points, period = make_hexagons(64, 74)
    noise = pl.measure_blue_noise(points, period=period, frequencies=1.5)
    peak = int(np.argmax(noise.power))
    assert noise.frequency[peak] == pytest.approx(PACKING, abs=0.5 / np.sqrt(len(points)))
    assert (noise.power[: peak - 1] < TOLERANCE).all()
    assert noise.anisotropy[peak] > 50.0
    assert noise.low_frequency_power == pytest.approx(0.0, abs=TOLERANCE)
    assert noise.relative_radius == pytest.approx(1.0, rel=1e-9)
    assert (noise.count_variance < 0.15).all()


def test_jittered_grid_has_the_power_of_its_closed_form() -> None:
    # Points uniform in the cells of a grid of `side`²: E P(k) = 1 − sinc²(k_x/side) sinc²(k_y/side).
    side = 64
    waves, power = measure_spectrum(make_jittered(side), (100.0, 100.0))
    expected = 1.0 - np.prod(np.square(np.sinc(waves / side)), axis=1)
    assert abs((power / expected).mean() - 1.0) < Z_LIMIT / np.sqrt(len(power))


def test_relaxed_points_are_blue() -> None:
    noise = pl.measure_blue_noise(relax_points(1_024), period=UNIT)
    assert noise.low_frequency_power is not None
    assert noise.low_frequency_power < 0.04  # METHODS section 3
    assert (np.diff(noise.count_variance) < 0.0).all()
    assert (noise.count_variance < [0.5, 0.3, 0.2, 0.15]).all()


def test_relaxed_points_keep_their_distance_with_short_reach() -> None:
    # Over-relaxed points pair up; with τ = 1 they do not (METHODS section 3).
    assert pl.measure_blue_noise(relax_points(1_024, reach=(1.0, 1.0)), period=UNIT).relative_radius > 0.5
    assert pl.measure_blue_noise(relax_points(1_024), period=UNIT).relative_radius < 0.4


@pytest.mark.parametrize("period", [UNIT, (2.0, 0.05), None])
@pytest.mark.parametrize("name", ["random", "darts", "clustered", "nested", "hexagons"])
def test_relative_radius_equals_brute_force(name: str, period: tuple[float, float] | None) -> None:
    sides = np.array(period or UNIT)
    points = SETS[name] * sides
    away = np.abs(points[:, None] - points)
    area = sides.prod() if period else np.ptp(points, axis=0).prod()
    distance = np.linalg.norm(np.minimum(away, sides - away) if period else away, axis=2)
    least = distance[~np.eye(len(points), dtype=bool)].min()
    noise = pl.measure_blue_noise(points, period=period, frequencies=0.25)
    assert noise.relative_radius == pytest.approx(least / (PACKING * np.sqrt(area / len(points))), rel=1e-9, abs=1e-14)


def test_closest_pair_is_found_across_the_seam() -> None:
    points = throw_darts(0.1, 300)
    points = np.vstack([points[measure_wrapped(points, np.zeros(2)) > 0.1], [[0.999, 0.999], [0.001, 0.001]]])
    noise = pl.measure_blue_noise(points, period=UNIT)
    assert noise.relative_radius == pytest.approx(0.002 * np.sqrt(2.0) / (PACKING / np.sqrt(len(points))), rel=1e-9)


@pytest.mark.parametrize("period", [UNIT, None])
def test_offset_and_whole_periods_change_nothing(period: tuple[float, float] | None) -> None:
    points = throw_darts(0.05, 1_000)
    moved = points + 1e6
    if period is not None:
        moved[::3] += (5.0, -7.0)
    noise = pl.measure_blue_noise(points, period=period, frequencies=1.0)
    other = pl.measure_blue_noise(moved, period=period, frequencies=1.0)
    np.testing.assert_allclose(other.power, noise.power, rtol=1e-3, atol=1e-6)
    assert other.relative_radius == pytest.approx(noise.relative_radius, rel=1e-6)


@pytest.mark.parametrize("scale", [2.0**-900, 2.0**-30, 2.0**30, 2.0**900])
def test_scale_changes_no_bit(scale: float) -> None:
    points = throw_darts(0.08, 500)
    noise = pl.measure_blue_noise(points, period=UNIT)
    assert_same_bits(pl.measure_blue_noise(points * scale, period=(scale, scale)), noise)


def test_same_points_give_the_same_bits() -> None:
    points = make_random(20_000, 6)
    first = pl.measure_blue_noise(points, period=UNIT, frequencies=0.5)
    assert_same_bits(pl.measure_blue_noise(points, period=UNIT, frequencies=0.5, device=pl.Device()), first)


def test_order_of_the_points_matters_no_more_than_rounding() -> None:
    points = throw_darts(0.05, 1_000)
    assert_close(
        pl.measure_blue_noise(points[::-1], period=UNIT), pl.measure_blue_noise(points, period=UNIT), TOLERANCE
    )
