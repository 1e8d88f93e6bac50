# SPDX-License-Identifier: Apache-2.0
"""Layers are the same whichever tree they are sought in, and a tree that photons flew out of is built anew."""

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
        positions=places,
        normals=np.tile((0.0, 1.0, 0.0), (COUNT, 1)),
        power=np.ones((COUNT, 3)),
        emitter=rng.integers(0, 2, COUNT),
    )
    values = rng.random((COUNT, 4)) * [1.0, 5.0, 0.1, 2.0]
    values[::40] = np.nan
    photons.set_parameters(values, bounds=[[0, 1], [0, 5], [0, 0.1], [0, 2]], periodic=[False, periodic, False, False])
    return photons


@pytest.mark.parametrize("periodic", [False, True])
@pytest.mark.parametrize("beta", [0.0, 1.0, 3.0, 1e6])
def test_constraints_do_not_depend_on_the_tree(periodic: bool, beta: float) -> None:
    photons = build(periodic)
    layered = photons.constrain(constraint="parameter", descriptor="pca", beta=beta, tree="layered")
    position = photons.constrain(constraint="parameter", descriptor="pca", beta=beta, tree="position")
    np.testing.assert_allclose(layered.gradient, position.gradient, rtol=1e-4, atol=1e-3)
    np.testing.assert_allclose(layered.one_sidedness, position.one_sidedness, atol=1e-5)


def test_repulsion_does_not_depend_on_the_tree() -> None:
    photons = build(periodic=True)
    steps = {"steps": 3, "neighbors": 6, "repel": "parameter", "constraint": "world", "descriptor": "none", "beta": 4.0}
    layered = photons.relax(tree="layered", **steps)
    position = photons.relax(tree="position", **steps)
    np.testing.assert_allclose(layered.positions, position.positions, atol=2e-5)


def test_photons_that_fly_far_are_relaxed_all_the_same() -> None:
    places = np.zeros((40_000, 3))
    places[:, [0, 2]] = np.random.default_rng(0).random((40_000, 2))
    normals = np.tile((0.0, 1.0, 0.0), (40_000, 1))
    photons = pl.PhotonMap.from_arrays(positions=places, normals=normals, power=np.ones((40_000, 3)))
    relaxed = photons.relax(10, 50, descriptor="none", limit=None, over_relaxation=(2.0, 1.2))
    assert np.isfinite(relaxed.positions).all()
    assert np.abs(relaxed.drift).max() > 0.5  # without a border and a limiter the outermost fly off
