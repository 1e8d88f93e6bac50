# SPDX-License-Identifier: Apache-2.0
"""Builds bars: a convex outline with rounded corners, drawn along z, its ends rounded too; all normals are exact."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from gltf import Mesh

Doubles = NDArray[np.float64]

# Two arcs that touch share a point; what is nearer than this is one.
SAME_POINT = 1e-9  # m


@dataclass(frozen=True)
class Corner:
    """A corner of an outline, cut off by an arc of `radius` that touches both sides; `segments` facets stand for it."""

    x: float  # m
    y: float  # m
    radius: float  # m
    segments: int


@dataclass(frozen=True)
class Arc:
    """A rounded corner: points `center` + `radius` (cos a, sin a), a from `start` over `turn`, counter-clockwise."""

    center: tuple[float, float]  # m
    radius: float  # m
    start: float  # radians
    turn: float  # radians


def build_arcs(corners: Sequence[Corner]) -> list[Arc]:
    """Arcs of a convex outline given counter-clockwise, one a corner; straight sides run from each to the next."""
    arcs = []
    for i, corner in enumerate(corners):
        before, after = corners[i - 1], corners[(i + 1) % len(corners)]
        arriving = math.atan2(corner.y - before.y, corner.x - before.x)
        leaving = math.atan2(after.y - corner.y, after.x - corner.x)
        turn = (leaving - arriving) % (2.0 * math.pi)
        cut = corner.radius * math.tan(0.5 * turn)
        center = (
            corner.x - cut * math.cos(arriving) - corner.radius * math.sin(arriving),
            corner.y - cut * math.sin(arriving) + corner.radius * math.cos(arriving),
        )
        arcs.append(Arc(center, corner.radius, arriving - 0.5 * math.pi, turn))
    return arcs


def build_outline(corners: Sequence[Corner]) -> tuple[Doubles, Doubles]:
    """Points (n, 2) of the outline, counter-clockwise, and its outward unit normals there (n, 2)."""
    points: list[Doubles] = []
    normals: list[Doubles] = []
    for corner, arc in zip(corners, build_arcs(corners), strict=True):
        angle = arc.start + arc.turn * np.arange(corner.segments + 1) / corner.segments
        outward = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        along = np.array(arc.center) + arc.radius * outward
        shared = bool(points) and float(np.linalg.norm(along[0] - points[-1][-1])) < SAME_POINT
        points.append(along[1:] if shared else along)
        normals.append(outward[1:] if shared else outward)
    return np.concatenate(points), np.concatenate(normals)


def build_bar(corners: Sequence[Corner], half_length: float, end_radius: float, end_segments: int) -> Mesh:
    """Closed bar |z| <= `half_length`; a quarter round of `end_radius`, not above any corner's, leads to its flat ends.

    The surface at angle f of the quarter round is the outline moved inward by (1 - sin f) end_radius, its normal
    (sin f · outline normal, cos f along z): both meet the sides and the ends without a kink.
    """
    outline, outward = build_outline(corners)
    count = len(outline)
    rounds = 0.5 * np.pi * np.arange(end_segments + 1) / end_segments
    sines, cosines = np.sin(rounds), np.cos(rounds)
    # From one flat end over its round to the side, and down the other round.
    rows = [(-1.0, s, c) for s, c in zip(sines, cosines, strict=True)]
    rows += [(1.0, s, c) for s, c in zip(sines[::-1], cosines[::-1], strict=True)]
    positions = []
    normals = []
    for side, sine, cosine in rows:
        z = side * (half_length - end_radius * (1.0 - cosine))
        positions.append(np.column_stack([outline - (1.0 - sine) * end_radius * outward, np.full(count, z)]))
        normals.append(np.column_stack([sine * outward, np.full(count, side * cosine)]))
    here = np.arange(count)
    after = (here + 1) % count
    triangles = []
    for row in range(len(rows) - 1):
        low, high = row * count, (row + 1) * count
        first = np.stack([low + here, low + after, high + after], axis=1)
        second = np.stack([low + here, high + after, high + here], axis=1)
        # The two triangles of a facet stay neighbors in the file.
        triangles.append(np.stack([first, second], axis=1).reshape(-1, 3))
    for row, side in ((0, -1.0), (len(rows) - 1, 1.0)):
        middle = len(rows) * count + (0 if side < 0.0 else 1)
        ring = row * count
        fan = np.stack([np.full(count, middle), ring + here, ring + after], axis=1)
        triangles.append(fan[:, ::-1] if side < 0.0 else fan)
        positions.append(positions[row].mean(axis=0, keepdims=True))
        normals.append(np.array([[0.0, 0.0, side]]))
    return Mesh(np.concatenate(positions), np.concatenate(normals), np.concatenate(triangles))
