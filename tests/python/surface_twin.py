# SPDX-License-Identifier: Apache-2.0
"""Naive twin of irradiance (METHODS section 2) in double precision, and the bounds that 32-bit offsets leave it.

A photon counts where n_i·n > 0.7; its measure is the square of the smallest radius whose ball takes it in,
max(d², (n·(x_i − x)/0.1)²). The k + 1st smallest measure is r², the k before it are used; of those that tie the ones
with the smaller d², then with the smaller id, come first. The kernel `disc` takes the k-th as r² and uses it too.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

import photonloupe as pl
from twins import MAX_HEIGHT_SHARE, MIN_NORMAL_COSINE, PAST_THE_FARTHEST, weigh

Doubles = NDArray[np.float64]
Ids = NDArray[np.int64]

# A radius that floats cannot tell from 0, as a share of the query's coordinates, and at least (shaders' density.glsl).
FLOAT_EPSILON = 2.0**-23
SMALLEST_RADIUS = 1e-15
# A map farther from the origin than so many of its radii is kept relative to its center (engine, map_columns.cpp).
FAR_RADII = 8.0
# Errors of 32 bits: of a distance and a height, as a share of the distance; of a weight, as a share of its peak.
OFFSET_ERROR, WEIGHT_ERROR = 4.0 * 2.0**-24, 4e-6
# Errors of the measure cannot carry a photon from so far beyond the last one used.
SURELY_BEYOND = 1.0 + 100.0 * OFFSET_ERROR


@dataclass(frozen=True)
class Estimate:
    """Irradiance (n, 3): exact, the bounds when rounding decides who is used, and the flux used over π r²."""

    exact: Doubles
    least: Doubles
    most: Doubles
    flat: Doubles


@dataclass(frozen=True)
class View:
    """What may count for one query: fluxes (m, 3) by ascending id, squared distances, heights above its plane."""

    power: Doubles
    squares: Doubles
    heights: Doubles

    def find_measures(self, error: float = 0.0) -> Doubles:
        """Measures, with distances and heights wrong by `error` of the distance."""
        away = np.sqrt(self.squares)
        height = np.maximum(np.abs(self.heights) + error * away, 0.0)
        return np.maximum(away * (1.0 + error), height / MAX_HEIGHT_SHARE) ** 2


def choose_center(positions: Doubles) -> Doubles:
    """Where the program counts a map's coordinates from."""
    if len(positions) == 0:
        return np.zeros(3)
    low, high = positions.min(axis=0), positions.max(axis=0)
    center = 0.5 * (low + high)
    return center if np.linalg.norm(center) > FAR_RADII * 0.5 * np.linalg.norm(high - low) else np.zeros(3)


def round_floats(values: ArrayLike) -> Doubles:
    """What 32 bits keep of values."""
    return np.asarray(values, dtype=np.float64).astype(np.float32).astype(np.float64)


def find_square_radius(measures: Doubles, k: int, kernel: str) -> float:
    """r² of any number of measures."""
    place = min(k if kernel != "disc" else k - 1, len(measures) - 1)
    square = float(np.partition(measures, place)[place])
    return square * PAST_THE_FARTHEST**2 if kernel != "disc" and len(measures) <= k else square


def find_contributions(view: View, square: float, used: int, kernel: str) -> Doubles:
    """What each photon gives, (m, 3), W/m², if it is one of those used."""
    if kernel == "disc":
        weights = np.full(len(view.squares), (used - 1) / used)
    else:
        weights = weigh(kernel, np.sqrt(np.minimum(view.squares / square, 1.0)))
    return weights[:, None] * view.power / (np.pi * square)


def estimate_exactly(view: View, k: int, kernel: str, spacing: float) -> tuple[Doubles, Doubles]:
    """Irradiance of one query, and the flux used over π r², (3,) each."""
    measures = view.find_measures()
    square = max(find_square_radius(measures, k, kernel), spacing**2)
    used = np.lexsort((view.squares, measures))[:k]  # the sort is stable: ids decide what is left
    contributions = find_contributions(view, square, len(used), kernel)
    return contributions[used].sum(axis=0), view.power[used].sum(axis=0) / (np.pi * square)


def find_bounds(view: View, k: int, kernel: str, spacing: float) -> tuple[Doubles, Doubles]:
    """Least and greatest irradiance (3,) when every distance and height may be wrong by its error."""
    low, high = view.find_measures(-OFFSET_ERROR), view.find_measures(OFFSET_ERROR)
    used = min(k, len(low))
    surely = high < np.partition(low, used - 1)[used - 1]
    maybe = ~surely & (low <= np.partition(high, used - 1)[used - 1])
    places = used - np.count_nonzero(surely)
    sums = []
    for measures in (low, high):
        square = max(find_square_radius(measures, k, kernel), spacing**2)
        contributions = find_contributions(view, square, used, kernel)
        ranked = np.sort(contributions[maybe], axis=0)
        base = contributions[surely].sum(axis=0)
        sums += [base + ranked[:places].sum(axis=0), base + ranked[len(ranked) - places :].sum(axis=0)]
    return np.min(sums, axis=0), np.max(sums, axis=0)


def look(positions: Doubles, normals: Doubles, power: Doubles, point: Doubles, normal: Doubles, k: int) -> View:
    """Photons of the query's surface, less those whose measure is surely too great; positions and normals (3, n)."""
    x, y, z = (coordinates - place for coordinates, place in zip(positions, point, strict=True))
    squares, heights = x * x + y * y + z * z, normal[0] * x + normal[1] * y + normal[2] * z
    measures = np.maximum(squares, (heights / MAX_HEIGHT_SHARE) ** 2)
    measures[normal @ normals <= MIN_NORMAL_COSINE] = np.inf
    last = np.partition(measures, k)[k] if len(measures) > k else np.inf
    near = np.flatnonzero((measures <= last * SURELY_BEYOND) & np.isfinite(measures))
    return View(power[near], squares[near], heights[near])


def estimate_irradiance(
    photons: pl.PhotonMap, points: ArrayLike, normals: ArrayLike, k: int, kernel: str = "epanechnikov"
) -> Estimate:
    """Irradiance at points (n, 3) with normals (n, 3) or (3,), one point at a time."""
    center = choose_center(photons.positions.astype(np.float64))
    positions = np.ascontiguousarray(round_floats(photons.positions - center).T)
    facing, power = np.ascontiguousarray(photons.normals.astype(np.float64).T), photons.power.astype(np.float64)
    places = round_floats(np.asarray(points, dtype=np.float64) - center)
    directions = np.broadcast_to(np.asarray(normals, dtype=np.float64), places.shape)
    directions = round_floats(directions / np.linalg.norm(directions, axis=1, keepdims=True))
    found = Estimate(*(np.zeros(places.shape) for _ in range(4)))
    for row, (point, normal) in enumerate(zip(places, directions, strict=True)):
        view = look(positions, facing, power, point, normal, k)
        if len(view.squares) == 0:
            continue
        spacing = max(float(np.abs(point).max()) * FLOAT_EPSILON, SMALLEST_RADIUS)
        found.exact[row], found.flat[row] = estimate_exactly(view, k, kernel, spacing)
        found.least[row], found.most[row] = find_bounds(view, k, kernel, spacing)
    return found


def check_irradiance(
    photons: pl.PhotonMap,
    points: ArrayLike,
    normals: ArrayLike,
    k: int,
    kernel: str = "epanechnikov",
    *,
    exact: bool = True,
    rtol: float = 2e-4,
) -> None:
    """Assert that the program's estimate is the twin's; where heights are rounded, that it lies within the bounds."""
    found = photons.irradiance(points, normals, k=k, kernel=kernel)
    assert np.isfinite(found).all()
    twin = estimate_irradiance(photons, points, normals, k, kernel)
    least, most = (twin.exact, twin.exact) if exact else (twin.least, twin.most)
    slack = rtol * most + np.maximum(1e-6 * twin.exact.max(initial=0.0), WEIGHT_ERROR * twin.flat)
    wrong = (found < least - slack) | (found > most + slack)
    rows = np.flatnonzero(wrong.any(axis=1))
    examples = [f"row {row}: {found[row]} is not {least[row]} … {most[row]}" for row in rows[:5]]
    assert len(rows) == 0, f"{len(rows)} of {len(found)} estimates are wrong: {'; '.join(examples)}"
