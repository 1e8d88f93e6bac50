# SPDX-License-Identifier: Apache-2.0
"""How far apart points in a rectangle are at least, exactly."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]
Keys = NDArray[np.uint64]

# Images just past the border are kept although rounding may put them a little farther.
BORDER_SLACK = 1.0 + 1e-6
# A cell of the search grid that holds more points proves that some are much closer than it is wide.
CROWD = 16
# Share of the extent below which cells are not refined: finer than doubles tell points apart.
FINEST_CELL = 2.0**-50
# Spreads the columns of cells over 64 bits (2^64 over the golden ratio); those that meet cost time only.
COLUMN_KEY = np.uint64(0x9E3779B97F4A7C15)
# A cell and half of its neighbors: the other half sees the pair from the other side.
NEIGHBOR_CELLS = ((0, 0), (0, 1), (1, -1), (1, 0), (1, 1))


@dataclass(frozen=True)
class PointDomain:
    """Points in a rectangle of area 1.

    Attributes
    ----------
    points
        (n, 2) in sides of the rectangle, [0, 1].
    sides
        Lengths of the sides; their product is 1.
    periodic
        Whether the points repeat beyond the rectangle.
    """

    points: Doubles
    sides: Doubles
    periodic: bool


def compute_packing_distance(count: int) -> float:
    """Return the distance in a hexagonal lattice of `count` points per unit area: 2 r_max = √(2/(√3 n))."""
    return float(np.sqrt(2.0 / (np.sqrt(3.0) * count)))


def find_least_distance(domain: PointDomain) -> float:
    """Find the distance of the closest two points, images of a periodic domain included.

    Parameters
    ----------
    domain
        At least two points, or one of a periodic domain.

    Returns
    -------
    float
        In the unit of ``domain.sides``.
    """
    points = domain.points * domain.sides
    if domain.periodic:
        points = _append_images(points, domain.sides)
    points = points[np.lexsort(points.T)]
    if (points[1:] == points[:-1]).all(axis=1).any():
        return 0.0
    keys = _choose_cells(points)
    order = np.argsort(keys)
    points, keys = points[order], keys[order]
    least = np.inf
    for i, j in _list_pairs(keys):
        offset = points[i] - points[j]
        least = min(least, float(np.einsum("ij,ij->i", offset, offset).min()))
    return float(np.sqrt(least))


def _append_images(points: Doubles, sides: Doubles) -> Doubles:
    """Append the images that lie near enough to the rectangle to be a point's nearest."""
    # No set has all its points farther apart than the densest packing, nor than a point is from its own image.
    border = min(compute_packing_distance(len(points)), float(sides.min())) * BORDER_SLACK
    images = [points]
    for x in (-1, 0, 1):
        for y in (-1, 0, 1):
            if x == y == 0:
                continue
            image = points + (x, y) * sides
            near = ((image >= -border) & (image <= sides + border)).all(axis=1)
            images.append(image[near])
    return np.concatenate(images)


def _choose_cells(points: Doubles) -> Keys:
    """Return each point's cell in a grid as wide as the least distance at least, with few points in a cell."""
    local = points - points.min(axis=0)
    extent = float(local.max(axis=0).sum())
    width = extent
    while True:
        cells = np.floor(local / width).astype(np.int64).astype(np.uint64)
        keys = cells[:, 0] * COLUMN_KEY + cells[:, 1]
        crowd = int(np.unique(keys, return_counts=True)[1].max())
        if crowd <= CROWD or width <= FINEST_CELL * extent:
            return keys
        # Discs about m points at distance d, in a square of side w + d, are no denser than the hexagonal packing:
        # m d² √3/2 ≤ (w + d)².
        width = max(width / (np.sqrt(np.sqrt(0.75) * crowd) - 1.0), FINEST_CELL * extent)


def _list_pairs(keys: Keys) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp]]]:
    """Yield the pairs of points in the same or in neighboring cells, given in the order of their keys."""
    rows = np.arange(len(keys))
    for column, row in NEIGHBOR_CELLS:
        other = keys + np.uint64(column) * COLUMN_KEY + np.uint64(row % 2**64)
        first = np.searchsorted(keys, other) if column or row else rows + 1
        last = np.searchsorted(keys, other, side="right")
        for step in range(min(int((last - first).max()), CROWD)):
            there = first + step < last
            if there.any():
                yield rows[there], first[there] + step
