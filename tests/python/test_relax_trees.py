# SPDX-License-Identifier: Apache-2.0
"""Layers that reach everywhere are the world, and say so; a tree that photons flew out of is built anew."""

from __future__ import annotations

import numpy as np
import pytest

import photonloupe as pl

COUNT = 3_000


def build(periodic: bool) -> pl.PhotonMap:
    rng = np.random.default_rng(5)
    places = np.zeros((COUNT, 3))
    places[:, [0, 2]] = rng.random((COUNT, 2))
    photons = pl.PhotonMap.from_arrays(
        positions=places, normals=np.tile((0.0, 1.0, 0.0), (COUNT, 1)), power=np.ones((COUNT, 3))
    )
    values = rng.random((COUNT, 4)) * [1.0, 5.0, 0.1, 2.0]
    photons.set_parameters(values, bounds=[[0, 1], [0, 5], [0, 0.1], [0, 2]], periodic=[False, periodic, False, False])
    return photons


@pytest.mark.parametrize("periodic", [False, True])
def test_layers_that_reach_everywhere_constrain_as_the_world(periodic: bool) -> None:
    photons = build(periodic)
    layered = photons.constrain(constraint="parameter", descriptor="pca", beta=1e6)
    world = photons.constrain(constraint="world", descriptor="pca")
    np.testing.assert_allclose(layered.gradient, world.gradient, rtol=1e-4, atol=1e-3)
    np.testing.assert_allclose(layered.one_sidedness, world.one_sidedness, atol=1e-5)


def test_layers_that_reach_everywhere_repel_as_the_world() -> None:
    photons = build(periodic=True)
    steps = {"steps": 3, "neighbors": 6, "descriptor": "none", "beta": 1e6}
    layered = photons.relax(repel="parameter", **steps)
    world = photons.relax(repel="world", **steps)
    np.testing.assert_allclose(layered.positions, world.positions, atol=2e-5)


def test_layers_that_reach_everywhere_are_named() -> None:
    notes = build(periodic=False).constrain(constraint="parameter", descriptor="pca", beta=1e6).relaxation["notes"]
    assert "reach over all of parameter space for 100 %" in notes[0]


def test_parameters_that_are_all_the_same_are_named() -> None:
    photons = build(periodic=False)
    photons.set_parameters(np.full((COUNT, 2), 3.0), names=["depth", "hue"])
    notes = photons.relax(1, constraint="parameter", descriptor="pca", beta=3.0).relaxation["notes"]
    assert "'depth', 'hue' are the same for all photons" in notes[0]


def test_photons_that_fly_far_are_relaxed_all_the_same() -> None:
    places = np.zeros((40_000, 3))
    places[:, [0, 2]] = np.random.default_rng(0).random((40_000, 2))
    normals = np.tile((0.0, 1.0, 0.0), (40_000, 1))
    photons = pl.PhotonMap.from_arrays(positions=places, normals=normals, power=np.ones((40_000, 3)))
    relaxed = photons.relax(10, 50, descriptor="none", limit=None, over_relaxation=(2.0, 1.2))
    assert np.isfinite(relaxed.positions).all()
    assert np.abs(relaxed.drift).max() > 0.5  # without a border and a limiter the outermost fly off
