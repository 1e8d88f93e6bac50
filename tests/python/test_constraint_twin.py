# SPDX-License-Identifier: Apache-2.0
"""Constraints say what the naive twins say: every descriptor, in world and layers, on planes, spheres and lines."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from constraint_twins import Constraints, constrain
from twin_pairs import make_layers, make_pair, scatter_flat

COUNT, BETA = 600, 2.0
# The twin of `split` tries every gap of every photon: it is slow.
SPLIT_COUNT = 200
NEIGHBORS = {"gradient": 50, "pca": 50, "tensor": 50, "split": 150}
SPACES = ("world", "parameter")
# Sums of some 50 to 150 terms in 32 bits, over ramps 0.1 to 4 wide.
TOLERANCE = 2e-5
# The direction across of a photon that is hardly held hangs on little.
HELD = 0.05

CASES = [
    (shape, descriptor, space)
    for shape in ("flat", "sphere")
    for descriptor in NEIGHBORS
    for space in SPACES
    if (shape, descriptor) != ("sphere", "split")
]


@cache
def measure(shape: str, descriptor: str, space: str) -> tuple[pl.PhotonMap, Constraints]:
    """Return the program's constraint and the twin's."""
    pair = make_layers(shape, SPLIT_COUNT if descriptor == "split" else COUNT, dimensions=1)
    keywords: dict[str, Any] = {"constraint": space, "descriptor": descriptor, "beta": BETA}
    expected = constrain(pair.twin, descriptor, neighbors=NEIGHBORS[descriptor], space=space, beta=BETA)
    return pair.program.constrain(**keywords), expected


@pytest.mark.parametrize(("shape", "descriptor", "space"), CASES)
def test_weights_are_the_twins(shape: str, descriptor: str, space: str) -> None:
    found, expected = measure(shape, descriptor, space)
    np.testing.assert_allclose(found.constraint_weights, expected.constraint.weights, atol=TOLERANCE)


@pytest.mark.parametrize(("shape", "descriptor", "space"), CASES)
def test_basis_of_held_photons_is_the_twins(shape: str, descriptor: str, space: str) -> None:
    found, expected = measure(shape, descriptor, space)
    # A photon that sees nobody has no direction.
    held = (expected.constraint.weights[:, 1] > HELD) & (expected.one_sidedness > 0.0)
    assert held.any()
    np.testing.assert_allclose(found.constraint_basis[held], expected.constraint.basis[held], atol=2e-4)


@pytest.mark.parametrize(("shape", "descriptor", "space"), CASES)
def test_gradient_is_the_twins(shape: str, descriptor: str, space: str) -> None:
    found, expected = measure(shape, descriptor, space)
    size = np.linalg.norm(expected.gradient, axis=1).max()
    np.testing.assert_allclose(found.gradient, expected.gradient, atol=1e-5 * size)


@pytest.mark.parametrize(("shape", "descriptor", "space"), CASES)
def test_one_sidedness_is_the_twins(shape: str, descriptor: str, space: str) -> None:
    found, expected = measure(shape, descriptor, space)
    np.testing.assert_allclose(found.one_sidedness, expected.one_sidedness, atol=TOLERANCE)


@pytest.mark.parametrize("descriptor", NEIGHBORS)
def test_photons_of_a_plane_are_held_by_different_shares(descriptor: str) -> None:
    # The comparisons above would say nothing of a descriptor that holds all or none.
    weights = measure("flat", descriptor, "world")[1].constraint.weights[:, 1]
    assert (weights < 0.1).any()
    assert (weights > 0.9).any()


@pytest.mark.parametrize(
    ("descriptor", "thresholds"),
    [("gradient", (0.2, 0.5)), ("pca", (0.9, 0.3)), ("tensor", (4.0, 20.0)), ("split", (0.35, 0.0))],
)
def test_own_thresholds_act_as_the_twins_ramp(descriptor: str, thresholds: tuple[float, float]) -> None:
    pair = make_pair(*scatter_flat(SPLIT_COUNT, 1))
    found = pair.program.constrain(descriptor=descriptor, thresholds=thresholds, constraint_neighbors=50)
    low, high = sorted(thresholds)
    expected = constrain(pair.twin, descriptor, neighbors=50, ramp=(low, high)).constraint.weights
    assert np.ptp(expected[:, 1]) > 0.4
    np.testing.assert_allclose(found.constraint_weights, expected, atol=TOLERANCE)


@pytest.mark.parametrize("neighbors", [12, 20, 100, 250])
def test_pca_of_another_number_of_neighbors_is_the_twins(neighbors: int) -> None:
    pair = make_pair(*scatter_flat(400, 2))
    found = pair.program.constrain(descriptor="pca", constraint_neighbors=neighbors)
    expected = constrain(pair.twin, "pca", neighbors=neighbors).constraint.weights
    np.testing.assert_allclose(found.constraint_weights, expected, atol=TOLERANCE)


@pytest.mark.parametrize(("count", "is_frozen"), [(1, True), (2, True), (13, True), (14, False)])
def test_photon_with_fewer_than_twelve_neighbors_is_fixed(count: int, is_frozen: bool) -> None:
    # One neighbor gives the radius, and a photon is not its own.
    pair = make_pair(*scatter_flat(count, 3))
    weights = pair.program.constrain(descriptor="pca").constraint_weights
    np.testing.assert_array_equal((weights == 1.0).all(axis=1), is_frozen)
    np.testing.assert_allclose(weights, constrain(pair.twin, "pca").constraint.weights, atol=TOLERANCE)


@pytest.mark.parametrize("descriptor", NEIGHBORS)
def test_no_photons_have_no_constraints(descriptor: str) -> None:
    found = make_pair(np.empty((0, 3))).program.constrain(descriptor=descriptor)
    shapes = (found.constraint_basis.shape, found.constraint_weights.shape, found.gradient.shape)
    assert (shapes, found.one_sidedness.shape) == (((0, 2, 3), (0, 2), (0, 3)), (0,))


@pytest.mark.parametrize("descriptor", NEIGHBORS)
def test_mirrored_photons_are_held_alike(descriptor: str) -> None:
    places, normals = scatter_flat(SPLIT_COUNT, 4)
    here = make_pair(places, normals).program.constrain(descriptor=descriptor)
    there = make_pair(places * (-1.0, 1.0, 1.0), normals).program.constrain(descriptor=descriptor)
    np.testing.assert_allclose(here.constraint_weights, there.constraint_weights, atol=TOLERANCE)
