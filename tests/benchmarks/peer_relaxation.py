# SPDX-License-Identifier: Apache-2.0
"""Relaxation as a researcher writes it: SciPy's cKDTree, built anew for every step, and the push in parallel Numba."""

from __future__ import annotations

import math

import numba
import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

Doubles = NDArray[np.float64]

# METHODS section 3, equations 1 and 2.
SOFTENING = 1e-12
SCHEDULE = 6.0


@numba.njit(parallel=True)
def push(
    positions: Doubles, normals: Doubles, distances: Doubles, ids: NDArray[np.int64], over_relaxation: float
) -> Doubles:
    """Move every photon in its tangent plane; a row of `ids` holds K + 2, the photon itself among them."""
    count, neighbors = len(positions), ids.shape[1] - 2
    moved = np.empty_like(positions)
    for i in numba.prange(count):
        radius = distances[i, neighbors + 1]
        reach = radius * over_relaxation
        x = y = z = 0.0
        for place in range(neighbors + 1):
            j = ids[i, place]
            if j == i:
                continue
            distance = distances[i, place]
            strength = reach / (distance + SOFTENING * radius) - distance / reach
            x += strength * (positions[i, 0] - positions[j, 0])
            y += strength * (positions[i, 1] - positions[j, 1])
            z += strength * (positions[i, 2] - positions[j, 2])
        outward = x * normals[i, 0] + y * normals[i, 1] + z * normals[i, 2]
        moved[i, 0] = positions[i, 0] + (x - outward * normals[i, 0]) / neighbors
        moved[i, 1] = positions[i, 1] + (y - outward * normals[i, 1]) / neighbors
        moved[i, 2] = positions[i, 2] + (z - outward * normals[i, 2]) / neighbors
    return moved


def relax_with_scipy(
    positions: Doubles, normals: Doubles, *, neighbors: int, steps: int, over_relaxation: tuple[float, float]
) -> Doubles:
    """Positions after all steps, (n, 3): no limiter, no constraint, every photon on an endless plane."""
    most, least = over_relaxation
    for step in range(steps):
        distances, ids = cKDTree(positions).query(positions, neighbors + 2, workers=-1)
        factor = least + (most - least) * math.exp(-SCHEDULE * step**2 / steps**2)
        positions = push(positions, normals, distances, ids, factor)
    return positions
