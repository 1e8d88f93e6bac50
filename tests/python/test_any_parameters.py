# SPDX-License-Identifier: Apache-2.0
"""Whatever parameters somebody invents, neighbors, β and relaxation finish, and equal brute force."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from conftest import find_scene
from constraint_twins import FEWEST_NEIGHBORS, compute_isotropy, compute_moments, find_isotropy_ramp, hold_by_pca
from layer_search import Cloud, find_constrained_neighbors, find_parameter_neighbors
from odd_parameters import MAKERS, make_parameters
from relax_twins import (
    Members,
    Settings,
    choose_members,
    compute_force,
    compute_over_relaxation,
    find_candidates,
    limit_move,
    measure_parameters,
)
from twin_pairs import Pair, make_pair

Doubles = NDArray[np.float64]

COUNT = 5_000
# The program is asked of these photons; brute force of some.
ASKED = np.arange(0, COUNT, 7)
CHECKED = 18
SAMPLE = np.arange(3, COUNT, 163)
# β no two values of which are whole multiples apart: a layer's border never meets a photon by design.
BETA = 2.9
REPULSION, LIMIT = (2.0, 1.2), 0.3
NEIGHBORS, CONSTRAINT_NEIGHBORS, BETA_NEIGHBORS = 6, 50, 100
# One step is a sum of 32-bit terms about as long as the radius, put onto coordinates of some meters.
STEP_ERROR, POSITION_ERROR = 1e-4, 1e-6
# The lesser eigenvalue is a difference: near 0 its root tells of little but rounding.
ISOTROPY_ERROR = 2e-3
WEIGHT_ERROR = 5e-3
REFUSALS = "no photon has an axis ratio|no β is large enough"
# What takes long to relax with twins beside it is tried with some numbers of columns only.
FEWER = [name for name in MAKERS if name not in ("uniform 2", "uniform 4", "uniform 13")]


@dataclass(frozen=True)
class Case:
    """The same photons for the program and both its twins, in 32 and in 64 bits."""

    pair: Pair
    cloud: Cloud


@cache
def trace_ring() -> pl.PhotonMap:
    photons = pl.trace_photons(pl.load_scene(find_scene("ring")), COUNT, seed=5)
    return photons.select(np.arange(COUNT))


@cache
def build_case(name: str, emitters: int = 1) -> Case:
    ring = trace_ring()
    odd = make_parameters(name, ring)
    emitter = np.random.default_rng(6).integers(0, emitters, COUNT)
    pair = make_pair(
        ring.positions,
        ring.normals,
        emitter=emitter,
        parameters=odd.values,
        bounds=odd.bounds,
        periodic=odd.periodic,
    )
    periods = pair.twin.periods.astype(np.float32)
    cloud = Cloud(pair.program, pair.program.positions, pair.program.parameters, emitter, periods)
    return Case(pair, cloud)


def check_parameter_neighbors(case: Case, k: int) -> None:
    ids, distances = case.pair.program.neighbors(ASKED, k, space="parameter")
    for row in range(0, len(ASKED), CHECKED):
        expected_ids, expected = find_parameter_neighbors(case.cloud, int(ASKED[row]), k)
        np.testing.assert_array_equal(ids[row], expected_ids, err_msg=f"photon {ASKED[row]}")
        np.testing.assert_allclose(distances[row], expected, rtol=2e-7, err_msg=f"photon {ASKED[row]}")


def check_constrained_neighbors(case: Case, k: int, beta: float) -> None:
    ids, distances = case.pair.program.neighbors(ASKED, k, space="constrained", beta=beta)
    for row in range(0, len(ASKED), CHECKED):
        expected_ids, expected = find_constrained_neighbors(case.cloud, int(ASKED[row]), k, beta)
        np.testing.assert_array_equal(ids[row], expected_ids, err_msg=f"photon {ASKED[row]}")
        np.testing.assert_allclose(distances[row], expected, rtol=2e-7, err_msg=f"photon {ASKED[row]}")


def find_parameter_members(pair: Pair, i: int, k: int) -> Members:
    """Members of a photon's query in parameter space, whose measures are squared distances there."""
    twin = pair.twin
    others = twin.is_set & (twin.emitter == twin.emitter[i])
    others[i] = False
    ids = np.flatnonzero(others)
    return choose_members(ids, measure_parameters(twin.parameters[ids], twin.parameters[i], twin.periods) ** 2, k)


def find_layer_members(pair: Pair, i: int, k: int, space: str) -> Members:
    """Members of a photon's query in the world, among its layer or all."""
    radius = np.inf
    if space == "parameter" and pair.twin.is_set[i]:
        apart = np.sort(find_parameter_members(pair, i, COUNT).distances)
        radius = float(apart[k - 1]) if len(apart) >= k else np.inf
    found = find_candidates(pair.twin, i, space=space, beta=BETA, parameter_radius=radius)
    return choose_members(*found, k)


@cache
def relax(name: str, repel: str, emitters: int = 1) -> pl.PhotonMap:
    return build_case(name, emitters).pair.program.relax(
        1,
        NEIGHBORS,
        constraint="parameter",
        descriptor="pca",
        repel=repel,
        beta=BETA,
        over_relaxation=REPULSION,
        limit=LIMIT,
        search="exact",
    )


def check_move(case: Case, moved: pl.PhotonMap, repel: str) -> None:
    """The sampled photons went where the twin pushes them, held as the program says."""
    settings = Settings(steps=1, neighbors=NEIGHBORS, repel=repel, beta=BETA)
    for i in SAMPLE:
        members = find_layer_members(case.pair, int(i), NEIGHBORS, repel)
        force = compute_force(case.pair.twin, int(i), members, compute_over_relaxation(settings, 0))
        basis, weights = moved.constraint_basis[i].astype(float), moved.constraint_weights[i].astype(float)
        force = ((1.0 - weights) * (basis @ force)) @ basis
        expected = limit_move(force, members.radius, LIMIT)
        away = float(np.linalg.norm(moved.drift[i] - expected))
        assert away <= STEP_ERROR * members.radius + POSITION_ERROR, f"photon {i}: {moved.drift[i]}, not {expected}"


def check_weights(case: Case, moved: pl.PhotonMap) -> None:
    """The sampled photons are held as the twin holds them."""
    for i in SAMPLE:
        members = find_layer_members(case.pair, int(i), CONSTRAINT_NEIGHBORS, "parameter")
        if members.places < FEWEST_NEIGHBORS:
            expected = 1.0
        elif members.radius == 0.0:
            expected = 0.0
        else:
            moments = compute_moments(case.pair.twin, int(i), members)
            expected = hold_by_pca(moments, find_isotropy_ramp(CONSTRAINT_NEIGHBORS)).weight
        assert moved.constraint_weights[i, 1] == pytest.approx(expected, abs=WEIGHT_ERROR), f"photon {i}"


# Neighbors


@pytest.mark.parametrize("name", MAKERS)
def test_neighbors_in_parameter_space_are_those_of_brute_force(name: str) -> None:
    check_parameter_neighbors(build_case(name), 50)


@pytest.mark.parametrize("name", MAKERS)
def test_neighbors_in_layers_are_those_of_brute_force(name: str) -> None:
    check_constrained_neighbors(build_case(name), 50, 3.0)


@pytest.mark.parametrize("k", [1, 362])
@pytest.mark.parametrize("name", ["uniform 6", "signature", "ties", "heavy tails", "clusters", "smooth 6"])
def test_few_and_many_neighbors_in_layers_are_those_of_brute_force(name: str, k: int) -> None:
    check_constrained_neighbors(build_case(name), k, 3.0)


@pytest.mark.parametrize("beta", [0.0, 1.0, 1e6])
@pytest.mark.parametrize("name", ["uniform 6", "signature", "half unset", "mixed scales", "normal 6"])
def test_neighbors_in_narrow_and_wide_layers_are_those_of_brute_force(name: str, beta: float) -> None:
    check_constrained_neighbors(build_case(name), 50, beta)


@pytest.mark.parametrize("name", ["half unset", "normal 6", "periodic"])
def test_neighbors_among_three_emitters_are_those_of_brute_force(name: str) -> None:
    case = build_case(name, emitters=3)
    check_parameter_neighbors(case, 50)
    check_constrained_neighbors(case, 50, 3.0)


# β


@pytest.mark.parametrize("name", MAKERS)
def test_beta_is_finite_or_refused_with_its_reason(name: str) -> None:
    try:
        beta = float(pl.optimal_beta(build_case(name).pair.program))
    except pl.ArgumentError as error:
        assert pytest.raises(pl.ArgumentError, match=REFUSALS).matches(error)  # noqa: PT017
        return
    assert np.isfinite(beta)
    assert beta >= 1.0


@pytest.mark.parametrize("name", [name for name in FEWER if name != "constant"])  # that one is refused
def test_isotropy_is_the_twins(name: str) -> None:
    case = build_case(name)
    values = pl.optimal_beta(case.pair.program, BETA_NEIGHBORS, clip=0.5).isotropy.values
    for i in SAMPLE[case.pair.twin.is_set[SAMPLE]]:
        members = find_parameter_members(case.pair, int(i), BETA_NEIGHBORS)
        expected = compute_isotropy(compute_moments(case.pair.twin, int(i), members).covariance)
        if members.radius == 0.0:  # more than k photons of the same parameters: none are the nearest
            expected = np.nan
        assert values[i] == pytest.approx(expected, abs=ISOTROPY_ERROR, nan_ok=True), f"photon {i}"


# Relaxation: parameters that hold nobody back may be remarked upon


quiet = pytest.mark.filterwarnings("ignore::UserWarning")


@quiet
@pytest.mark.parametrize("repel", ["world", "parameter"])
@pytest.mark.parametrize("name", FEWER)
def test_a_step_moves_photons_as_the_twin(name: str, repel: str) -> None:
    check_move(build_case(name), relax(name, repel), repel)


@quiet
@pytest.mark.parametrize("name", FEWER)
def test_photons_are_held_as_the_twin_holds_them(name: str) -> None:
    check_weights(build_case(name), relax(name, "world"))


@quiet
@pytest.mark.parametrize("name", ["half unset", "normal 6", "periodic"])
def test_a_step_moves_photons_of_three_emitters_as_the_twin(name: str) -> None:
    case = build_case(name, emitters=3)
    moved = relax(name, "parameter", emitters=3)
    check_move(case, moved, "parameter")
    check_weights(case, moved)


@quiet
@pytest.mark.parametrize("name", FEWER)
def test_relaxation_with_the_default_settings_stays_finite(name: str) -> None:
    moved = build_case(name).pair.program.relax(steps=1, constraint="parameter")
    assert np.isfinite(moved.positions).all()
