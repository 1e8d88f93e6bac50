# SPDX-License-Identifier: Apache-2.0
"""Primal trajectories: the direction in which each photon left its light, as a point of the plane."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from photonloupe.inspect.columns import column
from photonloupe.photons import PhotonMap


def find_primal_trajectory(photons: PhotonMap) -> NDArray[np.float32]:
    """Find where each photon lies in the space of emission directions ([SJL15] eq. 3, METHODS section 4).

    With t the unit vector along the first segment of the photon's path, and an orthonormal basis u, v, w,

        θ = acos(t·w),  φ = atan2(t·u, t·v),  trajectory = (θ sin φ, θ cos φ).

    w is the mean direction of all photons of the same emitter, u and v follow from it by Duff's branchless
    construction, so that the tear at θ = π lies behind the light that was stored. Near in this plane is near in
    direction: Euclidean distance serves as that of the parameter space. The columns ``primal_u`` and ``primal_v``.

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
    return np.stack([column(photons, name).values for name in ("primal_u", "primal_v")], axis=1)
