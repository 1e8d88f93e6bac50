# SPDX-License-Identifier: Apache-2.0
"""Settings of relaxation: what is refused and why, and what they stand for when nothing is said."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from photonloupe.settings import list_settings
from relax_maps import COUNT, STEPS, build


@pytest.fixture(scope="module")
def photons() -> pl.PhotonMap:
    return build()


@pytest.fixture(scope="module")
def layered() -> pl.PhotonMap:
    return build(parameters=True)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"steps": -1}, "steps must be from 0 to 10000, not -1"),
        ({"steps": 10_001}, "steps must be from 0"),
        ({"steps": 2.5}, "steps must be a whole number"),
        ({"steps": True}, "steps must be from 0"),
        ({"neighbors": 0}, "neighbors must be from 1 to 998, not 0"),
        ({"neighbors": 999}, "neighbors must be from 1"),
        ({"constraint": "paths"}, "constraint must be one of auto, world, parameter, not 'paths'"),
        ({"descriptor": "ppca"}, "descriptor must be one of none, gradient, pca, tensor, split, not 'ppca'"),
        ({"repel": "auto"}, "repel must be one of world, parameter, not 'auto'"),
        ({"search": "quick"}, "search must be one of exact, .*, not 'quick'"),
        ({"surface": "plane"}, "surface must be one of auto, tangent, not 'plane'"),
        ({"over_relaxation": 0.0}, "over_relaxation must be from 0.001 to 1000, not 0.0"),
        ({"over_relaxation": (2.0, np.nan)}, "over_relaxation must be from"),
        ({"over_relaxation": (2.0, 1.5, 1.0)}, "over_relaxation must be 2 numbers"),
        ({"over_relaxation": "fast"}, "over_relaxation must be"),
        ({"limit": 0.0}, "limit must be from 1e-06 to 1e\\+06, not 0.0"),
        ({"limit": np.inf}, "limit must be from"),
        ({"limit": "little"}, "limit must be a number or none, not 'little'"),
        ({"constraint_neighbors": 11}, "constraint_neighbors must be from 12 to 998, not 11"),
        ({"constraint_neighbors": 999}, "constraint_neighbors must be from 12"),
        ({"thresholds": (0.5,)}, "thresholds must be 2 numbers"),
        ({"thresholds": (0.5, 0.5)}, "thresholds must be two different numbers, not both 0.5"),
        ({"thresholds": (0.5, np.nan)}, "thresholds must be from"),
        ({"thresholds": 0.5}, "thresholds must be"),
        ({"constraint": "parameter"}, 'constraint="parameter" needs parameters'),
        ({"repel": "parameter"}, 'repel="parameter" needs parameters'),
        ({"beta": -1.0}, "beta must be from 0"),
        ({"beta": "best"}, "beta must be a number or auto"),
        ({"period": (1.0, 1.0)}, "period must be 3 numbers"),
        ({"period": (1.0, -1.0, 0.0)}, "period must be from 0"),
    ],
    ids=lambda value: None if isinstance(value, str) else str(value),
)
def test_setting_out_of_range_is_refused(photons: pl.PhotonMap, settings: dict[str, Any], message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        photons.relax(**settings)


@pytest.mark.parametrize(
    ("beta", "message"),
    [(-1.0, "beta must be from 0"), (np.nan, "beta must be from 0"), ("best", "beta must be a number or auto")],
)
def test_beta_out_of_range_is_refused_where_it_is_used(layered: pl.PhotonMap, beta: Any, message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        layered.relax(STEPS, beta=beta)


def test_unknown_setting_is_refused(photons: pl.PhotonMap) -> None:
    with pytest.raises(TypeError, match="speed"):
        photons.relax(speed=1)  # type: ignore[call-arg]


def test_constraint_is_that_of_the_parameters_where_there_are_any(layered: pl.PhotonMap) -> None:
    assert layered.relax(0).relaxation["settings"]["constraint"] == "parameter"


def test_constraint_is_that_of_the_world_where_there_are_no_parameters(photons: pl.PhotonMap) -> None:
    assert photons.relax(0).relaxation["settings"]["constraint"] == "world"


def test_constraint_of_the_world_leaves_parameters_alone(photons: pl.PhotonMap, layered: pl.PhotonMap) -> None:
    here, there = (each.relax(STEPS, constraint="world") for each in (photons, layered))
    assert here.positions.tobytes() == there.positions.tobytes()


def test_layers_change_where_photons_go(layered: pl.PhotonMap) -> None:
    world, parameter = (layered.relax(STEPS, beta=1.0, constraint=space) for space in ("world", "parameter"))
    assert not np.array_equal(world.positions, parameter.positions)


def test_beta_auto_is_that_of_optimal_beta(layered: pl.PhotonMap) -> None:
    assert layered.relax(0, beta="auto").relaxation["settings"]["beta"] == float(pl.optimal_beta(layered))


def test_one_number_is_both_ends_of_over_relaxation(photons: pl.PhotonMap) -> None:
    one, two = (photons.relax(STEPS, over_relaxation=value) for value in (1.5, (1.5, 1.5)))
    assert one.positions.tobytes() == two.positions.tobytes()


def test_neighbors_are_the_second_argument(photons: pl.PhotonMap) -> None:
    assert photons.relax(1, 7).relaxation["settings"]["neighbors"] == 7


def test_settings_that_nothing_was_said_of_are_in_the_report(photons: pl.PhotonMap) -> None:
    assert None not in photons.relax(0).relaxation["settings"].values()


def test_even_emission_needs_fewer_steps(ring: pl.Scene) -> None:
    sobol, random = (pl.trace_photons(ring, 500, emission=emission) for emission in ("sobol", "random"))
    assert pl.Relaxation(sobol).steps < pl.Relaxation(random).steps


@pytest.mark.parametrize("search", list_settings("relax")["search"].choices)
def test_every_search_moves_photons_apart(photons: pl.PhotonMap, search: str) -> None:
    moved = photons.relax(STEPS, descriptor="none", search=search)
    nearest = [np.median(each.neighbors(np.arange(COUNT), 1)[1]) for each in (photons, moved)]
    assert nearest[1] > nearest[0]
