# SPDX-License-Identifier: Apache-2.0
"""Naive twins of the neighbor queries that know parameters: brute force, nearest first, ties by id, padded."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from relax_twins import Doubles, Ids, Mask, Photons, find_parameter_radius, measure_parameters, wrap

Found = tuple[Ids, Doubles]


def take_nearest(candidates: Mask, distances: Doubles, k: int) -> Found:
    """Ids and distances of the k nearest candidates, (k,), padded with -1 and inf."""
    ids = np.flatnonzero(candidates)
    ids = ids[np.lexsort((ids, distances[ids]))][:k]
    missing = k - len(ids)
    return np.pad(ids, (0, missing), constant_values=-1), np.pad(distances[ids], (0, missing), constant_values=np.inf)


def stack_found(rows: Sequence[Found]) -> Found:
    """Rows of ids and of distances, (n, k) each."""
    return np.stack([ids for ids, _ in rows]), np.stack([distances for _, distances in rows])


def measure_world(photons: Photons, point: Doubles) -> Doubles:
    """Distance of every photon from a point; no test for the same surface here."""
    return np.linalg.norm(wrap(photons.positions - point, photons.world_periods), axis=1)


def find_layer(photons: Photons, i: int) -> Mask:
    """Photons that share the emitter of i and, like i, have or lack parameters; without i."""
    is_set = photons.is_set
    layer = (photons.emitter == photons.emitter[i]) & (is_set == is_set[i])
    layer[i] = False
    return layer


def find_parameter_neighbors(photons: Photons, ids: Sequence[int], k: int) -> Found:
    """Nearest in parameter space of photons; a photon without parameters has none."""
    rows = []
    for i in ids:
        apart = measure_parameters(photons.parameters, photons.parameters[i], photons.periods)
        rows.append(take_nearest(find_layer(photons, i) & photons.is_set, apart, k))
    return stack_found(rows)


def find_parameter_neighbors_of_values(photons: Photons, values: Doubles, k: int) -> Found:
    """Nearest in parameter space of points in it; emitters mix, since a point has none."""
    rows = []
    for value in values:
        rows.append(take_nearest(photons.is_set, measure_parameters(photons.parameters, value, photons.periods), k))
    return stack_found(rows)


def find_range(photons: Photons, i: int, k: int, beta: float) -> Mask:
    """Photons of i's layer within β r_q(i) in parameter space; without i."""
    layer = find_layer(photons, i)
    radius = find_parameter_radius(photons.parameters, photons.is_set, photons.emitter, k, photons.periods)[i]
    if not np.isfinite(radius):
        return layer
    return layer & (measure_parameters(photons.parameters, photons.parameters[i], photons.periods) <= beta * radius)


def find_constrained_neighbors(photons: Photons, ids: Sequence[int], k: int, beta: float = 3.0) -> Found:
    """Nearest in the world among those near in parameter space."""
    return stack_found(
        [take_nearest(find_range(photons, i, k, beta), measure_world(photons, photons.positions[i]), k) for i in ids]
    )


def find_locked_neighbors(
    photons: Photons,
    points: Doubles,
    k: int,
    *,
    center: int | None = None,
    ranges: Mapping[int, tuple[float, float]] | None = None,
    beta: float = 3.0,
) -> Found:
    """Nearest in the world of points, the range held about one photon, itself included, or given per dimension."""
    if center is not None:
        allowed = find_range(photons, center, k, beta)
        allowed[center] = True
    else:
        allowed = photons.is_set.copy()
        for dimension, (low, high) in (ranges or {}).items():
            values = photons.parameters[:, dimension]
            allowed &= (values >= low) & (values <= high)
    return stack_found([take_nearest(allowed, measure_world(photons, point), k) for point in points])
