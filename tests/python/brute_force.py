# SPDX-License-Identifier: Apache-2.0
"""An independent tracer of exact cylinders and planes in NumPy: slow, plain, and the judge of the oracles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]

# Leaves the surface just hit behind; small against the scenes, large against a double's spacing.
_OFFSET = 1e-9


@dataclass(frozen=True)
class Landings:
    """Where rays landed: (n, 2) floor points, (n,) reflections met, (n, 3) share left, of `emitted` rays."""

    points: Doubles
    bounces: NDArray[np.int64]
    share: Doubles
    emitted: int


def sample_directions(count: int, seed: int) -> Doubles:
    """Isotropic unit vectors, (count, 3)."""
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def trace_cylinder(
    radius: float,
    wall_height: float,
    light: tuple[float, float, float],
    color: tuple[float, float, float],
    *,
    count: int,
    seed: int,
    max_bounces: int = 64,
) -> Landings:
    """Follow isotropic rays between a mirror wall (both faces) and the floor y = 0."""
    position = np.tile(np.array(light), (count, 1))
    direction = sample_directions(count, seed)
    share = np.ones((count, 3))
    bounces = np.zeros(count, dtype=np.int64)
    landed: list[tuple[Doubles, NDArray[np.int64], Doubles]] = []
    for _ in range(max_bounces + 1):
        with np.errstate(divide="ignore", invalid="ignore"):
            to_floor = np.where(direction[:, 1] < 0.0, -position[:, 1] / direction[:, 1], np.inf)
        to_wall = _meet_wall(position, direction, radius, wall_height)
        on_floor = to_floor < to_wall
        place = position[on_floor] + to_floor[on_floor, None] * direction[on_floor]
        landed.append((place[:, [0, 2]], bounces[on_floor], share[on_floor]))
        going = ~on_floor & np.isfinite(to_wall)
        position = position[going] + to_wall[going, None] * direction[going]
        direction, share, bounces = direction[going], share[going], bounces[going] + 1
        normal = position * np.array([1.0, 0.0, 1.0]) / radius
        cosine = np.sum(direction * normal, axis=1, keepdims=True)
        direction = direction - 2.0 * cosine * normal
        share = share * (np.array(color) + (1.0 - np.array(color)) * (1.0 - np.abs(cosine)) ** 5)
    parts = [np.concatenate(part) for part in zip(*landed, strict=True)]
    return Landings(parts[0], parts[1], parts[2], count)


def _meet_wall(position: Doubles, direction: Doubles, radius: float, wall_height: float) -> Doubles:
    """Distance to the nearest point of the sheet, inf where there is none."""
    a = direction[:, 0] ** 2 + direction[:, 2] ** 2
    b = position[:, 0] * direction[:, 0] + position[:, 2] * direction[:, 2]
    c = position[:, 0] ** 2 + position[:, 2] ** 2 - radius**2
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(b**2 - a * c)
        nearest = np.full(len(a), np.inf)
        for distance in ((-b + root) / a, (-b - root) / a):  # the nearer one last
            height = position[:, 1] + distance * direction[:, 1]
            hit = (distance > _OFFSET) & (height >= 0.0) & (height <= wall_height)
            nearest = np.where(hit, distance, nearest)
    return nearest


def trace_slab(
    slab_bottom: float, slab_top: float, ior: float, light_height: float, *, count: int, seed: int
) -> Landings:
    """Follow isotropic rays through an endless slab onto the floor y = 0, refracted twice."""
    direction = sample_directions(count, seed)
    direction = direction[direction[:, 1] < 0.0]
    position = np.tile(np.array([0.0, light_height, 0.0]), (len(direction), 1))
    share = np.ones(len(direction))
    for level, eta in ((slab_top, 1.0 / ior), (slab_bottom, ior)):
        position = position + direction * ((level - position[:, 1]) / direction[:, 1])[:, None]
        cosine = -direction[:, 1]
        refracted = direction * eta
        refracted[:, 1] = -np.sqrt(1.0 - eta**2 * (1.0 - cosine**2))
        share *= _pass_share(cosine, -refracted[:, 1], eta)
        direction = refracted
    position = position + direction * (-position[:, 1] / direction[:, 1])[:, None]
    return Landings(position[:, [0, 2]], np.full(len(share), 2), np.repeat(share[:, None], 3, axis=1), count)


def _pass_share(cos_from: Doubles, cos_to: Doubles, eta: float) -> Doubles:
    """Transmitted share of unpolarized light, from the amplitudes of what passes; eta is n_from / n_to."""
    perpendicular = 2.0 * eta * cos_from / (eta * cos_from + cos_to)
    parallel = 2.0 * eta * cos_from / (cos_from + eta * cos_to)
    return 0.5 * (perpendicular**2 + parallel**2) * cos_to / (eta * cos_from)
