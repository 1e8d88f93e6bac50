# SPDX-License-Identifier: Apache-2.0
"""Extremes of parameters: not finite, too many, none set, all alike, over the seam, β from nothing to everything."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from constraint_twins import constrain
from extremes_table import add_row, show
from parameter_twins import find_constrained_neighbors, find_parameter_neighbors
from relax_twins import Settings, relax_step
from twin_pairs import UNIT, Pair, make_pair, scatter_flat

Doubles = NDArray[np.float64]

COUNT = 300
REPULSION = (2.0, 1.2)
TOLERANCE = 2e-5
ALIKE = 0.999  # share of ranks that rounding of scaled values leaves as they are


def make_layered(values: Doubles, seed: int = 1, *, emitter: NDArray[np.int64] | None = None) -> Pair:
    return make_pair(*scatter_flat(len(values), seed), emitter=emitter, parameters=values)


def measure_layers(pair: Pair, beta: float) -> float:
    """Largest error of a constrained step within layers: of the weights, and of moves as a share of the radius."""
    keywords = {"descriptor": "pca", "constraint": "parameter", "repel": "parameter", "beta": beta}
    moved = pair.program.relax(1, 6, over_relaxation=REPULSION, **keywords)  # type: ignore[arg-type]
    assert np.isfinite(moved.positions).all()
    held = constrain(pair.twin, "pca", space="parameter", beta=beta).constraint
    twin = relax_step(pair.twin, Settings(steps=1, repel="parameter", beta=beta), 0, held)
    error = np.linalg.norm(moved.drift - twin.moves, axis=1)
    shares = error / np.where(twin.radii > 0.0, twin.radii, np.inf)
    assert not error[twin.radii == 0.0].any()
    return max(float(shares.max()), float(np.abs(moved.constraint_weights - held.weights).max()))


def make_random(width: int = 2, count: int = COUNT) -> Doubles:
    return np.random.default_rng(2).random((count, width))


def test_parameters_that_are_not_numbers_unset_the_photon() -> None:
    values = make_random()
    values[7, 1] = np.nan
    photons = make_layered(values).program
    assert np.flatnonzero(~photons.parameters_set).tolist() == [7]


def test_parameters_whose_distances_are_no_floats_are_refused() -> None:
    for factor, message in ((1e19, "reaches .*scale the parameters down"), (1e-13, "within .*scale the parameters up")):
        photons = make_layered(make_random() * factor).program
        with pytest.raises(pl.PhotonLoupeError, match=message):
            photons.neighbors([0], 5, space="parameter")
        with pytest.raises(pl.PhotonLoupeError, match=message):
            photons.relax(1, 6, constraint="parameter")
    add_row("parameters-range", "4 refusals")


@pytest.mark.parametrize("factor", [1e-11, 1e17])
def test_parameters_just_within_the_range_of_distances_rank_alike(factor: float) -> None:
    plain, scaled = (make_layered(make_random() * scale).program for scale in (1.0, factor))
    found, _ = scaled.neighbors(np.arange(COUNT), 9, space="parameter")
    expected, _ = plain.neighbors(np.arange(COUNT), 9, space="parameter")
    assert np.mean(found == expected) > ALIKE


def test_infinite_parameters_are_refused_by_row_and_column() -> None:
    photons = make_layered(make_random()).program
    for value in (np.inf, -np.inf, 1e39):
        values = make_random()
        values[7, 1] = value
        with pytest.raises(pl.ArgumentError, match=r"values\[7\]\[1\].*(infinite|does not fit)"):
            photons.set_parameters(values)
    add_row("parameters-not-finite", "3")


def test_numbers_of_parameters_out_of_range_are_refused() -> None:
    photons = make_layered(make_random()).program
    for width in (0, 14):
        with pytest.raises(pl.ArgumentError, match="m from 1 to 13"):
            photons.set_parameters(np.zeros((COUNT, width)))
    add_row("parameters-limit", "message checked")


def test_photons_without_parameters_are_layers_by_emitter() -> None:
    pair = make_layered(np.full((COUNT, 2), np.nan), emitter=np.arange(COUNT) % 2)
    assert (pair.program.neighbors(np.arange(COUNT), 5, space="parameter")[0] == -1).all()
    ids = pair.program.neighbors(np.arange(COUNT), 5, space="constrained")[0]
    np.testing.assert_array_equal(ids, find_constrained_neighbors(pair.twin, range(COUNT), 5)[0])
    with pytest.raises(pl.ArgumentError, match="no photon has an axis ratio"):
        pl.optimal_beta(pair.program)
    error = measure_layers(pair, 3.0)
    add_row("parameters-unset", f"error {show(error)}")
    assert error < TOLERANCE


def test_photons_that_are_alone_in_their_layer_stay() -> None:
    pair = make_layered(make_random(), emitter=np.arange(COUNT))
    for space in ("parameter", "constrained"):
        assert (pair.program.neighbors(np.arange(COUNT), 5, space=space)[0] == -1).all()
    moved = pair.program.relax(2, 6, descriptor="pca", constraint="parameter", repel="parameter", beta=3.0)
    assert not moved.drift.any()
    add_row("emitter-each", "checked")


def test_parameter_of_three_values_makes_layers_of_them() -> None:
    values = np.random.default_rng(3).choice([1.0, 2.0, 5.0], 3_000)
    pair = make_layered(values[:, None])
    asked = np.arange(0, 3_000, 30)
    ids = pair.program.neighbors(np.arange(3_000), 50, space="parameter")[0][asked]
    np.testing.assert_array_equal(ids, find_parameter_neighbors(pair.twin, asked.tolist(), 50)[0])
    found = pair.program.constrain(constraint="parameter", descriptor="pca", beta=3.0).constraint_weights
    # At every value its own photons only: as if there were no others.
    error = 0.0
    for value in (1.0, 2.0, 5.0):
        alone = pair.program.select(values == value).constrain(constraint="world", descriptor="pca")
        error = max(error, float(np.abs(found[values == value] - alone.constraint_weights).max()))
    add_row("signature", f"error {show(error)}")
    assert error < TOLERANCE


def test_layers_of_a_parameter_of_three_values_relax_as_the_twins() -> None:
    values = np.random.default_rng(3).choice([1.0, 2.0, 5.0], (400, 1))
    assert measure_layers(make_layered(values), 3.0) < TOLERANCE


def test_seam_of_a_periodic_parameter_is_nowhere() -> None:
    # On a grid, so that moving the seam changes no bit.
    turns = np.round(make_random(1) * 256.0) / 256.0
    keywords = {"descriptor": "pca", "constraint": "parameter", "repel": "parameter", "beta": 1.0}
    moves = []
    for seam in (0.0, 0.5):
        places, normals = scatter_flat(COUNT, 1)
        values = np.mod(turns + seam, 1.0)
        pair = make_pair(places, normals, parameters=values, bounds=[UNIT], periodic=[True])
        moves.append(pair.program.relax(2, 6, **keywords).drift)  # type: ignore[arg-type]
    error = float(np.abs(moves[1] - moves[0]).max())
    add_row("parameters-seam", f"largest difference {show(error)}")
    assert np.abs(moves[0]).max() > 0.01
    assert error < 1e-6


def test_beta_from_nothing_to_everything_relaxes_as_the_twins() -> None:
    pair = make_layered(make_random())
    error = max(measure_layers(pair, beta) for beta in (0.0, 1e-3, 1e6))
    add_row("beta", f"error {show(error)}")
    assert error < TOLERANCE


def test_fewest_and_most_neighbors_in_layers_are_the_twins() -> None:
    pair = make_layered(make_random())
    every, asked = np.arange(COUNT), range(0, COUNT, 10)
    error = 0.0
    for k in (1, 998):
        ids, distances = pair.program.neighbors(every, k, space="parameter")
        expected = find_parameter_neighbors(pair.twin, asked, k)[1]
        assert ((ids[asked] == -1) == np.isinf(expected)).all()
        error = max(error, measure_difference(distances[asked], expected))
        distances = pair.program.neighbors(every, k, space="constrained")[1]
        error = max(error, measure_difference(distances[asked], find_constrained_neighbors(pair.twin, asked, k)[1]))
    add_row("layers-k", f"error {show(error)}")
    assert error < TOLERANCE


def measure_difference(found: NDArray[np.float32], expected: Doubles) -> float:
    """Largest difference of distances, infinite ones at the same places."""
    np.testing.assert_array_equal(np.isinf(found), np.isinf(expected))
    known = np.isfinite(expected)
    return float(np.abs(found[known] - expected[known]).max())


def test_photons_of_no_extent_give_no_beta() -> None:
    values = make_random()
    photons = make_pair(np.tile((0.5, 0.0, 0.5), (COUNT, 1)), parameters=values).program
    with pytest.raises(pl.ArgumentError, match="no photon has an axis ratio"):
        pl.optimal_beta(photons, 50)
    line = np.zeros((COUNT, 3))
    line[:, 0] = values[:, 0]
    photons = make_pair(line, parameters=values).program
    with pytest.raises(pl.ArgumentError, match="no β is large enough"):
        pl.optimal_beta(photons, 50)
    add_row("beta-degenerate", "messages checked")
