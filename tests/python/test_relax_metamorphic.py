# SPDX-License-Identifier: Apache-2.0
"""Relaxation of the same photons otherwise written: reordered, scaled, moved, turned, run again."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from twin_pairs import UNIT, UP, Pair, make_layers, make_pair, scatter_flat

Doubles = NDArray[np.float64]

COUNT, STEPS = 600, 3
# Every kernel in one run: layers of two emitters hold photons and repel them.
LAYERED: dict[str, Any] = {
    "descriptor": "tensor",
    "constraint": "parameter",
    "repel": "parameter",
    "beta": 2.0,
    "over_relaxation": (2.0, 1.2),
}
WORLD: dict[str, Any] = {"descriptor": "pca", "constraint": "world", "over_relaxation": (2.0, 1.2)}
# Photons on this grid stay the same when they are moved far from the origin.
GRID = 2.0**10
# A quarter turn about y.
TURN = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
# Of the unit square: some float spacings in the places, which in three steps pairs that are very near blow up.
ROUNDING = 5e-5


@cache
def get_source() -> Pair:
    return make_layers("flat", COUNT)


def rebuild(positions: NDArray[Any], order: NDArray[np.int64] | None = None) -> pl.PhotonMap:
    """The source's photons at other positions, or in another order."""
    twin = get_source().twin
    rows = np.arange(COUNT) if order is None else order
    return make_pair(
        positions,
        emitter=twin.emitter[rows],
        parameters=twin.parameters[rows],
        bounds=[UNIT] * 2,
        periodic=[False, True],
    ).program


@cache
def get_relaxed() -> pl.PhotonMap:
    return get_source().program.relax(STEPS, 6, **LAYERED)


@cache
def get_world() -> pl.PhotonMap:
    return get_source().program.relax(STEPS, 6, **WORLD)


# Order


def test_order_of_photons_changes_rounding_at_most() -> None:
    order = np.random.default_rng(1).permutation(COUNT)
    moved = rebuild(get_source().twin.positions[order], order).relax(STEPS, 6, **LAYERED)
    np.testing.assert_allclose(moved.drift, get_relaxed().drift[order], atol=ROUNDING)


def test_order_of_photons_that_tie_does_not_matter() -> None:
    x, z = np.meshgrid(np.arange(20.0), np.arange(20.0))
    lattice = np.stack([x.ravel(), np.zeros(400), z.ravel()], axis=1)
    order = np.random.default_rng(2).permutation(400)
    here = make_pair(lattice).program.relax(1, 7, descriptor="none")
    there = make_pair(lattice[order]).program.relax(1, 7, descriptor="none")
    assert np.abs(here.drift).max() > 0.01
    np.testing.assert_allclose(there.drift, here.drift[order], atol=ROUNDING)


# Scale


@pytest.mark.parametrize("exponent", [-20, 20])
@pytest.mark.parametrize("descriptor", ["none", "gradient", "pca", "tensor", "split"])
def test_scale_by_a_power_of_two_scales_the_bits(descriptor: str, exponent: int) -> None:
    factor = np.float32(2.0**exponent)
    settings = {**LAYERED, "descriptor": descriptor}
    here = get_source().program.relax(STEPS, 6, **settings)
    there = rebuild(get_source().program.positions * factor).relax(STEPS, 6, **settings)
    np.testing.assert_array_equal(there.positions, here.positions * factor)


@pytest.mark.parametrize("exponent", [-20, 20])
def test_scale_by_a_power_of_two_leaves_weights_and_pressure_to_the_bit(exponent: int) -> None:
    factor = np.float32(2.0**exponent)
    there = rebuild(get_source().program.positions * factor).relax(STEPS, 6, **LAYERED)
    assert there.constraint_weights.tobytes() == get_relaxed().constraint_weights.tobytes()
    assert there.pressure.tobytes() == get_relaxed().pressure.tobytes()


@pytest.mark.parametrize("factor", [1e-6, 1e-3, 1e3, 1e6])
def test_any_scale_moves_photons_alike(factor: float) -> None:
    moved = rebuild(get_source().twin.positions * factor).relax(STEPS, 6, **LAYERED)
    np.testing.assert_allclose(moved.drift / factor, get_relaxed().drift, atol=ROUNDING)


# Place


@pytest.mark.parametrize("offset", [(1e4, 0.0, -1e4), (0.0, 1e4, 0.0)])
def test_photons_far_from_the_origin_move_alike(offset: tuple[float, float, float]) -> None:
    places = np.round(scatter_flat(COUNT, 5)[0] * GRID) / GRID
    _, first = np.unique(places, axis=0, return_index=True)  # those that coincide are pushed any way
    places = places[np.sort(first)]
    here = make_pair(places).program.relax(STEPS, 6, **WORLD)
    there = make_pair(places + offset).program.relax(STEPS, 6, **WORLD)
    np.testing.assert_allclose(there.drift, here.drift, atol=ROUNDING)


@pytest.mark.parametrize("turns", [1, 2, 3])
def test_quarter_turns_about_y_turn_the_moves(turns: int) -> None:
    turn = np.linalg.matrix_power(TURN, turns)
    moved = rebuild(get_source().twin.positions @ turn.T).relax(STEPS, 6, **LAYERED)
    np.testing.assert_allclose(moved.drift, get_relaxed().drift @ turn.T, atol=ROUNDING)


def test_quarter_turns_about_y_turn_the_basis_of_constraints() -> None:
    moved = rebuild(get_source().twin.positions @ TURN.T).relax(1, 6, **WORLD)
    held = moved.constraint_weights[:, 1] > 0.1
    expected = get_world().constraint_basis[held] @ TURN.T
    np.testing.assert_allclose(moved.constraint_basis[held], expected, atol=1e-4)


def test_upright_plane_moves_photons_as_a_level_one() -> None:
    places = get_source().twin.positions
    moved = make_pair(places[:, [1, 0, 2]] * (-1.0, 1.0, 1.0), (1.0, 0.0, 0.0)).program.relax(STEPS, 6, **WORLD)
    np.testing.assert_allclose(moved.drift[:, [1, 0, 2]], get_world().drift, atol=ROUNDING)


def test_underside_moves_photons_as_the_upper_side() -> None:
    moved = make_pair(get_source().twin.positions, -np.array(UP)).program.relax(STEPS, 6, **WORLD)
    np.testing.assert_allclose(moved.drift, get_world().drift, atol=ROUNDING)


# Bits


@pytest.mark.parametrize(
    "settings", [WORLD, LAYERED, {**WORLD, "search": "carried"}], ids=["world", "layers", "carried"]
)
def test_two_runs_give_the_same_bits(settings: dict[str, Any]) -> None:
    first, second = (make_layers("flat", COUNT).program.relax(STEPS, 6, **settings) for _ in range(2))
    assert all(first.read_columns()[name].tobytes() == second.read_columns()[name].tobytes() for name in first.recorded)
