# SPDX-License-Identifier: Apache-2.0
"""Brute force over layers in the kernels' own 32 bits: what the program finds must equal it exactly."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

import photonloupe as pl

Floats = NDArray[np.float32]
Ids = NDArray[np.int64]
Mask = NDArray[np.bool_]
Found = tuple[Ids, Floats]

# Coordinates on such a grid in the unit cube stay exact when the program counts them from the map's middle.
GRID = 2.0**20
UNSET_EVERY = 50


@dataclass(frozen=True)
class Cloud:
    """Photons, and what brute force knows of them: values (n, m), NaN where unset, and periods (m,), 0: none."""

    photons: pl.PhotonMap
    positions: Floats
    values: Floats
    emitter: Ids
    periods: Floats

    @property
    def is_set(self) -> Mask:
        """Photons of which every parameter is set, (n,)."""
        return np.asarray(~np.isnan(self.values).any(axis=1))


def make_cloud(values: ArrayLike, *, periodic: int = 0, seed: int = 0, emitters: int = 2) -> Cloud:
    """Photons at random places of the unit square, every fiftieth unset; the last `periodic` parameters repeat at 1."""
    rng = np.random.default_rng(seed)
    columns = np.array(values, dtype=np.float32)
    count, width = columns.shape
    columns[::UNSET_EVERY] = np.nan
    columns[1::UNSET_EVERY, 0] = np.nan  # one missing value unsets them all
    positions = np.zeros((count, 3), dtype=np.float32)
    positions[:, [0, 2]] = np.round(rng.random((count, 2)) * GRID) / GRID
    emitter = rng.integers(0, emitters, count)
    photons = pl.PhotonMap.from_arrays(
        positions=positions,
        normals=np.tile((0.0, 1.0, 0.0), (count, 1)),
        power=np.ones((count, 3)),
        emitter=emitter,
    )
    flags = [i >= width - periodic for i in range(width)]
    photons.set_parameters(columns, None, [(0.0, 1.0)] * width, flags)
    return Cloud(photons, positions, columns, emitter, np.array(flags, dtype=np.float32))


def square_parameters(cloud: Cloud, value: Floats) -> Floats:
    """Squared distance of every photon from a place in parameter space, (n,), dimension after dimension."""
    total = np.zeros(len(cloud.values), dtype=np.float32)
    for dimension, period in enumerate(cloud.periods):
        away = cloud.values[:, dimension] - value[dimension]
        if period > 0.0:
            away = away - period * np.round(away * (np.float32(1.0) / period))
        total = total + away * away
    return total


def square_world(cloud: Cloud, point: Floats) -> Floats:
    """Squared distance of every photon from a place in the world, (n,)."""
    away = cloud.positions - point
    x, y, z = away.T
    return np.asarray(x * x + y * y + z * z, dtype=np.float32)


def take_nearest(measure: Floats, k: int) -> Found:
    """Ids and distances of the k least finite measures, ties by id, padded with -1 and inf."""
    order = np.lexsort((np.arange(len(measure)), measure))[:k]
    order = order[np.isfinite(measure[order])]
    missing = k - len(order)
    ids = np.pad(order, (0, missing), constant_values=-1)
    distances = np.full(k, np.inf, dtype=np.float32)
    distances[: len(order)] = np.sqrt(measure[order])
    return ids, distances


def keep_only(measure: Floats, allowed: Mask) -> Floats:
    return np.where(allowed, measure, np.inf).astype(np.float32)


def find_parameter_neighbors(cloud: Cloud, i: int, k: int) -> Found:
    """Nearest in parameter space of a photon, of its emitter."""
    allowed = cloud.is_set & (cloud.emitter == cloud.emitter[i])
    allowed[i] = False
    if not cloud.is_set[i]:
        allowed[:] = False
    return take_nearest(keep_only(square_parameters(cloud, cloud.values[i]), allowed), k)


def find_layer(cloud: Cloud, i: int, k: int, beta: float) -> Mask:
    """Photons of i's layer, i itself among them: of its emitter, and within β r_q, or like it without parameters."""
    layer = (cloud.emitter == cloud.emitter[i]) & (cloud.is_set == cloud.is_set[i])
    if not cloud.is_set[i]:
        return layer
    measure = keep_only(square_parameters(cloud, cloud.values[i]), layer)
    others = np.sort(np.delete(measure, i))
    square = others[k - 1] if len(others) >= k else np.float32(np.inf)
    reach = np.float32(beta) * np.float32(beta) * square if beta > 0.0 else np.float32(0.0)
    return layer & (measure <= reach)


def find_constrained_neighbors(cloud: Cloud, i: int, k: int, beta: float) -> Found:
    """Nearest in the world of a photon among its layer."""
    layer = find_layer(cloud, i, k, beta)
    layer[i] = False
    return take_nearest(keep_only(square_world(cloud, cloud.positions[i]), layer), k)
