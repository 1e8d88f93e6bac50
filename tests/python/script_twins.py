# SPDX-License-Identifier: Apache-2.0
"""NumPy twins of the scripts in scenes/scripts: the same equations over exported columns, in double precision.

Keywords are the scripts' sliders, with the same defaults. Equations are those of [SJL15].
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from script_columns import (
    LIGHTS,
    Columns,
    Doubles,
    Ids,
    Twin,
    build_tangents,
    decompose_plane,
    find_angles,
    find_arriving,
    find_false_color,
    find_hue,
    find_leaving,
    make_unset,
)

LONGEST_SIGNATURE = 15
CENTERS = 16
ISOTROPY_BINS = 1024
ISOTROPY_HISTOGRAM_BINS = 64
CLIPPED = (1.0, 0.45, 0.05)
COLD, WARM = np.array([0.05, 0.25, 0.8]), np.array([1.0, 0.55, 0.05])


def find_tortuosity(columns: Columns, *, turns: float = 50.0) -> Twin:
    """Mean angle between successive segments over π (eq. 1); unset for fewer than three vertices."""
    middle = np.flatnonzero(columns.inner)
    before = columns.path_vertices[middle] - columns.path_vertices[middle - 1]
    after = columns.path_vertices[middle + 1] - columns.path_vertices[middle]
    angle = np.zeros(len(columns.path_vertices))
    angle[middle] = np.arctan2(np.linalg.norm(np.cross(before, after), axis=1), np.sum(before * after, axis=1))
    twin = make_unset(len(columns), 1)
    known = columns.lengths >= 3
    gamma = columns.sum_over_paths(angle)[known] / (np.pi * (columns.lengths[known] - 2))
    twin.parameters[known, 0] = gamma
    twin.colors[known] = find_hue(2.0 * np.pi * turns * gamma)
    return twin


def find_ppca(columns: Columns, *, cycles: float = 8.0) -> Twin:
    """First principal component of the planar primal direction and path normals (section 5.3, Algorithm 2)."""
    directions = columns.path_normals.copy()
    directions[columns.path_offsets[:-1][columns.lengths >= 1]] = find_leaving(columns)[columns.lengths >= 1]
    x, y, z = directions.T
    theta, phi = np.arctan2(np.hypot(x, y), z), np.arctan2(x, y) * np.where(columns.places == 0, 1.0, 2.0)
    points = np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=1)
    used = columns.lengths[columns.owners] >= 2
    values, vectors, known = decompose_plane(points[used], columns.owners[used], len(columns))
    twin = make_unset(len(columns), 2)
    twin.parameters[known] = (np.sqrt(values[:, :1]) * vectors)[known]
    u, v = cycles * twin.parameters[known].T
    twin.colors[known] = find_false_color(u, v)
    return twin


def find_signature(columns: Columns, *, palette: int = 12) -> Twin:
    """Interactions as the digits of a number in base 3, the first the least (eq. 2); the first 15 of a longer path."""
    counted = columns.inner & (columns.places <= LONGEST_SIGNATURE)
    digits = np.where(counted, columns.path_interactions * 3.0 ** np.minimum(columns.places - 1, LONGEST_SIGNATURE), 0)
    signature = columns.sum_over_paths(digits)
    longer = int(np.sum(columns.lengths - 2 > LONGEST_SIGNATURE))
    prints = {"paths of more than 15 interactions:": float(longer)} if longer else {}
    return Twin(signature[:, None], find_hue(2.0 * np.pi * (signature % palette) / palette), prints)


def find_primal_trajectory(columns: Columns, *, cycles: float = 8.0) -> Twin:
    """(θ sin φ, θ cos φ) of the leaving direction about the mean of its light's photons (eq. 3)."""
    theta, phi, known = _find_primal_angles(columns)
    twin = make_unset(len(columns), 2)
    twin.parameters[known] = np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=1)
    twin.colors[known] = find_false_color(*(cycles * twin.parameters[known].T))
    return twin


def find_trajectory_color(columns: Columns, *, cycles: float = 1.0) -> Twin:
    """θ and φ of the primal trajectory (eq. 3) and their false color (eq. 4)."""
    theta, phi, known = _find_primal_angles(columns)
    twin = make_unset(len(columns), 2)
    twin.parameters[known] = np.stack([theta, phi], axis=1)
    twin.colors[known] = find_false_color(cycles * theta * np.sin(phi), cycles * theta * np.cos(phi))
    return twin


def _find_primal_angles(columns: Columns) -> tuple[Doubles, Doubles, np.ndarray]:
    """θ and φ of the photons that have them, and which those are, (n,): w is the mean over the light (METHODS §4)."""
    known = (columns.lengths >= 2) & (columns.emitter >= 0) & (columns.emitter < LIGHTS)
    leaving, light = find_leaving(columns)[known], columns.emitter[known]
    sums = np.stack([np.bincount(light, leaving[:, axis], LIGHTS) for axis in range(3)], axis=1)
    axes = sums[light] / np.linalg.norm(sums[light], axis=1, keepdims=True)
    return *find_angles(leaving, axes), known


def find_incident_trajectory(columns: Columns, *, cycles: float = 4.0) -> Twin:
    """(θ sin φ, θ cos φ) of the direction back along the last segment about the receiver's normal (eq. 3)."""
    known = columns.lengths >= 2
    normals = columns.path_normals[columns.path_offsets[1:][known] - 1]
    theta, phi = find_angles(-find_arriving(columns)[known], normals)
    twin = make_unset(len(columns), 2)
    twin.parameters[known] = np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=1)
    twin.colors[known] = find_false_color(*(cycles * twin.parameters[known].T))
    return twin


def find_scatter(columns: Columns, *, gain: float = 1.0) -> Twin:
    """Mean and greatest scatter over the vertices that passed the light on (section 3.4, figure 4 e)."""
    known = columns.lengths >= 3
    scatter = np.where(columns.inner, columns.path_scatter, 0.0)
    roughest = np.zeros(len(columns))
    np.maximum.at(roughest, columns.owners, scatter)
    twin = make_unset(len(columns), 2)
    mean = columns.sum_over_paths(scatter)[known] / (columns.lengths[known] - 2)
    twin.parameters[known] = np.stack([mean, roughest[known]], axis=1)
    twin.colors[known] = COLD + (WARM - COLD) * np.clip(gain * mean, 0.0, 1.0)[:, None]
    return twin


def find_incidence(columns: Columns, *, cycles: float = 1.0) -> Twin:
    """The arriving direction (section 5.4, participant A)."""
    arriving = find_arriving(columns)
    return Twin(arriving, _shade(cycles, arriving))


def find_incident_and_extant(columns: Columns, *, share: float = 0.5, cycles: float = 1.0) -> Twin:
    """Arriving and leaving directions, weighed 1 − `share` against `share` (section 5.4, participant B)."""
    arriving, leaving = (1.0 - share) * find_arriving(columns), share * find_leaving(columns)
    return Twin(np.concatenate([arriving, leaving], axis=1), _shade(cycles, arriving + leaving))


def _shade(cycles: float, components: Doubles) -> Doubles:
    return 0.5 + 0.5 * np.sin(0.5 * np.pi * cycles * components)


def find_kmeans_incidence(columns: Columns, *, clusters: int = 6, iterations: int = 12) -> Twin:
    """Labels of k-means over arriving directions (section 5.4, participant C), from photons spread over the map.

    Sums are in double precision here and in blocks of floats in the script: a photon halfway between two centers may
    come out with the other label.
    """
    directions = find_arriving(columns)
    known = columns.lengths >= 2
    # The script divides in 32-bit floats.
    seeds = (np.arange(clusters) * len(columns)).astype(np.float32) / np.float32(clusters)
    centers = directions[seeds.astype(np.int64)]
    for _ in range(iterations):
        labels = _find_nearest(directions[known], centers)
        members = np.bincount(labels, minlength=clusters)
        sums = np.stack([np.bincount(labels, directions[known, axis], clusters) for axis in range(3)], axis=1)
        centers = np.where(members[:, None] > 0, sums / np.maximum(members, 1)[:, None], centers)
    twin = make_unset(len(columns), 1)
    labels = _find_nearest(directions[known], centers)
    twin.parameters[known, 0] = labels
    twin.colors[known] = find_hue(2.0 * np.pi * labels / clusters)
    twin.values["centers"] = centers
    return twin


def _find_nearest(directions: Doubles, centers: Doubles) -> Ids:
    apart = np.sum((directions[:, None, :] - centers[None, :, :]) ** 2, axis=2)
    return np.argmin(np.where(np.isnan(apart), np.inf, apart), axis=1)


def find_isotropy(columns: Columns, *, neighbours: int = 100, margin: float = 0.05) -> Twin:
    """Axis ratios of the world positions of neighbors in parameter space, and β (eqs. 5 and 6, section 5.2).

    The parameters are those the map has; distances are Euclidean, without periods. `values` holds ``t`` (n,), NaN
    where there is none, and ``histogram`` (64,).
    """
    t = np.full(len(columns), np.nan)
    is_set = ~np.isnan(columns.parameters).any(axis=1) if columns.parameters.shape[1] else np.zeros(len(columns), bool)
    for light in np.unique(columns.emitter[is_set]):
        layer = np.flatnonzero(is_set & (columns.emitter == light))
        t[layer] = _measure_layer(columns, layer, neighbours)
    known = ~np.isnan(t)
    counts = np.bincount(np.minimum((t[known] * ISOTROPY_BINS).astype(int), ISOTROPY_BINS - 1), minlength=ISOTROPY_BINS)
    bound = _find_quantile(counts, margin)
    twin = make_unset(len(columns), 0)
    light_shade = np.clip((t[known] - bound) / (1.0 - bound), 0.0, 1.0)[:, None]
    twin.colors[known] = np.where(t[known, None] < bound, CLIPPED, light_shade)
    with np.errstate(divide="ignore"):
        twin.prints.update({"t_beta": bound, "beta": float(np.sqrt(1.0 / np.float64(bound)))})
    twin.values["t"] = t
    twin.values["histogram"] = np.histogram(t[known], ISOTROPY_HISTOGRAM_BINS, (0.0, 1.0))[0].astype(np.float64)
    return twin


def _measure_layer(columns: Columns, layer: Ids, k: int) -> Doubles:
    """Axis ratio t of each photon of a layer; brute force, nearest first, ties by id."""
    t = np.full(len(layer), np.nan)
    k = min(k, len(layer) - 1)
    for row, photon in enumerate(layer):
        apart = np.sum((columns.parameters[layer] - columns.parameters[photon]) ** 2, axis=1)
        apart[row] = np.inf
        found = layer[np.argsort(apart, kind="stable")[:k]]
        u, v = build_tangents(columns.normals[photon])
        offsets = columns.positions[found] - columns.positions[photon]
        points = np.stack([offsets @ u, offsets @ v], axis=1)
        values, _, success = decompose_plane(points, np.zeros(k, dtype=np.int64), 1)
        if success[0]:
            t[row] = np.sqrt(max(values[0, 1], 0.0) / values[0, 0])
    return t


def _find_quantile(counts: Ids, margin: float) -> float:
    """Where a share `margin` lies below, linear in its bin; 0 where nothing was counted."""
    wanted = margin * counts.sum()
    below = np.cumsum(counts) - counts
    reached = np.flatnonzero(below + counts > wanted)
    if len(reached) == 0:
        return 0.0
    first = reached[0]
    return float((first + (wanted - below[first]) / counts[first]) / len(counts))


TWINS: dict[str, Callable[..., Twin]] = {
    "incidence": find_incidence,
    "incident_and_extant": find_incident_and_extant,
    "incident_trajectory": find_incident_trajectory,
    "isotropy": find_isotropy,
    "kmeans_incidence": find_kmeans_incidence,
    "ppca": find_ppca,
    "primal_trajectory": find_primal_trajectory,
    "scatter": find_scatter,
    "signature": find_signature,
    "tortuosity": find_tortuosity,
    "trajectory_color": find_trajectory_color,
}

NAMES: dict[str, tuple[str, ...]] = {
    "incidence": ("incidence x", "incidence y", "incidence z"),
    "incident_and_extant": ("incident x", "incident y", "incident z", "extant x", "extant y", "extant z"),
    "incident_trajectory": ("incident right", "incident up"),
    "isotropy": (),
    "kmeans_incidence": ("cluster",),
    "ppca": ("ppca u", "ppca v"),
    "primal_trajectory": ("right", "up"),
    "scatter": ("mean scatter", "roughest"),
    "signature": ("signature",),
    "tortuosity": ("tortuosity",),
    "trajectory_color": ("theta", "phi"),
}


def run_twin(name: str, columns: Columns, **sliders: Any) -> Twin:
    """Run the twin of the script `name`; see its function."""
    return TWINS[name](columns, **sliders)
