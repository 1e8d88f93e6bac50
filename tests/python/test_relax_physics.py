# SPDX-License-Identifier: Apache-2.0
"""What relaxation is for: noise falls as the methods say, lattices stay put, flux and columns stay to the bit."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from point_sets import make_hexagons, make_random
from relax_maps import read_column
from twin_pairs import UP, make_layers, make_pair, scatter_flat

Doubles = NDArray[np.float64]

COUNT, SEED = 4_096, 1
STEPS = 20
REPULSION = (2.0, 1.2)  # λmax, λmin of [SJ09]
LIMIT = 0.3
PERIOD = (1.0, 0.0, 1.0)
# Points at which noise is measured, along a side of the unit square, and the photons that each estimate takes.
GRID, NOISE_NEIGHBORS = 64, 20
# Of the neighboring squares, what the estimates' discs reach.
MARGIN = 0.2


def lift(flat: Doubles) -> Doubles:
    return np.stack([flat[:, 0], np.zeros(len(flat)), flat[:, 1]], axis=1)


def relax_periodic(flat: Doubles, period: tuple[float, float, float] = PERIOD, **keywords: object) -> pl.PhotonMap:
    """Relax points of a rectangle that repeats on both sides, free and with the repulsion of [SJ09]."""
    settings = {"steps": STEPS, "neighbors": 6, "descriptor": "none", "over_relaxation": REPULSION, **keywords}
    relaxation = pl.Relaxation(make_pair(lift(flat)).program, period=period, **settings)  # type: ignore[arg-type]
    for _ in range(relaxation.steps):
        relaxation.step()
    return relaxation.photons


@cache
def get_relaxed(limit: float | None, search: str = "exact") -> Doubles:
    """Points of the unit square after all steps, (n, 2)."""
    photons = relax_periodic(make_random(COUNT, SEED), limit=limit, search=search)
    return np.mod(photons.positions[:, [0, 2]].astype(np.float64), 1.0)


def estimate_density(flat: Doubles) -> Doubles:
    """The Epanechnikov estimate of the points' density, 1 on average, at the points of a grid, (GRID²,)."""
    shifts = np.stack(np.meshgrid((-1, 0, 1), (-1, 0, 1)), axis=-1).reshape(-1, 1, 2)
    tiles = (flat + shifts).reshape(-1, 2)
    photons = make_pair(lift(tiles[np.all(np.abs(tiles - 0.5) < 0.5 + MARGIN, axis=1)])).program
    steps = (np.arange(GRID) + 0.5) / GRID
    points = lift(np.stack(np.meshgrid(steps, steps), axis=-1).reshape(-1, 2))
    return photons.irradiance(points, UP, k=NOISE_NEIGHBORS)[:, 0].astype(np.float64) / len(flat)


def measure_noise(flat: Doubles) -> float:
    density = estimate_density(flat)
    return float(density.std() / density.mean())


def measure_low_power(flat: Doubles) -> float:
    power = pl.measure_blue_noise(flat, period=(1.0, 1.0), frequencies=0.3).low_frequency_power
    assert power is not None
    return power


# Noise (METHODS section 3, "Checked")


def test_random_photons_have_the_noise_of_20_neighbors() -> None:
    assert measure_noise(make_random(COUNT, SEED)) == pytest.approx(0.263, abs=0.02)


@pytest.mark.parametrize(("limit", "most"), [(None, 0.065), (LIMIT, 0.10)])
def test_noise_falls_as_far_as_the_methods_say(limit: float | None, most: float) -> None:
    assert measure_noise(get_relaxed(limit)) <= most


def test_low_frequencies_lose_their_power() -> None:
    assert measure_low_power(make_random(COUNT, SEED)) == pytest.approx(0.90, abs=0.2)
    assert measure_low_power(get_relaxed(None)) <= 0.04


def test_photons_without_over_relaxation_keep_their_distance() -> None:
    flat = np.mod(relax_periodic(make_random(COUNT, SEED), over_relaxation=1.0).positions[:, [0, 2]].astype(float), 1.0)
    assert pl.measure_blue_noise(flat, period=(1.0, 1.0), frequencies=0.1).relative_radius > 0.5


def test_estimates_of_relaxed_photons_are_biased_as_the_methods_say() -> None:
    # METHODS section 2: -0.6 to -0.9 %; the mean over the grid has a standard error of 0.1 %.
    assert -0.0105 < estimate_density(get_relaxed(None)).mean() - 1.0 < -0.0045


def test_every_step_flattens_further() -> None:
    start = make_random(COUNT, SEED)
    noise = [measure_noise(np.mod(relax_periodic(start, steps=n).positions[:, [0, 2]], 1.0)) for n in (1, 5, 20)]
    assert noise == sorted(noise, reverse=True)


# Carried search


@pytest.mark.parametrize("limit", [None, LIMIT])
def test_carried_radii_leave_little_more_noise_than_exact_ones(limit: float | None) -> None:
    assert measure_noise(get_relaxed(limit, "carried")) <= 1.1 * measure_noise(get_relaxed(limit))


def test_carried_radii_leave_little_more_power_in_low_frequencies() -> None:
    assert measure_low_power(get_relaxed(None, "carried")) <= 1.2 * measure_low_power(get_relaxed(None))


def test_carried_radii_keep_the_mean_of_the_estimate() -> None:
    carried, exact = (estimate_density(get_relaxed(None, search)).mean() for search in ("carried", "exact"))
    assert carried == pytest.approx(exact, abs=0.003)


def test_first_carried_step_is_exact() -> None:
    photons = make_layers("flat", 600).program
    carried, exact = (photons.relax(1, descriptor="none", search=search) for search in ("carried", "exact"))
    assert carried.positions.tobytes() == exact.positions.tobytes()


# What stays where it is


@pytest.mark.parametrize("neighbors", [6, 18])
def test_hexagonal_lattice_stays_put(neighbors: int) -> None:
    # Both numbers of neighbors end with a whole ring of the lattice, whose spacing is 1.
    flat, (width, depth) = make_hexagons(16, 16)
    moved = relax_periodic(flat, (width, 0.0, depth), steps=5, neighbors=neighbors, limit=None)
    assert np.linalg.norm(moved.drift, axis=1).max() < 1e-5


def test_two_photons_repel_symmetrically() -> None:
    moved = make_pair([[0.0, 0.0, 0.0], [0.3, 0.0, 0.4]]).program.relax(
        1, descriptor="none", limit=None, over_relaxation=1.0
    )
    # K = 1 and r = 2d: the force is (2 − 1/2) of the offset.
    np.testing.assert_allclose(moved.drift, [[-0.45, 0.0, -0.6], [0.45, 0.0, 0.6]], rtol=1e-6)


def test_one_photon_stays() -> None:
    assert not make_pair([[0.3, 0.0, 0.4]]).program.relax(STEPS, descriptor="none", limit=None).drift.any()


@pytest.mark.parametrize("descriptor", ["gradient", "pca", "tensor", "split"])
def test_photons_with_fewer_than_twelve_neighbors_do_not_move(descriptor: str) -> None:
    photons = make_pair(*scatter_flat(13, 2)).program
    moved = photons.relax(5, 6, descriptor=descriptor, constraint_neighbors=50)
    assert moved.positions.tobytes() == photons.positions.tobytes()


def test_pressure_of_a_frozen_photon_tells_that_it_would_move() -> None:
    assert (make_pair(*scatter_flat(13, 2)).program.relax(1, 6, descriptor="pca").pressure > 0.0).all()


def test_held_photons_drift_along_their_structure_only() -> None:
    moved = make_pair(*scatter_flat(600, 3)).program.relax(3, 6, descriptor="gradient", limit=None)
    fixed = moved.constraint_weights[:, 1] == 1.0
    across = np.einsum("ni,ni->n", moved.drift, moved.constraint_basis[:, 1])[fixed]
    along = np.einsum("ni,ni->n", moved.drift, moved.constraint_basis[:, 0])[fixed]
    assert np.abs(across).max() < 1e-5 * np.abs(along).max()


# What stays to the bit


@pytest.fixture(scope="module")
def power() -> NDArray[np.float32]:
    return np.random.default_rng(4).random((600, 3)).astype(np.float32)


@pytest.fixture(scope="module")
def source(power: NDArray[np.float32]) -> pl.PhotonMap:
    places, normals = scatter_flat(600, 4)
    return pl.PhotonMap.from_arrays(
        positions=places,
        normals=normals,
        power=power,
        emitter=np.arange(600) % 3,
        emitted_index=7 * np.arange(600)[::-1],
        object=np.arange(600) % 4 - 1,
    )


@pytest.fixture(scope="module", params=["exact", "carried"])
def moved(source: pl.PhotonMap, request: pytest.FixtureRequest) -> pl.PhotonMap:
    return source.relax(STEPS, 6, descriptor="none", search=request.param)


@pytest.mark.parametrize("name", ["power", "emitter", "emitted_index", "object", "normals"])
def test_column_stays_to_the_bit(source: pl.PhotonMap, moved: pl.PhotonMap, name: str) -> None:
    assert read_column(moved, name) == read_column(source, name)


def test_sum_of_the_flux_stays_to_the_bit(source: pl.PhotonMap, moved: pl.PhotonMap) -> None:
    assert moved.total_flux.tobytes() == source.total_flux.tobytes()


def test_number_of_photons_stays(source: pl.PhotonMap, moved: pl.PhotonMap) -> None:
    assert len(moved) == len(source)
