# SPDX-License-Identifier: Apache-2.0
"""How much the number of points in small windows varies."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from photonloupe.point_spacing import Doubles, PointDomain

# Points expected in a window: one photon's own area, up to what an estimate gathers.
WINDOW_COUNTS = (1, 4, 16, 64)
# Grids of windows that are counted; a single one could stand in step with points that are a grid themselves.
GRID_SHIFTS = 8
# Roberts' R2 sequence spreads the shifts evenly: powers of 1/p, p the real root of p³ = p + 1.
SHIFT_STEP = np.array((0.7548776662466927, 0.5698402909980532))


def measure_count_variance(domain: PointDomain) -> tuple[Doubles, Doubles]:
    """Measure how the number of points in discs varies.

    Parameters
    ----------
    domain
        At least one point.

    Returns
    -------
    window_count : (w,) float64
        Points that a disc expects: those of 1, 4, 16, 64 of which two discs fit along either side.
    variance : (w,) float64
        Mean of (points in a disc − expected)², over the same for random points.
    """
    count = len(domain.points)
    expected, variance = [], []
    for window_count in WINDOW_COUNTS:
        width = 2.0 * np.sqrt(window_count / (np.pi * count))
        windows = np.floor(domain.sides / width).astype(int)
        if windows.min() < 2:
            break
        if not domain.periodic:
            # Half a window at least is left to shift the grid by.
            windows = np.where(domain.sides - windows * width < width / 2.0, windows - 1, windows)
        counts = np.concatenate([_count_in_grid(domain, width, windows, shift) for shift in range(GRID_SHIFTS)])
        expected.append(float(window_count))
        # Each of `count` random points is in a window with probability p, so the number in it varies by n p (1 − p).
        variance.append(float(np.square(counts - window_count).mean()) / (window_count * (1.0 - window_count / count)))
    return np.array(expected), np.array(variance)


def _count_in_grid(domain: PointDomain, width: float, windows: NDArray[np.int64], shift: int) -> NDArray[np.int64]:
    """Count the points in the discs of a square grid, at one of its shifts."""
    fraction = np.mod(0.5 + shift * SHIFT_STEP, 1.0)
    if domain.periodic:
        local = np.mod(domain.points - fraction, 1.0) * domain.sides
    else:
        local = domain.points * domain.sides - fraction * (domain.sides - windows * width)
    local /= width
    cell = np.floor(local).astype(np.int64)
    offset = local - cell - 0.5
    inside = ((cell >= 0) & (cell < windows)).all(axis=1) & (np.einsum("ij,ij->i", offset, offset) <= 0.25)
    return np.bincount(cell[inside, 0] * windows[1] + cell[inside, 1], minlength=int(windows.prod()))
