# SPDX-License-Identifier: Apache-2.0
"""A small map to relax, with parameters and without, and its columns bit for bit."""

from __future__ import annotations

from typing import Any

import numpy as np

import photonloupe as pl

COUNT = 600
STEPS = 3
# Columns that relaxation takes over from the old map.
KEPT = ("emitter", "emitted_index", "object")
UP = (0.0, 1.0, 0.0)


def build(count: int = COUNT, *, parameters: bool = False) -> pl.PhotonMap:
    """Photons of two lights on the plane y = 0, denser on one half."""
    rng = np.random.default_rng(5)
    x = np.where(rng.random(count) < 0.8, 0.5 * rng.random(count), rng.random(count))
    photons = pl.PhotonMap.from_arrays(
        positions=np.stack([x, np.zeros(count), rng.random(count)], axis=1),
        normals=np.tile([UP], (count, 1)),
        power=rng.random((count, 3)),
        emitter=np.arange(count) % 2,
        emitted_index=3 * np.arange(count),
        object=np.arange(count) % 5 - 1,
    )
    if parameters:
        set_parameters(photons)
    return photons


def set_parameters(photons: pl.PhotonMap) -> None:
    """A parameter along x, in steps; a few photons are unset."""
    values = np.stack([np.floor(4 * photons.positions[:, 0]), photons.positions[:, 2]], axis=1)
    values[::50] = np.nan
    photons.set_parameters(values, ("layer", "z"))


def read_column(photons: pl.PhotonMap, name: str) -> tuple[Any, ...]:
    """Type, shape and bits of a column, also of the traced positions, which have no attribute."""
    values = photons.read_columns()[name]
    return values.dtype, values.shape, values.tobytes()
