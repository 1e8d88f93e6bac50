# SPDX-License-Identifier: Apache-2.0
"""Twins of what is computed for looking: columns, spreads and cells from the exported columns, in 64 bits."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from script_twins import (
    Doubles,
    build_basis,
    find_angles,
    find_emission,
    incidence,
    incident_trajectory,
    normalize,
    primal_trajectory,
    read_paths,
    signature,
    tortuosity,
)

DIFFUSE = 1.0
SAME_SIDE = 0.7


def path_length(photons: pl.PhotonMap) -> Doubles:
    paths = read_paths(photons)
    steps = np.linalg.norm(np.diff(paths.vertices, axis=0), axis=1)
    inside = paths.owner[1:] == paths.owner[:-1]
    total = np.bincount(paths.owner[1:][inside], steps[inside], minlength=len(paths.count))
    return np.where(paths.count >= 2, total, np.nan)


def incident_angles(photons: pl.PhotonMap) -> Doubles:
    """θ, φ of the way back along the last segment about the receiver's normal, with y for a pole, (n, 2)."""
    paths = read_paths(photons)
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
    back = -normalize(paths.last_segments()) @ turn.T
    normals = np.asarray(photons.path_normals, dtype=np.float64)[np.maximum(paths.first + paths.count - 1, 0)] @ turn.T
    return np.stack(find_angles(back, *build_basis(normals), normals), axis=1)


def primal_angles(photons: pl.PhotonMap) -> Doubles:
    theta, phi, known = find_emission(photons, np.asarray(photons.emitter, dtype=np.int64))
    return np.where(known[:, None], np.stack([theta, phi], axis=1), np.nan)


def normal_angle(photons: pl.PhotonMap) -> Doubles:
    """Azimuth of the normal at the first vertex between the ends that is not diffuse, photon by photon."""
    found = np.full(len(photons), np.nan)
    offsets = photons.path_offsets
    for i in range(len(photons)):
        for at in range(offsets[i] + 1, offsets[i + 1] - 1):
            if photons.path_scatter[at] < DIFFUSE:
                x, _, z = photons.path_normals[at].astype(np.float64)
                found[i] = np.arctan2(x, -z) if x != 0.0 or z != 0.0 else np.nan
                break
    return found


COLUMNS: dict[str, Callable[[pl.PhotonMap], Doubles]] = {
    "x": lambda photons: photons.positions[:, 0],
    "y": lambda photons: photons.positions[:, 1],
    "z": lambda photons: photons.positions[:, 2],
    "nx": lambda photons: photons.normals[:, 0],
    "nz": lambda photons: photons.normals[:, 2],
    "power": lambda photons: photons.power.astype(np.float64) @ np.array([0.2126, 0.7152, 0.0722]),
    "green": lambda photons: photons.power[:, 1],
    "emitter": lambda photons: photons.emitter,
    "object": lambda photons: np.where(photons.object < 0, np.nan, photons.object),
    "emitted_index": lambda photons: photons.emitted_index,
    "primal_theta": lambda photons: primal_angles(photons)[:, 0],
    "primal_phi": lambda photons: primal_angles(photons)[:, 1],
    "primal_u": lambda photons: primal_trajectory(photons).parameters[:, 0],
    "primal_v": lambda photons: primal_trajectory(photons).parameters[:, 1],
    "incident_theta": lambda photons: incident_angles(photons)[:, 0],
    "incident_phi": lambda photons: incident_angles(photons)[:, 1],
    "incident_u": lambda photons: incident_trajectory(photons).parameters[:, 0],
    "incident_v": lambda photons: incident_trajectory(photons).parameters[:, 1],
    "arrival_x": lambda photons: incidence(photons).parameters[:, 0],
    "arrival_y": lambda photons: incidence(photons).parameters[:, 1],
    "arrival_z": lambda photons: incidence(photons).parameters[:, 2],
    "path_length": path_length,
    "vertices": lambda photons: np.diff(photons.path_offsets),
    "signature": lambda photons: signature(photons).parameters[:, 0],
    "tortuosity": lambda photons: tortuosity(photons).parameters[:, 0],
    "normal_angle": normal_angle,
}


def measure_spread(points: NDArray[np.float32], normal: NDArray[np.float32]) -> tuple[Doubles, Doubles]:
    """Eigenvalues, greatest first, and eigenvectors (2, 3) of the moments in a tangent plane about the mean."""
    u, v = (axis[0] for axis in build_basis(normal[None].astype(np.float64)))
    away = points.astype(np.float64) - points.astype(np.float64).mean(axis=0)
    plane = np.stack([away @ u, away @ v])
    values, vectors = np.linalg.eigh(plane @ plane.T / len(points))
    return values[::-1], vectors.T[::-1] @ np.stack([u, v])


def square_radii(
    photons: pl.PhotonMap, point: NDArray[np.float32], normal: NDArray[np.float32], flatness: float
) -> Doubles:
    """Square of the least r that takes a photon in (METHODS section 2), inf where it faces another way, (n,)."""
    away = photons.positions.astype(np.float64) - point
    squared = np.sum(away**2, axis=1)
    if flatness == 0.0:
        return squared
    height = away @ normal.astype(np.float64) / flatness
    alike = photons.normals.astype(np.float64) @ normal > SAME_SIDE
    return np.where(alike, np.maximum(squared, height**2), np.inf)


def descend(tree: dict[str, NDArray], point: NDArray[np.float32], depth: int | None) -> int:
    """Row of the node that a point falls in."""
    row = level = 0
    while tree["split_axis"][row] >= 0 and (depth is None or level < depth):
        row = 2 * row + 1 + int(point[tree["split_axis"][row]] >= tree["split_value"][row])
        level += 1
    return row
