# SPDX-License-Identifier: Apache-2.0
"""Sets of points whose noise is known: lattices, jittered grids, discs thrown like darts, relaxed points."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]


def make_random(count: int, seed: int = 0) -> Doubles:
    return np.random.default_rng(seed).random((count, 2))


def make_hexagons(columns: int, rows: int) -> tuple[Doubles, Doubles]:
    """A hexagonal lattice of spacing 1 and its period; `rows` is even."""
    x, y = np.meshgrid(np.arange(columns, dtype=float), np.arange(rows, dtype=float))
    points = np.stack([x + 0.5 * (y % 2), y * np.sqrt(0.75)], axis=-1).reshape(-1, 2)
    return points, np.array([columns, rows * np.sqrt(0.75)])


def make_jittered(side: int, seed: int = 0) -> Doubles:
    """One random point in each cell of a grid."""
    cells = np.stack(np.meshgrid(np.arange(side), np.arange(side)), axis=-1).reshape(-1, 2)
    return (cells + make_random(side * side, seed)) / side


def measure_wrapped(points: Doubles, point: Doubles) -> Doubles:
    """Distances from one point to others in the periodic unit square."""
    away = np.abs(points - point)
    return np.linalg.norm(np.minimum(away, 1.0 - away), axis=1)


def throw_darts(radius: float, tries: int, seed: int = 0) -> Doubles:
    """Poisson discs: random points of which each is dropped that lies within `radius` of an earlier one."""
    darts, kept = make_random(tries, seed), np.empty((0, 2))
    for dart in darts:
        if (measure_wrapped(kept, dart) >= radius).all():
            kept = np.vstack([kept, dart])
    return kept


def relax_points(count: int, *, steps: int = 20, reach: tuple[float, float] = (1.2, 2.0), seed: int = 0) -> Doubles:
    """Random points after the steps of Spencer and Jones, "Into the Blue" (2009), without the migration limiter."""
    points, neighbors = make_random(count, seed), 6
    for step in range(steps):
        tau = reach[0] + (reach[1] - reach[0]) * np.exp(-6.0 * (step / steps) ** 2)
        offset = np.mod(points[:, None] - points + 0.5, 1.0) - 0.5
        distance = np.linalg.norm(offset, axis=2)
        order = np.argsort(distance, axis=1)[:, 1 : neighbors + 2]  # the first is the point itself
        near = np.take_along_axis(distance, order, axis=1)
        radius, near = tau * near[:, -1:], near[:, :-1]
        away = np.take_along_axis(offset, order[:, :-1, None], axis=1)
        points = np.mod(points + ((radius / near - near / radius)[:, :, None] * away).mean(axis=1), 1.0)
    return points
