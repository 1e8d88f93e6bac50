# SPDX-License-Identifier: Apache-2.0
"""Primal trajectories: the direction in which each photon left its light, as a point of the plane."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from photonloupe.photons import PhotonMap

Doubles = NDArray[np.float64]


def find_primal_trajectory(photons: PhotonMap) -> NDArray[np.float32]:
    """Find where each photon lies in the space of emission directions ([SJL15] eq. 3, METHODS section 4).

    With t the unit vector along the first segment of the photon's path, and an orthonormal basis u, v, w,

        θ = acos(t·w),  φ = atan2(t·u, t·v),  trajectory = (θ sin φ, θ cos φ).

    w is the mean direction of all photons of the same emitter, u and v follow from it by Duff's branchless
    construction, so that the tear at θ = π lies behind the light that was stored. Near in this plane is near in
    direction: Euclidean distance serves as that of the parameter space.

    Parameters
    ----------
    photons
        A map with paths, or one that can record them.

    Returns
    -------
    (n, 2) float32
        θ sin φ and θ cos φ, radians; NaN, which is unset, where a path has no first segment of any length.

    Raises
    ------
    PhotonLoupeError
        If the map has no paths and cannot record them.

    Examples
    --------
    >>> import photonloupe as pl
    >>> photons = pl.trace_photons(pl.load_scene("scenes/ring/ring.gltf"), count=10_000, seed=1)
    >>> photons.set_parameters(pl.find_primal_trajectory(photons), names=("right", "up"))
    >>> photons.parameter_names, bool(photons.parameters_set.all())
    (('right', 'up'), True)
    """
    directions = _find_emission_directions(photons)
    trajectory = np.full((len(photons), 2), np.nan)
    known = ~np.isnan(directions).any(axis=1)
    for emitter in np.unique(photons.emitter[known]):
        own = known & (photons.emitter == emitter)
        trajectory[own] = _flatten(directions[own])
    return trajectory.astype(np.float32)


def _find_emission_directions(photons: PhotonMap) -> Doubles:
    """Find unit vectors along the first segments, (n, 3); NaN where there is none."""
    offsets = photons.path_offsets
    vertices = photons.path_vertices.astype(np.float64)
    directions = np.full((len(photons), 3), np.nan)
    rows = np.flatnonzero(np.diff(offsets) >= 2)
    first = offsets[rows]
    segments = vertices[first + 1] - vertices[first]
    lengths = np.linalg.norm(segments, axis=1)
    apart = lengths > 0.0
    directions[rows[apart]] = segments[apart] / lengths[apart, None]
    return directions


def _flatten(directions: Doubles) -> Doubles:
    """Turn the unit vectors of one emitter into points of the plane about their mean."""
    mean = directions.mean(axis=0)
    # Directions that cancel have no mean; any axis is as good then, one of them is defined.
    w = mean if mean.any() else directions[0]
    w = w / np.linalg.norm(w)
    u, v = _build_basis(w)
    along_u, along_v = directions @ u, directions @ v
    across = np.hypot(along_u, along_v)
    # atan2 where the equation has acos, whose error near θ = 0 is the root of the rounding.
    theta = np.arctan2(across, directions @ w)
    phi = np.arctan2(along_u, along_v)
    return np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=1)


def _build_basis(w: Doubles) -> tuple[Doubles, Doubles]:
    """Tangents u and v of a unit vector, without a branch (Duff et al., JCGT 6(1), 2017)."""
    sign = np.copysign(1.0, w[2])
    a = -1.0 / (sign + w[2])
    b = w[0] * w[1] * a
    u = np.array([1.0 + sign * w[0] ** 2 * a, sign * b, -sign * w[0]])
    return u, np.array([b, sign + w[1] ** 2 * a, -w[1]])
