# SPDX-License-Identifier: Apache-2.0
"""Positions: photons counted in cells follow the closed forms, random ones to the letter of statistics."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene
from oracles import Slab, cardioid
from physics import BOWL, RING, SLAB, BinCase, build_cylinder_bins, build_slab_bins
from statistics_checks import MIN_EXPECTED, compute_chi_square_p

EMITTED = 1 << 20
CELLS = 64
P_LIMITS = (0.001, 0.999)
# Block noise of random emission is white, that of Sobol emission at most half as strong.
WHITE_TOLERANCE = 0.05
SOBOL_LIMIT = 0.5


@pytest.fixture(scope="module", params=["ring", "slab", "bowl"])
def bins(request: pytest.FixtureRequest) -> BinCase:
    if request.param == "slab":
        return build_slab_bins(CELLS)
    scene, half = (RING, RING.window_half) if request.param == "ring" else (BOWL, 1.0)
    return build_cylinder_bins(scene, half, CELLS)


@lru_cache(maxsize=3)
def trace_scene(name: str, emission: str, seed: int) -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene(name)), emitted=EMITTED, emission=emission, seed=seed)


def trace(bins: BinCase, emission: str, seed: int = 1) -> pl.PhotonMap:
    return trace_scene(bins.name, emission, seed)


def compute_cell_z(bins: BinCase, photons: pl.PhotonMap) -> np.ndarray:
    """Z of every cell that expects enough photons, as if they fell at random."""
    counts, expected = bins.count_photons(photons), bins.count_expected(photons)
    # Emission is aimed, so that a cell's share of all emitted photons can be large: binomial, not Poisson.
    share = expected / photons.emitted
    z = (counts - expected) / np.sqrt(np.maximum(expected * (1.0 - share), 1e-12))
    return z[(expected >= MIN_EXPECTED) & ~bins.excluded]


def test_photons_carry_equal_flux(bins: BinCase) -> None:
    power = trace(bins, "random").power[:, 0]
    np.testing.assert_allclose(power, power[0], rtol=1e-4)


def test_random_photons_pass_chi_square(bins: BinCase) -> None:
    photons = trace(bins, "random")
    p = compute_chi_square_p(bins.count_photons(photons), bins.count_expected(photons))
    assert P_LIMITS[0] <= p <= P_LIMITS[1]


def test_random_noise_is_white(bins: BinCase) -> None:
    z = compute_cell_z(bins, trace(bins, "random", seed=2))
    assert np.sqrt(np.mean(z**2)) == pytest.approx(1.0, abs=WHITE_TOLERANCE)


def test_sobol_noise_is_at_most_half(bins: BinCase) -> None:
    z = compute_cell_z(bins, trace(bins, "sobol"))
    assert np.sqrt(np.mean(z**2)) <= SOBOL_LIMIT


def test_binned_irradiance_is_the_oracles(bins: BinCase) -> None:
    photons = trace(bins, "sobol")
    counts, expected = bins.count_photons(photons), bins.count_expected(photons)
    used = (expected >= MIN_EXPECTED) & ~bins.excluded
    # Half the noise of random photons in a cell of `expected` of them is the most that Sobol emission may leave.
    allowed = SOBOL_LIMIT / np.sqrt(expected[used].mean())
    error = np.abs(counts[used] - expected[used]).sum() / expected[used].sum()
    assert error < allowed


def test_bowl_is_brightest_on_the_cardioid() -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("bowl")), emitted=EMITTED)
    edges = np.linspace(-1.0, 1.0, 129)
    counts = np.histogram2d(photons.positions[:, 0], photons.positions[:, 2], bins=(edges, edges))[0]
    middle = 0.5 * (edges[1:] + edges[:-1])
    ix, iz = np.unravel_index(np.argsort(counts, axis=None)[-50:], counts.shape)
    bright = np.stack([middle[ix], middle[iz]], axis=1)
    # The lamp hangs at +x, so the cusp points to -x.
    curve = cardioid(np.linspace(0.0, 2.0 * np.pi, 20_001), BOWL.radius) * (-1.0, 1.0)
    distance = [np.min(np.hypot(*(curve - point).T)) for point in bright]
    assert max(distance) < 2.0 * (edges[1] - edges[0])


def test_slab_light_is_refracted_twice() -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("slab")), emitted=1 << 16)
    share = len(photons.select(signature="22")) / len(photons)
    # One more pair of inner reflections brings 0.16 %.
    assert share == pytest.approx(0.9984, abs=1e-3)


def test_slab_irradiance_estimate_is_the_oracles() -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("slab")), emitted=EMITTED).select(signature="22")
    x = np.linspace(0.0, 1.0, 11)
    points = np.stack([x, np.zeros(11), np.zeros(11)], axis=1)
    estimate = photons.irradiance(points, (0.0, 1.0, 0.0), k=1000)[:, 0]
    truth = Slab(SLAB.thickness, SLAB.ior, SLAB.light_height, SLAB.intensity).irradiance(x)
    # A thousand Sobol photons vary by less than a thousand random ones, 1.15/√1000 = 3.6 %.
    np.testing.assert_allclose(estimate, truth, rtol=0.036)
