# SPDX-License-Identifier: Apache-2.0
"""Blue noise of few, many, coincident and impossible points."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import photonloupe as pl
import twins
from photonloupe import _engine
from point_sets import make_random

UNIT = (1.0, 1.0)
TOLERANCE = 1e-4
PACKING = np.sqrt(2.0 / np.sqrt(3.0))


def test_single_point_repeats_with_its_period() -> None:
    noise = pl.measure_blue_noise([[0.7, 0.2]], period=UNIT)
    np.testing.assert_allclose(noise.power, 1.0, rtol=TOLERANCE)
    assert noise.relative_radius == pytest.approx(1.0 / PACKING)
    assert noise.low_frequency_power is None
    assert len(noise.count_variance) == len(noise.window_count) == 0


def test_two_points_interfere() -> None:
    noise = pl.measure_blue_noise([[0.0, 0.0], [0.5, 0.5]], period=UNIT, frequencies=1.0)
    # The ring of one cycle holds (1, 0) and (0, 1), which cancel, and (1, ±1), which add up.
    assert noise.power[0] == pytest.approx(1.0)
    assert noise.relative_radius == pytest.approx(np.sqrt(0.5) / (PACKING / np.sqrt(2.0)))


def test_two_points_span_their_rectangle() -> None:
    noise = pl.measure_blue_noise([[0.0, 0.0], [3.0, 4.0]])
    assert noise.relative_radius == pytest.approx(5.0 / (PACKING * np.sqrt(12.0 / 2.0)))
    assert all(np.isfinite(values).all() for values in (noise.power, noise.anisotropy))


def test_coincident_points_add_up() -> None:
    noise = pl.measure_blue_noise(np.full((1_000, 2), 0.3), period=UNIT, frequencies=1.0)
    np.testing.assert_allclose(noise.power, 1_000.0, rtol=TOLERANCE)
    assert noise.low_frequency_power == pytest.approx(1_000.0, rel=TOLERANCE)
    assert noise.relative_radius == 0.0
    assert (noise.anisotropy < TOLERANCE).all()
    assert (noise.count_variance > 100.0).all()


def test_million_points_keep_four_digits() -> None:
    points = make_random(1_000_000, 7)
    waves, power = _engine.measure_spectrum(pl.Device()._native, points, [1000.0, 0.0])
    np.testing.assert_allclose(power[-4:], twins.measure_power(points, waves[-4:]), rtol=TOLERANCE, atol=TOLERANCE)


def test_highest_frequencies_keep_four_digits() -> None:
    points = make_random(20_000, 9)
    waves, power = _engine.measure_spectrum(pl.Device()._native, points, [4096.0, 0.0])
    np.testing.assert_allclose(power[-300:], twins.measure_power(points, waves[-300:]), rtol=TOLERANCE, atol=TOLERANCE)


def test_higher_frequencies_are_refused() -> None:
    with pytest.raises(pl.PhotonLoupeError, match="it must be from 0 to 4096"):
        _engine.measure_spectrum(pl.Device()._native, make_random(2), [4097.0, 1.0])


def test_long_domain_is_measured_as_far_as_is_offered() -> None:
    noise = pl.measure_blue_noise(make_random(10_000, 10) * (400.0, 1.0), period=(400.0, 1.0))
    assert 1.5 < noise.frequency[-1] < 4_096.0 / np.sqrt(400.0 * 10_000)
    assert noise.power.mean() == pytest.approx(1.0, abs=0.05)


def test_million_points_are_measured() -> None:
    noise = pl.measure_blue_noise(make_random(1_000_000, 8), period=UNIT, frequencies=0.01)
    assert len(noise.power) == 10
    assert abs(noise.power.mean() - 1.0) < 0.3
    np.testing.assert_allclose(noise.count_variance, 1.0, atol=0.05)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"points": np.empty((0, 2))}, "points has no rows"),
        ({"points": [[0.5, 0.5]], "period": None}, "span no area"),
        ({"points": [[0.5, 0.5], [0.9, 0.5]], "period": None}, "span no area.*period="),
        ({"points": np.full((9, 2), 0.5), "period": None}, "span no area"),
        ({"points": [[0.1, 0.2], [0.3, np.nan]]}, r"points\[1\]\[1\] is NaN"),
        ({"points": [[np.inf, 0.2]]}, r"points\[0\]\[0\] is infinite"),
        ({"points": [[-1e308, 0.0], [1e308, 1.0]], "period": None}, "scale them down"),
        ({"points": [[0.0, 0.0, 0.0]]}, r"points must have shape \(n, 2\)"),
        ({"points": ["a"]}, "points must be numbers"),
        ({"period": (1.0, 0.0)}, "period must be two finite sides above 0"),
        ({"period": (1.0, np.nan)}, "period must be two finite sides above 0"),
        ({"period": 1.0}, "period must be two"),
        ({"period": ("a", "b")}, "period must be two numbers"),
        ({"period": (1e9, 1e-9)}, "too long for its width"),
        ({"period": (5e-324, 1e308)}, "too long for its width"),
        ({"period": (1e308, 5e-324)}, "too long for its width"),
        ({"frequencies": 0.0}, "frequencies must be from"),
        ({"frequencies": np.nan}, "frequencies must be from"),
        ({"frequencies": 900.0}, "up to .* would fit"),
        ({"frequencies": "all"}, "frequencies must be a number"),
        ({"device": 1.5}, "device must be"),
    ],
)
def test_wrong_argument_is_refused_by_name(change: dict[str, Any], message: str) -> None:
    arguments = {"points": make_random(30), "period": UNIT, **change}
    with pytest.raises(pl.ArgumentError, match=message):
        pl.measure_blue_noise(**arguments)


def test_progress_tells_and_stops() -> None:
    heard: list[tuple[str, float]] = []
    points = make_random(40_000)
    pl.measure_blue_noise(points, frequencies=0.1, progress=lambda stage, fraction: heard.append((stage, fraction)))
    fractions = [fraction for stage, fraction in heard if stage == "measure spectrum"]
    assert fractions == sorted(fractions)
    assert fractions[0] == 0.0
    assert fractions[-1] == 1.0
    with pytest.raises(pl.Cancelled):
        pl.measure_blue_noise(points, progress=lambda stage, fraction: False)
