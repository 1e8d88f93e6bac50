# SPDX-License-Identifier: Apache-2.0
"""Turns profiles about the y axis: an open chain of straight sides with rounded corners, both ends on the axis."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from extrusion import Corner
from gltf import Mesh

Doubles = NDArray[np.float64]


@dataclass(frozen=True)
class Profile:
    """Points (n, 2) of a profile, distance from the axis and height, and the outward unit normals there (n, 2).

    The first and the last point lie on the axis; the solid is on the left of the way from one to the other.
    """

    points: Doubles  # m
    normals: Doubles


def round_corner(before: Corner, corner: Corner, after: Corner) -> Profile:
    """The arc that takes a corner's place, a turn to either side; no vertex where it does not turn."""
    arriving = math.atan2(corner.y - before.y, corner.x - before.x)
    leaving = math.atan2(after.y - corner.y, after.x - corner.x)
    turn = math.remainder(leaving - arriving, 2.0 * math.pi)
    side = math.copysign(1.0, turn)  # 1: the center lies on the left, in the solid
    cut = corner.radius * math.tan(0.5 * abs(turn))
    for other in (before, after):
        if cut > math.hypot(corner.x - other.x, corner.y - other.y):
            raise ValueError(f"an arc of radius {corner.radius} does not fit the corner at ({corner.x}, {corner.y})")
    start = np.array([corner.x - cut * math.cos(arriving), corner.y - cut * math.sin(arriving)])
    center = start + side * corner.radius * np.array([-math.sin(arriving), math.cos(arriving)])
    heading = arriving + turn * np.arange(corner.segments + 1) / corner.segments
    outward = np.stack([np.sin(heading), -np.cos(heading)], axis=1)
    return Profile(center + side * corner.radius * outward, outward)


def build_profile(corners: Sequence[Corner]) -> Profile:
    """Profile from a corner on the axis to another; at both its ends it must be at a right angle to the axis."""
    parts = [round_corner(*three) for three in zip(corners, corners[1:], corners[2:], strict=False)]
    ends = [np.array([[0.0, corner.y]]) for corner in (corners[0], corners[-1])]
    down, up = (np.array([[0.0, side]]) for side in (-1.0, 1.0))
    points = np.concatenate([ends[0], *(part.points for part in parts), ends[1]])
    normals = np.concatenate([down, *(part.normals for part in parts), up])
    return Profile(points, normals)


def turn_profile(profile: Profile, segments: int) -> Mesh:
    """Closed surface of revolution about +y, a pole at either end; every normal is that of the turned curve."""
    rows = len(profile.points) - 2
    angle = 2.0 * np.pi * np.arange(segments) / segments
    around = np.stack([np.cos(angle), np.sin(angle)], axis=1)

    def spin(curve: Doubles) -> Doubles:
        across = curve[1:-1, None, :1] * around
        along = np.broadcast_to(curve[1:-1, None, 1:], (rows, segments, 1))
        rings = np.concatenate([across[..., :1], along, across[..., 1:]], axis=2).reshape(-1, 3)
        poles = np.array([[0.0, curve[0, 1], 0.0], [0.0, curve[-1, 1], 0.0]])
        return np.concatenate([rings, poles])

    here = np.arange(segments)
    after = (here + 1) % segments
    triangles = [np.stack([np.full(segments, rows * segments), here, after], axis=1)]
    for row in range(rows - 1):
        low, high = row * segments, (row + 1) * segments
        first = np.stack([low + here, high + here, high + after], axis=1)
        second = np.stack([low + here, high + after, low + after], axis=1)
        # The two triangles of a facet stay neighbors in the file.
        triangles.append(np.stack([first, second], axis=1).reshape(-1, 3))
    last = (rows - 1) * segments
    triangles.append(np.stack([np.full(segments, rows * segments + 1), last + after, last + here], axis=1))
    return Mesh(spin(profile.points), spin(profile.normals), np.concatenate(triangles))


def build_ball(radius: float, rows: int, segments: int) -> Mesh:
    """Ball about the origin, of `rows` rows between its poles."""
    polar = np.pi * np.arange(rows + 1) / rows
    outward = np.stack([np.sin(polar), -np.cos(polar)], axis=1)
    return turn_profile(Profile(radius * outward, outward), segments)
