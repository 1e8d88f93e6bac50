# SPDX-License-Identifier: Apache-2.0
"""What the twins of the scripts read and return: columns in double precision, and helpers over ragged paths."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Doubles = NDArray[np.float64]
Ids = NDArray[np.int64]
Mask = NDArray[np.bool_]

LIGHTS = 16  # the scripts' arrays hold this many


@dataclass(frozen=True)
class Columns:
    """A map's columns by the names they have on `PhotonMap`; floats in double precision, whole numbers as int64."""

    positions: Doubles  # (n, 3)
    normals: Doubles  # (n, 3)
    power: Doubles  # (n, 3)
    emitter: Ids  # (n,)
    path_offsets: Ids  # (n + 1,)
    path_vertices: Doubles  # (v, 3)
    path_normals: Doubles  # (v, 3)
    path_interactions: Ids  # (v,)
    path_objects: Ids  # (v,)
    path_scatter: Doubles  # (v,)
    parameters: Doubles  # (n, m), m 0 where there are none; NaN: unset

    def __len__(self) -> int:
        return len(self.positions)

    @property
    def lengths(self) -> Ids:
        """Vertices of each path, (n,)."""
        return np.diff(self.path_offsets)

    @property
    def owners(self) -> Ids:
        """The photon that each vertex belongs to, (v,)."""
        return np.repeat(np.arange(len(self)), self.lengths)

    @property
    def places(self) -> Ids:
        """Number of each vertex in its path, from 0, (v,)."""
        return np.arange(len(self.path_vertices)) - self.path_offsets[:-1][self.owners]

    @property
    def inner(self) -> Mask:
        """Vertices that are neither the first nor the last of their path, (v,)."""
        return (self.places > 0) & (self.places < self.lengths[self.owners] - 1)

    def sum_over_paths(self, values: Doubles) -> Doubles:
        """Sum of one value a vertex over each path, (n,)."""
        return np.bincount(self.owners, values, minlength=len(self))


@dataclass(frozen=True)
class Twin:
    """What a script sets: parameters (n, m) and colors (n, 3), NaN where unset; and what it reports."""

    parameters: Doubles
    colors: Doubles
    prints: dict[str, float] = field(default_factory=dict)
    values: dict[str, Doubles] = field(default_factory=dict)


def read_columns(photons: Any) -> Columns:
    """Read the columns of a `PhotonMap`, or of anything that has them under the same names."""
    names = Columns.__dataclass_fields__
    columns: dict[str, Any] = {name: np.asarray(getattr(photons, name)) for name in names if name != "parameters"}
    has_parameters = "parameters" in getattr(photons, "recorded", ())
    columns["parameters"] = photons.parameters if has_parameters else np.zeros((len(columns["positions"]), 0))
    whole = {"emitter", "path_offsets", "path_interactions", "path_objects"}
    return Columns(**{name: np.asarray(v, np.int64 if name in whole else np.float64) for name, v in columns.items()})


def make_unset(count: int, parameters: int) -> Twin:
    """Nothing is set yet."""
    return Twin(np.full((count, parameters), np.nan), np.full((count, 3), np.nan))


def normalize(vectors: Doubles) -> Doubles:
    """Unit vectors; NaN where there is no direction."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def find_leaving(columns: Columns) -> Doubles:
    """Unit vectors along the first segments, (n, 3); NaN for paths of fewer than two vertices."""
    return _find_segments(columns, columns.path_offsets[:-1])


def find_arriving(columns: Columns) -> Doubles:
    """Unit vectors along the last segments, (n, 3); NaN for paths of fewer than two vertices."""
    return _find_segments(columns, columns.path_offsets[1:] - 2)


def _find_segments(columns: Columns, starts: Ids) -> Doubles:
    found = np.full((len(columns), 3), np.nan)
    rows = np.flatnonzero(columns.lengths >= 2)
    found[rows] = columns.path_vertices[starts[rows] + 1] - columns.path_vertices[starts[rows]]
    return normalize(found)


def build_tangents(w: Doubles) -> tuple[Doubles, Doubles]:
    """Tangents u and v of unit vectors (…, 3), without a branch (Duff et al., JCGT 6(1), 2017)."""
    x, y, z = w[..., 0], w[..., 1], w[..., 2]
    side = np.where(z < 0.0, -1.0, 1.0)
    a = -1.0 / (side + z)
    b = x * y * a
    u = np.stack([1.0 + side * x * x * a, side * b, -side * x], axis=-1)
    return u, np.stack([b, side + y * y * a, -y], axis=-1)


def find_angles(t: Doubles, w: Doubles) -> tuple[Doubles, Doubles]:
    """θ = acos(t·w) and φ = atan2(t·u, t·v) of directions about axes, (n,) each ([SJL15] eq. 3)."""
    u, v = build_tangents(w)
    along_u, along_v, along_w = (np.sum(t * axis, axis=-1) for axis in (u, v, w))
    return np.arctan2(np.hypot(along_u, along_v), along_w), np.arctan2(along_u, along_v)


def find_hue(angle: Doubles) -> Doubles:
    """½ + ½ cos(angle − 2π · channel/3) for the three channels, (n, 3)."""
    return 0.5 + 0.5 * np.cos(angle[:, None] - 2.0 * np.pi * np.arange(3) / 3.0)


def find_false_color(across: ArrayLike, up: ArrayLike) -> Doubles:
    """Red ½ + ½ cos(up), green ½ + ½ sin(across), blue 1 − red · green, (n, 3) ([SJL15] eq. 4)."""
    red = 0.5 + 0.5 * np.cos(np.asarray(up, dtype=np.float64))
    green = 0.5 + 0.5 * np.sin(np.asarray(across, dtype=np.float64))
    return np.stack([red, green, 1.0 - red * green], axis=1)


def decompose_plane(points: Doubles, owners: Ids, count: int) -> tuple[Doubles, Doubles, Mask]:
    """Two-dimensional PCA of the points of each owner: eigenvalues (count, 2), first eigenvectors (count, 2), success.

    Points are centered on their mean, moments divided by their number; the first eigenvector is turned toward the
    owner's first point, or toward +x, then +y, where it is at a right angle to it (METHODS section 4).
    """
    members = np.bincount(owners, minlength=count)
    divisor = np.maximum(members, 1)
    mean = np.stack([np.bincount(owners, points[:, axis], count) for axis in (0, 1)], axis=1) / divisor[:, None]
    away = points - mean[owners]
    xx, xy, yy = (
        np.bincount(owners, away[:, i] * away[:, j], count) / divisor for i, j in ((0, 0), (0, 1), (1, 1))
    )
    half, radius = 0.5 * (xx + yy), np.hypot(0.5 * (xx - yy), xy)
    angle = 0.5 * np.arctan2(2.0 * xy, xx - yy)
    vectors = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    first = np.zeros((count, 2))
    first[owners[::-1]] = points[::-1]  # the last one written is the first of its owner
    toward = np.sum(vectors * first, axis=1)
    toward = np.where(toward == 0.0, np.where(vectors[:, 0] == 0.0, vectors[:, 1], vectors[:, 0]), toward)
    values = np.stack([half + radius, half - radius], axis=1)
    return values, vectors * np.where(toward < 0.0, -1.0, 1.0)[:, None], (members >= 2) & (values[:, 0] > 0.0)
