# SPDX-License-Identifier: Apache-2.0
"""The same photons twice, as the program's map and as its twins' arrays: flat, tilted, on a sphere, in layers."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

import photonloupe as pl
from relax_twins import Photons, make_photons

Doubles = NDArray[np.float64]
Places = tuple[Doubles, Doubles]

UP = (0.0, 1.0, 0.0)
# A plane along no axis, through no axis.
TILT = np.array([0.3, 0.8, 0.52])
# Every so many photons one has no parameters.
UNSET_EVERY = 17
# Bounds of parameters that lie between 0 and 1, the last of which repeats.
UNIT = (0.0, 1.0)


@dataclass(frozen=True)
class Pair:
    """What the program relaxes and what its twins do."""

    program: pl.PhotonMap
    twin: Photons


def make_pair(
    positions: ArrayLike,
    normals: ArrayLike = UP,
    *,
    emitter: ArrayLike | None = None,
    parameters: ArrayLike | None = None,
    bounds: ArrayLike | None = None,
    periodic: Sequence[bool] | None = None,
    period: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Pair:
    """Photons of flux 1; the twin starts from the program's 32 bits. One normal serves all."""
    places = np.asarray(positions, dtype=np.float64).reshape(-1, 3)
    facing = np.broadcast_to(np.asarray(normals, dtype=np.float64), places.shape)
    program = pl.PhotonMap.from_arrays(positions=places, normals=facing, power=np.ones_like(places), emitter=emitter)
    values, periods = None, None
    if parameters is not None:
        program.set_parameters(parameters, None, bounds, periodic)
        values = program.parameters.astype(np.float64)
        periods = np.array([parameter.period for parameter in program.parameter_list])
    twin = make_photons(
        program.positions.astype(np.float64),
        normals=program.normals.astype(np.float64),
        emitter=program.emitter.astype(np.int64),
        parameters=values,
        periods=periods,
        world_periods=period,
    )
    return Pair(program, twin)


def scatter_flat(count: int, seed: int) -> Places:
    """Random points of the unit square y = 0, denser toward x = 0."""
    flat = np.random.default_rng(seed).random((count, 2)) ** (1.5, 1.0)
    return np.stack([flat[:, 0], np.zeros(count), flat[:, 1]], axis=1), np.tile(UP, (count, 1))


def scatter_tilted(count: int, seed: int) -> Places:
    """The same on a plane that no axis lies in."""
    flat, _ = scatter_flat(count, seed)
    normal = TILT / np.linalg.norm(TILT)
    across = np.cross(normal, (1.0, 0.0, 0.0))
    across /= np.linalg.norm(across)
    along = np.cross(normal, across)
    return flat[:, :1] * along + flat[:, 2:] * across + (0.1, -0.2, 0.3), np.tile(normal, (count, 1))


def scatter_sphere(count: int, seed: int) -> Places:
    """Random points of the unit sphere about the origin."""
    directions = np.random.default_rng(seed).normal(size=(count, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return directions, directions


def scatter_lit_sphere(count: int, seed: int) -> Places:
    """The same with an edge: a fifth of the density below the equator."""
    rng = np.random.default_rng(seed + 1)
    directions, _ = scatter_sphere(4 * count, seed)
    kept = directions[(directions[:, 1] > 0.0) | (rng.random(4 * count) < 0.2)][:count]
    return kept, kept


SHAPES: dict[str, Callable[[int, int], Places]] = {
    "flat": scatter_flat,
    "tilted": scatter_tilted,
    "sphere": scatter_lit_sphere,
}


def make_layers(shape: str, count: int, seed: int = 0, *, dimensions: int = 2) -> Pair:
    """Photons of two emitters with random parameters, the last one periodic; some photons have none."""
    rng = np.random.default_rng(seed + 1000)
    values = rng.random((count, dimensions))
    values[::UNSET_EVERY] = np.nan
    flags = [False] * (dimensions - 1) + [True]
    return make_pair(
        *SHAPES[shape](count, seed),
        emitter=rng.integers(0, 2, count),
        parameters=values,
        bounds=[UNIT] * dimensions,
        periodic=flags,
    )
