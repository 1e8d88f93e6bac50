# SPDX-License-Identifier: Apache-2.0
"""Naive twins of the engine's queries: brute force in double precision, one point at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]

# METHODS section 2: photons of another surface are left out.
MIN_NORMAL_COSINE = 0.7
MAX_HEIGHT_SHARE = 0.1
# With fewer photons than asked for, the radius reaches just past the farthest.
PAST_THE_FARTHEST = 1.0 + 1e-6
CONE_FACTOR = 1.1
# Jensen's Gaussian: weight α(1 − (1 − exp(−β d²/2r²))/(1 − exp(−β))), normalized by its own integral.
GAUSSIAN_ALPHA = 0.918
GAUSSIAN_BETA = 1.953
GAUSSIAN_NORM = 0.531


def find_neighbors(
    positions: Doubles, points: Doubles, k: int, excluded: NDArray[np.int64] | None = None
) -> tuple[NDArray[np.int64], Doubles]:
    """Ids and distances of the k nearest, nearest first, ties by id, padded with -1 and inf."""
    ids = np.full((len(points), k), -1, dtype=np.int64)
    distances = np.full((len(points), k), np.inf)
    for row, point in enumerate(points):
        away = np.sum((positions - point) ** 2, axis=1)
        order = np.lexsort((np.arange(len(positions)), away))
        if excluded is not None:
            order = order[order != excluded[row]]
        order = order[:k]
        ids[row, : len(order)] = order
        distances[row, : len(order)] = np.sqrt(away[order])
    return ids, distances


def weigh(kernel: str, t: Doubles) -> Doubles:
    """Kernel at t = d/r, times π r²."""
    if kernel == "epanechnikov":
        return 2.0 * np.maximum(1.0 - t**2, 0.0)
    if kernel == "cone":
        return np.maximum(1.0 - t / CONE_FACTOR, 0.0) / (1.0 - 2.0 / (3.0 * CONE_FACTOR))
    if kernel == "gaussian":
        falloff = (1.0 - np.exp(-GAUSSIAN_BETA * t**2 / 2.0)) / (1.0 - np.exp(-GAUSSIAN_BETA))
        return GAUSSIAN_ALPHA * (1.0 - falloff) / GAUSSIAN_NORM
    raise ValueError(kernel)


def estimate_irradiance(
    positions: Doubles,
    normals: Doubles,
    power: Doubles,
    points: Doubles,
    facing: Doubles,
    k: int,
    kernel: str = "epanechnikov",
) -> Doubles:
    """Irradiance at every point, (n, 3)."""
    result = np.zeros((len(points), 3))
    for row, (point, normal) in enumerate(zip(np.asarray(points, float), np.asarray(facing, float), strict=True)):
        candidates = np.flatnonzero(normals.astype(float) @ normal > MIN_NORMAL_COSINE)
        offset = positions[candidates].astype(float) - point
        away = np.linalg.norm(offset, axis=1)
        effective = np.maximum(away, np.abs(offset @ normal) / MAX_HEIGHT_SHARE)
        order = np.lexsort((candidates, effective))
        chosen = order[:k]
        if len(chosen) == 0:
            continue
        flux = power[candidates[chosen]].astype(float)
        if kernel == "disc":
            radius = effective[chosen[-1]]
            found = len(chosen)
            result[row] = (found - 1) / found * flux.sum(axis=0) / (np.pi * radius**2)
            continue
        radius = effective[order[k]] if len(order) > k else effective[chosen[-1]] * PAST_THE_FARTHEST
        result[row] = (weigh(kernel, away[chosen] / radius) @ flux) / (np.pi * radius**2)
    return result


def measure_power(points: Doubles, frequencies: NDArray[np.int32]) -> Doubles:
    """Power of points in [0, 1]² at whole frequencies: the sum of their waves, squared, over their number."""
    power = np.empty(len(frequencies))
    for row, frequency in enumerate(frequencies):
        power[row] = abs(np.exp(-2j * np.pi * np.mod(points @ frequency, 1.0)).sum()) ** 2 / len(points)
    return power
