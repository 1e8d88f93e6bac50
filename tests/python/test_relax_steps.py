# SPDX-License-Identifier: Apache-2.0
"""Steps of relaxation move photons as the naive twin does: on planes and spheres, in layers, few, in periodic space."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from constraint_twins import constrain
from relax_twins import Settings, Step, diffuse_flux, relax, relax_step, wrap
from twin_pairs import SHAPES, Pair, make_layers, make_pair, scatter_flat

Doubles = NDArray[np.float64]

COUNT, STEPS, BETA = 500, 3, 2.0
REPULSION, LIMIT = (2.0, 1.2), 0.3  # λmax, λmin and ρ of [SJ09]
UNIT_PERIOD = (1.0, 0.0, 1.0)
# Errors as a share of the radius. One step is a sum of some float terms about as long as the radius; each further one
# starts where the last ended, and carries its error along with a gain of some 5.
ONE_STEP, THREE_STEPS = 1e-5, 2.5e-4
NEIGHBORS = (1, 6, 20, 50)
SPACES = ("world", "parameter")

Run = tuple[pl.PhotonMap, Step]


@cache
def run_step(shape: str, neighbors: int, repel: str) -> Run:
    """One free step of the program and of the twin."""
    pair = make_layers(shape, COUNT)
    limit = None if neighbors == 1 else LIMIT  # one neighbor pushes so hard that the limiter would leave nothing
    keywords = {"descriptor": "none", "repel": repel, "beta": BETA, "limit": limit, "over_relaxation": REPULSION}
    moved = pair.program.relax(1, neighbors, search="exact", **keywords)  # type: ignore[arg-type]
    settings = Settings(steps=1, neighbors=neighbors, repel=repel, beta=BETA, limit=limit)
    return moved, relax_step(pair.twin, settings, 0)


def share_of_radius(error: Doubles, radii: Doubles) -> float:
    """Largest error (n, 3) as a share of the photons' radii; photons without a radius must not err."""
    size = np.linalg.norm(error, axis=1)
    alone = radii == 0.0
    assert not size[alone].any()
    return float((size[~alone] / radii[~alone]).max(initial=0.0))


# One step


@pytest.mark.parametrize("neighbors", NEIGHBORS)
@pytest.mark.parametrize("repel", SPACES)
@pytest.mark.parametrize("shape", SHAPES)
def test_one_step_moves_photons_as_the_twin(shape: str, repel: str, neighbors: int) -> None:
    moved, twin = run_step(shape, neighbors, repel)
    assert np.abs(twin.moves).max() > 0.01
    assert share_of_radius(moved.drift - twin.moves, twin.radii) < ONE_STEP


@pytest.mark.parametrize("neighbors", NEIGHBORS)
@pytest.mark.parametrize("repel", SPACES)
@pytest.mark.parametrize("shape", SHAPES)
def test_pressure_is_the_twins(shape: str, repel: str, neighbors: int) -> None:
    moved, twin = run_step(shape, neighbors, repel)
    np.testing.assert_allclose(moved.pressure, twin.pressure, rtol=1e-5, atol=1e-5)


@pytest.mark.parametrize("repel", SPACES)
def test_row_of_the_report_sums_up_the_twins_moves(repel: str) -> None:
    moved, twin = run_step("flat", 6, repel)
    row = moved.relaxation["steps"][0]
    size, apart = np.linalg.norm(twin.moves, axis=1), twin.radii > 0.0
    shares = size[apart] / twin.radii[apart]
    expected = (shares.sum() / COUNT, shares.max(), twin.pressure.mean(), size.mean())
    found = tuple(row[name] for name in ("mean_move", "largest_move", "mean_pressure", "mean_displacement"))
    np.testing.assert_allclose(found, expected, rtol=1e-5)


def test_limiter_acts_as_the_twins() -> None:
    pair = make_layers("flat", COUNT)
    for limit in (0.05, None):
        moved = pair.program.relax(1, 6, descriptor="none", limit=limit, over_relaxation=1.5)
        twin = relax_step(pair.twin, Settings(steps=1, limit=limit, over_relaxation=(1.5, 1.5)), 0)
        assert share_of_radius(moved.drift - twin.moves, twin.radii) < ONE_STEP


# Three steps


@pytest.mark.parametrize("repel", SPACES)
@pytest.mark.parametrize("shape", SHAPES)
def test_three_steps_move_photons_as_the_twin(shape: str, repel: str) -> None:
    pair = make_layers(shape, COUNT)
    moved = pair.program.relax(STEPS, 6, descriptor="none", repel=repel, beta=BETA, over_relaxation=REPULSION)
    settings = Settings(steps=STEPS, repel=repel, beta=BETA)
    _, drift = relax(pair.twin, settings)
    assert share_of_radius(moved.drift - drift, relax_step(pair.twin, settings, 0).radii) < THREE_STEPS


@pytest.mark.parametrize("space", SPACES)
@pytest.mark.parametrize("shape", ["flat", "sphere"])
def test_three_held_steps_move_photons_as_the_twin(shape: str, space: str) -> None:
    pair = make_layers(shape, COUNT)
    held = constrain(pair.twin, "pca", space=space, beta=BETA).constraint
    assert np.ptp(held.weights[:, 1]) > 0.4
    keywords = {"descriptor": "pca", "constraint": space, "beta": BETA, "over_relaxation": REPULSION}
    moved = pair.program.relax(STEPS, 6, **keywords)  # type: ignore[arg-type]
    settings = Settings(steps=STEPS)
    _, drift = relax(pair.twin, settings, held)
    assert share_of_radius(moved.drift - drift, relax_step(pair.twin, settings, 0).radii) < THREE_STEPS


def test_step_by_step_the_fade_of_over_relaxation_is_the_twins() -> None:
    pair = make_layers("flat", COUNT)
    relaxation = pl.Relaxation(pair.program, steps=4, neighbors=6, descriptor="none", over_relaxation=REPULSION)
    twin = pair.twin
    for number in range(4):
        twin_step = relax_step(twin, Settings(steps=4), number)
        twin = twin_step.photons
        row = relaxation.step()
        assert row["mean_displacement"] == pytest.approx(np.linalg.norm(twin_step.moves, axis=1).mean(), rel=1e-4)


def test_unset_photons_repel_only_each_other_in_layers() -> None:
    pair = make_layers("flat", COUNT)
    moved, _ = run_step("flat", 6, "parameter")
    for emitter in (0, 1):
        unset = ~pair.twin.is_set & (pair.twin.emitter == emitter)
        alone = make_pair(pair.twin.positions[unset])
        twin = relax_step(alone.twin, Settings(steps=1), 0)
        assert share_of_radius(moved.drift[unset] - twin.moves, twin.radii) < ONE_STEP


# Flux diffusion


@pytest.mark.parametrize("repel", SPACES)
def test_flux_diffuses_as_the_twins(repel: str) -> None:
    pair = make_layers("flat", COUNT)
    power = np.random.default_rng(3).random((COUNT, 3)).astype(np.float32)
    photons = pl.PhotonMap.from_arrays(
        positions=pair.program.positions, normals=pair.program.normals, power=power, emitter=pair.program.emitter
    )
    photons.set_parameters(pair.program.parameters, None, pair.program.parameter_bounds, [False, True])
    keywords = {"descriptor": "none", "repel": repel, "beta": BETA, "over_relaxation": REPULSION}
    moved = photons.relax(1, 6, diffuse_flux=True, **keywords)  # type: ignore[arg-type]
    expected = diffuse_flux(pair.twin, power.astype(np.float64), 6, space=repel, beta=BETA)
    np.testing.assert_allclose(moved.power, expected, rtol=1e-5)


# Few photons


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7, 8, 9])
def test_few_photons_move_as_the_twin(count: int) -> None:
    pair = make_pair(*scatter_flat(count, 5))
    moved = pair.program.relax(1, 6, descriptor="none", limit=None, over_relaxation=REPULSION)
    twin = relax_step(pair.twin, Settings(steps=1, limit=None), 0)
    assert (np.abs(twin.moves).max() > 0.0) == (count > 1)
    assert share_of_radius(moved.drift - twin.moves, twin.radii) < ONE_STEP


def test_no_photons_relax_to_none() -> None:
    moved = make_pair(np.empty((0, 3))).program.relax(STEPS, 6, descriptor="none")
    assert (moved.positions.shape, moved.drift.shape, moved.pressure.shape) == ((0, 3), (0, 3), (0,))


def test_photons_fewer_than_their_neighbors_move_as_the_twin() -> None:
    pair = make_pair(*scatter_flat(40, 6))
    moved = pair.program.relax(1, 50, descriptor="none", limit=None, over_relaxation=1.0)
    twin = relax_step(pair.twin, Settings(steps=1, neighbors=50, limit=None, over_relaxation=(1.0, 1.0)), 0)
    assert share_of_radius(moved.drift - twin.moves, twin.radii) < ONE_STEP


# Periodic space


def make_periodic(count: int) -> Pair:
    """Random photons of the unit square that repeats on both sides."""
    flat = np.random.default_rng(7).random((count, 2))
    return make_pair(np.stack([flat[:, 0], np.zeros(count), flat[:, 1]], axis=1), period=UNIT_PERIOD)


# Leaves of the tree hold a whole number of tiles of eight photons, or do not.
@pytest.mark.parametrize("count", [512, 500])
def test_photons_of_periodic_space_move_as_the_twin(count: int) -> None:
    pair = make_periodic(count)
    relaxation = pl.Relaxation(
        pair.program, steps=STEPS, neighbors=6, descriptor="none", over_relaxation=REPULSION, period=UNIT_PERIOD
    )
    for _ in range(STEPS):
        relaxation.step()
    twin, _ = relax(pair.twin, Settings(steps=STEPS))
    error = wrap(relaxation.photons.positions - twin.positions, np.array(UNIT_PERIOD))
    assert share_of_radius(error, relax_step(pair.twin, Settings(steps=STEPS), 0).radii) < THREE_STEPS


@pytest.mark.parametrize("count", [512, 500])
def test_constraint_of_periodic_space_is_the_twins(count: int) -> None:
    pair = make_periodic(count)
    found = pl.Relaxation(pair.program, descriptor="pca", period=UNIT_PERIOD).photons
    expected = constrain(pair.twin, "pca").constraint.weights
    assert expected[:, 1].max() > 0.1
    np.testing.assert_allclose(found.constraint_weights, expected, atol=1e-5)


def test_photons_at_the_seam_are_free_where_space_repeats() -> None:
    photons = make_periodic(512).program
    at_seam = photons.positions[:, 0] < 0.02
    period = pl.Relaxation(photons, descriptor="gradient", period=UNIT_PERIOD).photons
    border = pl.Relaxation(photons, descriptor="gradient").photons
    assert period.one_sidedness[at_seam].mean() < 0.35
    assert border.one_sidedness[at_seam].mean() > 0.6
