# SPDX-License-Identifier: Apache-2.0
"""Directions in which photons left the light, as points of a plane: the parameters of the relaxation benchmarks."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl

Doubles = NDArray[np.float64]


def build_duff_basis(w: Doubles) -> tuple[Doubles, Doubles]:
    """Tangents u and v to the unit vector w, by Duff's branchless construction."""
    sign = np.copysign(1.0, w[2])
    a = -1.0 / (sign + w[2])
    b = w[0] * w[1] * a
    u = np.array([1.0 + sign * w[0] ** 2 * a, sign * b, -sign * w[0]])
    return u, np.array([b, sign + w[1] ** 2 * a, -w[1]])


def find_emission_directions(photons: pl.PhotonMap) -> Doubles:
    """Unit vectors along the first segment of every path, (n, 3)."""
    first = np.asarray(photons.path_offsets)[:-1]
    vertices = np.asarray(photons.path_vertices, dtype=np.float64)
    segment = vertices[first + 1] - vertices[first]
    return segment / np.linalg.norm(segment, axis=1, keepdims=True)


def flatten_directions(directions: Doubles) -> Doubles:
    """Planar trajectory (θ sin φ, θ cos φ), (n, 2), about the mean direction: METHODS section 4, equation 3."""
    mean = directions.mean(axis=0)
    w = mean / np.linalg.norm(mean)
    u, v = build_duff_basis(w)
    along_u, along_v = directions @ u, directions @ v
    across = np.hypot(along_u, along_v)
    theta = np.arctan2(across, directions @ w)
    scale = np.where(across > 0.0, theta / np.where(across > 0.0, across, 1.0), 1.0)
    return np.stack([scale * along_u, scale * along_v], axis=1)


def set_trajectory(photons: pl.PhotonMap) -> None:
    """Give a map of one light its planar primal trajectory as parameters."""
    photons.set_parameters(flatten_directions(find_emission_directions(photons)), names=("right", "up"))
