# SPDX-License-Identifier: Apache-2.0
"""Maps whose photons lie on surfaces that are hard to tell apart, and places to ask them about."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl

Doubles = NDArray[np.float64]
Places = tuple[Doubles, Doubles]
Random = np.random.Generator

UP = np.array([0.0, 1.0, 0.0])
RISERS = (0.005, 0.02, 0.08, 0.3, 0.15)  # m
NEAR_PLANES = 1e-4  # m
# How far away is far, in extents of the map.
FAR = 1e4


def spread_flat(count: int, random: Random, origin: Doubles, first: Doubles, second: Doubles) -> Places:
    """Random places of a parallelogram, and its normal, first × second."""
    share = random.random((count, 2))
    normal = np.cross(first, second)
    return origin + share @ np.stack([first, second]), np.tile(normal / np.linalg.norm(normal), (count, 1))


def join(*parts: Places) -> Places:
    """Photons of several surfaces, one after the other."""
    return np.concatenate([each[0] for each in parts]), np.concatenate([each[1] for each in parts])


def lay_floor(count: int, random: Random, height: float = 0.0, side: float = 1.0) -> Places:
    """A square floor that faces up."""
    origin = np.array([0.0, height, 0.0])
    return spread_flat(count, random, origin, np.array([0.0, 0.0, side]), np.array([side, 0.0, 0.0]))


def make_stairs(count: int, random: Random) -> Places:
    """Treads 1 m deep, and risers that face −x."""
    parts, height = [], 0.0
    share = count // (2 * len(RISERS))
    for step, riser in enumerate(RISERS):
        origin = np.array([float(step), height, 0.0])
        parts.append(spread_flat(share, random, origin, np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])))
        edge = np.array([step + 1.0, height, 0.0])
        parts.append(spread_flat(share, random, edge, np.array([0.0, 0.0, 1.0]), np.array([0.0, riser, 0.0])))
        height += riser
    return join(*parts)


def make_cube(count: int, random: Random) -> Places:
    """Six faces, outward."""
    places = random.random((count, 3))
    axis, side = random.integers(0, 3, count), random.integers(0, 2, count)
    rows = np.arange(count)
    places[rows, axis] = side
    normals = np.zeros((count, 3))
    normals[rows, axis] = 2.0 * side - 1.0
    return places, normals


def make_corner(count: int, random: Random) -> Places:
    """Floor and two walls of a room."""
    places, normals = random.random((count, 3)), np.zeros((count, 3))
    rows, axis = np.arange(count), random.integers(0, 3, count)
    places[rows, axis] = 0.0
    normals[rows, axis] = 1.0
    return places, normals


def make_facing_planes(count: int, random: Random) -> Places:
    """Two planes a tenth of a millimeter apart that look at each other."""
    low, high = lay_floor(count // 2, random), lay_floor(count // 2, random, NEAR_PLANES)
    return join(low, (high[0], -high[1]))


def make_stacked_planes(count: int, random: Random) -> Places:
    """Two planes a tenth of a millimeter apart that both face up."""
    return join(lay_floor(count // 2, random), lay_floor(count // 2, random, NEAR_PLANES))


def make_two_sided_sheet(count: int, random: Random) -> Places:
    """One plane, photons on both of its sides, 99 to 1."""
    places, normals = lay_floor(count, random)
    normals[::100] *= -1.0
    return places, normals


def make_wide_floor(count: int, random: Random) -> Places:
    """Nine tenths in a caustic 1 m wide, the rest over 3 km."""
    places, normals = lay_floor(count, random, side=3_000.0)
    places[: 9 * count // 10, [0, 2]] = 1_500.0 + random.random((9 * count // 10, 2))
    return places, normals


def make_point(count: int, _: Random) -> Places:
    """All in one place."""
    return np.tile([0.3, 0.1, -0.2], (count, 1)), np.tile(UP, (count, 1))


def make_line(count: int, random: Random) -> Places:
    """All on the x axis."""
    return random.random((count, 1)) * [1.0, 0.0, 0.0], np.tile(UP, (count, 1))


def make_tilted_planes(count: int, random: Random) -> Places:
    """Two planes that cross at one degree, neither along an axis."""
    parts = []
    for turn in np.radians([10.0, 11.0]):
        along = np.array([np.cos(turn), np.sin(turn), 0.3])
        across = np.array([-0.2, 0.1, -1.0])
        parts.append(spread_flat(count // 2, random, -0.5 * (along + across), along, -across))
    places, normals = join(*parts)
    return places, normals * np.sign(normals[:, 1:2])


def make_sphere(count: int, random: Random) -> Places:
    """The unit sphere, outward."""
    normals = random.normal(size=(count, 3))
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals, normals


def make_noise_normals(count: int, random: Random) -> Places:
    """A floor whose normals point anywhere."""
    return lay_floor(count, random)[0], make_sphere(count, random)[1]


def repeat_floor(times: int) -> Callable[[int, Random], Places]:
    """A floor each of whose photons is there so many times."""

    def make(count: int, random: Random) -> Places:
        places, normals = lay_floor(max(1, count // times), random)
        return np.repeat(places, times, axis=0), np.repeat(normals, times, axis=0)

    return make


@dataclass(frozen=True)
class Kind:
    """A way to place photons; along the axes heights have no rounding errors, and who ties really ties."""

    make: Callable[[int, Random], Places]
    along_axes: bool = True


KINDS = {
    "stairs": Kind(make_stairs),
    "cube": Kind(make_cube),
    "corner": Kind(make_corner),
    "facing planes": Kind(make_facing_planes),
    "stacked planes": Kind(make_stacked_planes),
    "two-sided sheet": Kind(make_two_sided_sheet),
    "wide floor": Kind(make_wide_floor, along_axes=False),  # so wide that squared distances are rounded to metres
    "one point": Kind(make_point),
    "one line": Kind(make_line),
    "tilted planes": Kind(make_tilted_planes, along_axes=False),
    "sphere": Kind(make_sphere, along_axes=False),
    "noise normals": Kind(make_noise_normals, along_axes=False),
    "each twice": Kind(repeat_floor(2)),
    "each 1000 times": Kind(repeat_floor(1000)),
}


def build_map(name: str, count: int, seed: int = 0) -> pl.PhotonMap:
    """Photons of unequal flux."""
    random = np.random.default_rng(seed)
    positions, normals = KINDS[name].make(count, random)
    power = (0.1 + random.random((len(positions), 3))) / len(positions)
    return pl.PhotonMap.from_arrays(positions=positions, normals=normals, power=power)


def find_extent(photons: pl.PhotonMap) -> float:
    """Longest side of the box about all photons, 1 m for a point."""
    return float(np.ptp(photons.positions, axis=0).max()) or 1.0


def pick(photons: pl.PhotonMap, count: int, seed: int) -> Places:
    """Places and normals of some photons."""
    rows = np.random.default_rng(seed).integers(0, len(photons), count)
    return photons.positions[rows].astype(np.float64), photons.normals[rows].astype(np.float64)


def ask_on_surfaces(photons: pl.PhotonMap, count: int) -> Places:
    """At photons, and beside them in their planes."""
    places, normals = pick(photons, count, 1)
    apart = np.random.default_rng(2).normal(size=places.shape) * find_extent(photons) / np.sqrt(len(photons))
    apart -= np.sum(apart * normals, axis=1, keepdims=True) * normals
    apart[::2] = 0.0
    return places + apart, normals


def ask_between_surfaces(photons: pl.PhotonMap, count: int) -> Places:
    """Above and below the surfaces, from a little to a third of the extent."""
    places, normals = pick(photons, count, 3)
    extent = find_extent(photons)
    spacing = extent / np.sqrt(len(photons))
    heights = np.resize([0.05 * spacing, -0.5 * spacing, 0.03 * extent, 0.3 * extent], count)
    return places + heights[:, None] * normals, normals


def ask_far_away(photons: pl.PhotonMap, count: int) -> Places:
    """So far that the whole map is a speck."""
    places, normals = pick(photons, count, 4)
    directions = np.random.default_rng(5).normal(size=places.shape)
    directions[::4] = normals[::4]
    directions[1::4] = np.cross(normals[1::4], directions[1::4])  # in the plane of the surface
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    return places + FAR * find_extent(photons) * directions, normals


def ask_at_edges(photons: pl.PhotonMap, count: int) -> Places:
    """Corners, and middles of the edges and faces, of the box about all photons, with photons' normals."""
    low, high = photons.positions.min(axis=0), photons.positions.max(axis=0)
    shares = np.stack(np.meshgrid(*[[0.0, 0.5, 1.0]] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    shares = shares[np.random.default_rng(6).permutation(len(shares))]
    places = low.astype(np.float64) + np.resize(shares, (count, 3)) * (high - low)
    return places, pick(photons, count, 7)[1]


def ask_the_other_side(photons: pl.PhotonMap, count: int) -> Places:
    """On the surfaces, facing the other way."""
    places, normals = ask_on_surfaces(photons, count)
    return places, -normals


QUESTIONS = {
    "on the surfaces": ask_on_surfaces,
    "between the surfaces": ask_between_surfaces,
    "far away": ask_far_away,
    "at the edges": ask_at_edges,
    "on the other side": ask_the_other_side,
}
