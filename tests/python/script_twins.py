# SPDX-License-Identifier: Apache-2.0
"""Twins of the scripts in scenes/scripts: the same parameters and colors from the exported columns, in 64 bits."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl

Doubles = NDArray[np.float64]
Ids = NDArray[np.int64]

MOST_DIGITS = 15  # base-3 digits that 32 bits hold exactly, as floats and as integers


@dataclass(frozen=True)
class Twin:
    """What a script sets: parameters (n, m) and colors (n, 3), NaN where unset."""

    parameters: Doubles
    colors: Doubles


@dataclass(frozen=True)
class Paths:
    """Ragged paths: flat rows of vertices, each with its photon and its number on the path."""

    first: Ids  # (n,) row of vertex 0
    count: Ids  # (n,)
    owner: Ids  # (v,)
    place: Ids  # (v,)
    vertices: Doubles  # (v, 3)

    def sum_inner(self, values: Doubles, most: int | None = None) -> Doubles:
        """Sum values (v,) over each path's vertices but its ends, or over the first `most` of those: (n,)."""
        inner = (self.place > 0) & (self.place < self.count[self.owner] - 1)
        if most is not None:
            inner &= self.place <= most
        return np.bincount(self.owner[inner], values[inner], minlength=len(self.count))

    def first_segments(self) -> Doubles:
        """From vertex 0 to vertex 1, (n, 3); NaN where the path has none, or one of no length."""
        return self._segments(self.first, self.first + 1)

    def last_segments(self) -> Doubles:
        """From the last vertex but one to the last, (n, 3); NaN as above."""
        last = self.first + self.count - 1
        return self._segments(last - 1, last)

    def _segments(self, start: Ids, end: Ids) -> Doubles:
        found = np.full((len(self.count), 3), np.nan)
        known = self.count >= 2
        found[known] = self.vertices[end[known]] - self.vertices[start[known]]
        found[np.linalg.norm(found, axis=1) == 0.0] = np.nan
        return found


def read_paths(photons: pl.PhotonMap) -> Paths:
    offsets = np.asarray(photons.path_offsets, dtype=np.int64)
    count = np.diff(offsets)
    owner = np.repeat(np.arange(len(count)), count)
    vertices = np.asarray(photons.path_vertices, dtype=np.float64)
    return Paths(offsets[:-1], count, owner, np.arange(len(owner)) - offsets[owner], vertices)


def normalize(vectors: Doubles) -> Doubles:
    with np.errstate(invalid="ignore"):
        return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)


def hue(angle: Doubles) -> Doubles:
    """½ + ½ cos(angle − 2π·channel/3), (n, 3)."""
    return 0.5 + 0.5 * np.cos(np.asarray(angle)[..., None] - 2.0 * np.pi * np.arange(3) / 3.0)


def unset(values: Doubles, known: NDArray[np.bool_]) -> Doubles:
    """Values, NaN where not known."""
    return np.where(known[:, None], values, np.nan)


def build_basis(w: Doubles) -> tuple[Doubles, Doubles]:
    """Tangents u, v of unit vectors (n, 3) by Duff et al. (JCGT 6(1), 2017), listing 3."""
    x, y, z = w.T
    sign = np.where(z < 0.0, -1.0, 1.0)
    a = -1.0 / (sign + z)
    b = x * y * a
    return np.stack([1.0 + sign * x * x * a, sign * b, -sign * x], 1), np.stack([b, sign + y * y * a, -y], 1)


def find_angles(t: Doubles, u: Doubles, v: Doubles, w: Doubles) -> tuple[Doubles, Doubles]:
    """θ = acos(t·w), φ = atan2(t·u, t·v) of unit vectors ([SJL15] eq. 3)."""
    along_u, along_v, along_w = (np.sum(t * axis, axis=1) for axis in (u, v, w))
    return np.arccos(np.clip(along_w, -1.0, 1.0)), np.arctan2(along_u, along_v)


def flatten(theta: Doubles, phi: Doubles) -> Doubles:
    """(θ sin φ, θ cos φ), (n, 2): the planar form of METHODS section 4."""
    return np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=1)


def fade(theta: Doubles, phi: Doubles, zoom: float) -> Doubles:
    """The hue of φ, white at θ = 0, saturated from θ = 1/zoom on."""
    return 1.0 + (hue(phi) - 1.0) * np.minimum(zoom * theta, 1.0)[:, None]


def tortuosity(photons: pl.PhotonMap, turns: float = 10.0) -> Twin:
    """γ = 1/(π(m − 2)) Σ angle between successive segments ([SJL15] eq. 1); unset where m < 3."""
    paths = read_paths(photons)
    segments = normalize(np.diff(paths.vertices, axis=0))  # of the flat rows; the one at row i leaves vertex i
    deflection = np.zeros(len(paths.vertices))
    deflection[1:-1] = np.arccos(np.clip(np.sum(segments[:-1] * segments[1:], axis=1), -1.0, 1.0))
    known = paths.count >= 3
    gamma = paths.sum_inner(deflection) / (np.pi * np.where(known, paths.count - 2, 1))
    return Twin(unset(gamma[:, None], known), unset(hue(2.0 * np.pi * turns * gamma), known))


def push_points(photons: pl.PhotonMap) -> tuple[Paths, Doubles]:
    """Points of the plane that Algorithm 2 pushes, one per vertex: the primal direction's at vertex 0, the normals'."""
    paths = read_paths(photons)
    directions = np.asarray(photons.path_normals, dtype=np.float64).copy()
    is_first = paths.place == 0
    directions[is_first] = paths.first_segments()[paths.owner[is_first]]
    directions = normalize(directions)
    theta = np.arccos(np.clip(directions[:, 2], -1.0, 1.0))
    phi = np.arctan2(directions[:, 0], directions[:, 1]) * np.where(is_first, 1.0, 2.0)
    return paths, flatten(theta, phi)


def decompose(photons: pl.PhotonMap) -> tuple[Doubles, Doubles, Doubles]:
    """Eigenvalues (n, 2), greatest first, eigenvectors (n, 2, 2) as rows, and the first points (n, 2)."""
    paths, points = push_points(photons)
    count = np.maximum(paths.count, 1)

    def average(values: Doubles) -> Doubles:
        return np.bincount(paths.owner, values, minlength=len(count)) / count

    away = points - np.stack([average(points[:, 0]), average(points[:, 1])], axis=1)[paths.owner]
    uu, uv, vv = (average(away[:, i] * away[:, j]) for i, j in ((0, 0), (0, 1), (1, 1)))
    values, vectors = np.linalg.eigh(np.stack([uu, uv, uv, vv], axis=1).reshape(-1, 2, 2))
    return values[:, ::-1], np.swapaxes(vectors, 1, 2)[:, ::-1], points[np.minimum(paths.first, len(points) - 1)]


def ppca(photons: pl.PhotonMap, turns: float = 2.0) -> Twin:
    """e₁√λ₁ of the primal direction and the path's normals ([SJL15] section 5.3), e₁ towards the first point."""
    values, vectors, first = decompose(photons)
    along = np.sum(vectors[:, 0] * first, axis=1, keepdims=True)
    deviation = np.sqrt(np.maximum(values[:, 0], 0.0))
    parameters = np.where(along < 0.0, -1.0, 1.0) * vectors[:, 0] * deviation[:, None]
    bright = np.minimum(deviation / (np.pi / 2.0), 1.0)
    colors = bright[:, None] * hue(turns * np.arctan2(parameters[:, 0], parameters[:, 1]))
    known = (np.diff(photons.path_offsets) >= 2) & (values.sum(axis=1) > 0.0)  # false for NaN
    return Twin(unset(parameters, known), unset(colors, known))


def signature(photons: pl.PhotonMap, digits: int = MOST_DIGITS, hues: int = 7) -> Twin:
    """S = Σ 3^(i−2)·(1 reflected | 2 transmitted) over inner vertices ([SJL15] eq. 2), the lowest digits of it."""
    paths = read_paths(photons)
    places = 3.0 ** np.clip(paths.place - 1, 0, MOST_DIGITS)
    value = paths.sum_inner(places * photons.path_interactions, digits)
    known = paths.count >= 2
    return Twin(unset(value[:, None], known), unset(hue(2.0 * np.pi * (value % hues) / hues), known))


def find_emission(photons: pl.PhotonMap, emitter: Ids) -> tuple[Doubles, Doubles, NDArray[np.bool_]]:
    """θ, φ of the primal directions about the mean of those of the same number in `emitter` (n,), and which are set."""
    directions = normalize(read_paths(photons).first_segments())
    known = ~np.isnan(directions[:, 0])
    means = np.zeros((emitter.max(initial=0) + 1, 3))
    np.add.at(means, emitter[known], directions[known])
    w = normalize(means)[emitter]
    u, v = build_basis(w)
    theta, phi = find_angles(directions, u, v, w)
    return theta, phi, known


def primal_trajectory(photons: pl.PhotonMap, zoom: float = 4.0) -> Twin:
    """(θ sin φ, θ cos φ) of the primal direction about the mean of its emitter ([SJL15] eq. 3)."""
    theta, phi, known = find_emission(photons, np.asarray(photons.emitter, dtype=np.int64))
    return Twin(unset(flatten(theta, phi), known), unset(fade(theta, phi, zoom), known))


def trajectory_color(photons: pl.PhotonMap, waves: float = 1.0) -> Twin:
    """θ, φ of the primal direction about the mean of all, and their color ([SJL15] eqs. 3, 4)."""
    theta, phi, known = find_emission(photons, np.zeros(len(photons), dtype=np.int64))
    r = 0.5 + 0.5 * np.cos(waves * theta * np.cos(phi))
    g = 0.5 + 0.5 * np.sin(waves * theta * np.sin(phi))
    colors = np.stack([r, g, 1.0 - r * g], axis=1)
    return Twin(unset(np.stack([theta, phi], axis=1), known), unset(colors, known))


def incident_trajectory(photons: pl.PhotonMap, zoom: float = 1.0) -> Twin:
    """(θ sin φ, θ cos φ) of the way back along the last segment about the receiver's normal ([SJL15] eq. 3)."""
    paths = read_paths(photons)
    back = -normalize(paths.last_segments())
    known = ~np.isnan(back[:, 0])
    last = np.maximum(paths.first + paths.count - 1, 0)
    normals = np.asarray(photons.path_normals, dtype=np.float64)[last]
    # With y up: the basis is built where (x, −z, y) are the axes.
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    turned = normals @ turn.T
    u, v = build_basis(turned)
    theta, phi = find_angles(back @ turn.T, u, v, turned)
    return Twin(unset(flatten(theta, phi), known), unset(fade(theta, phi, zoom), known))


def scatter(photons: pl.PhotonMap, gamma: float = 1.0) -> Twin:
    """Mean scatter of the inner vertices ([SJL15] section 3.4, figure 4 e); blue, green, red for 0, ½, 1."""
    paths = read_paths(photons)
    known = paths.count >= 3
    total = paths.sum_inner(np.asarray(photons.path_scatter, dtype=np.float64))
    value = total / np.where(known, paths.count - 2, 1)
    heat = value**gamma

    def climb(low: float, high: float) -> Doubles:
        t = np.clip((heat - low) / (high - low), 0.0, 1.0)
        return t * t * (3.0 - 2.0 * t)

    colors = np.stack([climb(0.5, 1.0), 1.0 - np.abs(2.0 * heat - 1.0), 1.0 - climb(0.0, 0.5)], axis=1)
    return Twin(unset(value[:, None], known), unset(colors, known))


def incidence(photons: pl.PhotonMap, contrast: float = 1.0) -> Twin:
    """Unit vector of the last segment ([SJL15] section 5.4, participant A)."""
    arriving = normalize(read_paths(photons).last_segments())
    return Twin(arriving, np.clip(0.5 + 0.5 * contrast * arriving, 0.0, 1.0))


def incident_and_extant(photons: pl.PhotonMap, extant: float = 1.0) -> Twin:
    """Unit vectors of the last and, weighted, of the first segment ([SJL15] section 5.4, participant B)."""
    paths = read_paths(photons)
    arriving, leaving = normalize(paths.last_segments()), extant * normalize(paths.first_segments())
    parameters = np.concatenate([arriving, leaving], axis=1)
    colors = 0.5 + 0.5 * (arriving + leaving) / (1.0 + extant)
    known = ~np.isnan(parameters).any(axis=1)
    return Twin(unset(parameters, known), unset(colors, known))


def cluster_incidence(photons: pl.PhotonMap, clusters: int = 4, rounds: int = 10) -> tuple[Twin, float]:
    """Lloyd's iteration over arriving directions (participant C): the twin, and the mean squared distance."""
    arriving = incidence(photons).parameters
    known = ~np.isnan(arriving[:, 0])
    points = arriving[known]
    starts = (len(photons) * (np.arange(clusters) + 0.5) / clusters).astype(np.int64)
    centers = arriving[starts]
    for turn in range(rounds + 1):
        squares = np.sum((points[:, None] - centers) ** 2, axis=2)
        nearest = np.argmin(squares, axis=1)
        if turn < rounds:
            members = [points[nearest == k] for k in range(clusters)]
            centers = np.stack([m.mean(0) if len(m) else c for m, c in zip(members, centers, strict=True)])
    label = np.zeros(len(photons))
    label[known] = nearest
    spread = float(squares[np.arange(len(points)), nearest].sum() / len(photons))
    return Twin(unset(label[:, None], known), unset(hue(2.0 * np.pi * label / clusters), known)), spread


def kmeans_incidence(photons: pl.PhotonMap, clusters: int = 4, rounds: int = 10) -> Twin:
    return cluster_incidence(photons, clusters, rounds)[0]


def measure_isotropy(photons: pl.PhotonMap, neighbors: int = 100) -> Doubles:
    """Isotropy t = √(λ₂/λ₁) of the parameter neighbors' places in the tangent plane ([SJL15] eq. 5), NaN: none."""
    values = np.asarray(photons.parameters, dtype=np.float64)
    positions = np.asarray(photons.positions, dtype=np.float64)
    emitter = np.asarray(photons.emitter)
    u, v = build_basis(np.asarray(photons.normals, dtype=np.float64))
    found = np.full(len(values), np.nan)
    known = np.asarray(photons.parameters_set)
    for i in np.flatnonzero(known):
        others = np.flatnonzero(known & (emitter == emitter[i]) & (np.arange(len(values)) != i))
        distance = np.sum((values[others] - values[i]) ** 2, axis=1)
        away = positions[others[np.argsort(distance, kind="stable")[:neighbors]]] - positions[i]
        if len(away) < 2:
            continue
        less, greater = np.linalg.eigvalsh(np.cov(np.stack([away @ u[i], away @ v[i]]), bias=True))
        if greater > 0.0:
            found[i] = np.sqrt(max(less, 0.0) / greater)
    return found


def find_beta(isotropy: Doubles, clip: float = 0.05) -> float:
    """β = √(1/t_β), t_β exceeded by all but a share `clip` of the photons ([SJL15] eq. 6)."""
    return float(np.quantile(isotropy[~np.isnan(isotropy)], clip) ** -0.5)


TWINS: dict[str, Callable[..., Twin]] = {
    "tortuosity": tortuosity,
    "ppca": ppca,
    "signature": signature,
    "primal_trajectory": primal_trajectory,
    "trajectory_color": trajectory_color,
    "incident_trajectory": incident_trajectory,
    "scatter": scatter,
    "incidence": incidence,
    "incident_and_extant": incident_and_extant,
    "kmeans_incidence": kmeans_incidence,
}
