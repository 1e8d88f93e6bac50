# SPDX-License-Identifier: Apache-2.0
"""Light through a glass bar that runs along z, in its middle plane z = 0: rays in the plane, in double precision.

The bar's outline is taken as the arcs and lines it is drawn from, not as its facets. A ray that leaves the plane at a
small angle b keeps n·direction_z at every face, so that it lands at z = b · Σ length/index: with the rays' angle in
the plane that gives the irradiance on the line z = 0, y = 0.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from extrusion import Corner, build_arcs

Doubles = NDArray[np.float64]
Ids = NDArray[np.int64]

# A ray that starts on a face must not meet it again at once.
SHORTEST = 1e-9


@dataclass(frozen=True)
class Landings:
    """Where rays reach the floor by one way: all arrays have one row a ray; NaN or 0 where it does not get there."""

    x: Doubles  # m
    share: Doubles  # of the flux that takes this way
    length: Doubles  # m, Σ length/index: dz/db
    faces: Ids  # (rays, faces met): the corner whose arc was met, or the side after it plus the number of corners
    normals: Doubles  # (rays, faces met, 2), outward

    def met(self, *faces: int) -> NDArray[np.bool_]:
        """Rays that met just these faces and reached the floor."""
        return np.isfinite(self.x) & (self.faces == np.array(faces)).all(axis=1)


@dataclass(frozen=True)
class GlassBar:
    """The outline of a convex bar above a floor y = 0, and a point light in its middle plane."""

    corners: Sequence[Corner]
    ior: float
    light: tuple[float, float]  # x, y in m
    intensity: float  # W/sr

    def follow(self, angles: ArrayLike, way: str = "22") -> Landings:
        """Rays that leave the light at `angles` from +x toward +y: 1 reflected, 2 transmitted at each face in turn."""
        angle = np.asarray(angles, dtype=np.float64)
        direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        at = np.tile(np.array(self.light), (len(angle), 1))
        alive = np.ones(len(angle), dtype=bool)
        share, length = np.ones(len(angle)), np.zeros(len(angle))
        inside = False
        faces, normals = [], []
        for interaction in way:
            distance, normal, face = self._meet(at, direction)
            alive &= np.isfinite(distance) & (inside | (distance < _reach_floor(at, direction)))
            distance = np.where(alive, distance, 0.0)
            at = at + distance[:, None] * direction
            length += distance / (self.ior if inside else 1.0)
            faces.append(face)
            normals.append(normal)
            share, direction = self._interact(share, direction, normal, inside, interaction)
            alive &= share > 0.0
            inside ^= interaction == "2"
        distance = _reach_floor(at, direction)
        alive &= np.isfinite(distance) & (distance < self._meet(at, direction)[0]) & (not inside)
        with np.errstate(invalid="ignore"):
            x = at[:, 0] + distance * direction[:, 0]
            length = length + distance
        return Landings(
            x=np.where(alive, x, np.nan),
            share=np.where(alive, share, 0.0),
            length=np.where(alive, length, np.nan),
            faces=np.stack(faces, axis=1),
            normals=np.stack(normals, axis=1),
        )

    def find_cell_irradiance(self, edges: ArrayLike, angles: Sequence[float], way: str = "22", count: int = 400_000):
        """Mean irradiance of each cell of the line z = 0 by one way, W/m²: rays between two angles, midpoint rule."""
        low, high = angles
        step = (high - low) / count
        found = self.follow(low + step * (np.arange(count) + 0.5), way)
        lit = np.isfinite(found.x)
        # Flux I da db over the length dz = length · db.
        flux = self.intensity * step * found.share[lit] / found.length[lit]
        x = np.asarray(edges, dtype=np.float64)
        return np.histogram(found.x[lit], x, weights=flux)[0] / np.diff(x)

    def _interact(
        self, share: Doubles, direction: Doubles, normal: Doubles, inside: bool, interaction: str
    ) -> tuple[Doubles, Doubles]:
        ratio = self.ior if inside else 1.0 / self.ior
        facing = -normal if inside else normal
        cosine = -np.sum(direction * facing, axis=1)
        beyond2 = 1.0 - ratio**2 * (1.0 - cosine**2)
        beyond = np.sqrt(np.maximum(beyond2, 0.0))
        with np.errstate(invalid="ignore", divide="ignore"):
            parallel = (cosine - ratio * beyond) / (cosine + ratio * beyond)
            perpendicular = (ratio * cosine - beyond) / (ratio * cosine + beyond)
        reflected = np.where(beyond2 > 0.0, 0.5 * (parallel**2 + perpendicular**2), 1.0)
        if interaction == "1":
            return share * reflected, direction + 2.0 * cosine[:, None] * facing
        return share * (1.0 - reflected), ratio * direction + (ratio * cosine - beyond)[:, None] * facing

    def _meet(self, at: Doubles, direction: Doubles) -> tuple[Doubles, Doubles, Ids]:
        """Distance to the outline (inf: none), its outward normal there, and the face."""
        best = np.full(len(at), np.inf)
        normal = np.zeros((len(at), 2))
        face = np.full(len(at), -1, dtype=np.int64)
        arcs = build_arcs(self.corners)
        for i, arc in enumerate(arcs):
            offset = at - np.array(arc.center)
            half = np.sum(offset * direction, axis=1)
            square = half**2 - np.sum(offset**2, axis=1) + arc.radius**2
            for sign in (-1.0, 1.0):
                distance = -half + sign * np.sqrt(np.maximum(square, 0.0))
                place = (offset + distance[:, None] * direction) / arc.radius
                turned = (np.arctan2(place[:, 1], place[:, 0]) - arc.start) % (2.0 * np.pi)
                hit = (square > 0.0) & (distance > SHORTEST) & (turned <= arc.turn) & (distance < best)
                best[hit], normal[hit], face[hit] = distance[hit], place[hit], i
            after = arcs[(i + 1) % len(arcs)]
            outward = np.array([np.cos(after.start), np.sin(after.start)])
            start = np.array(arc.center) + arc.radius * outward
            end = np.array(after.center) + after.radius * outward
            along = end - start
            with np.errstate(divide="ignore", invalid="ignore"):
                distance = ((start - at) @ outward) / (direction @ outward)
                share = ((at + distance[:, None] * direction - start) @ along) / (along @ along)
            hit = (distance > SHORTEST) & (share >= 0.0) & (share <= 1.0) & (distance < best)
            best[hit], normal[hit], face[hit] = distance[hit], outward, i + len(arcs)
        return best, normal, face


def _reach_floor(at: Doubles, direction: Doubles) -> Doubles:
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = -at[:, 1] / direction[:, 1]
    return np.where(distance > SHORTEST, distance, np.inf)
