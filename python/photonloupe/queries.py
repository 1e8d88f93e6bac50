# SPDX-License-Identifier: Apache-2.0
"""How much light arrives: irradiance estimates asked of a photon map."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_choice, check_count, check_vectors
from photonloupe.device import Device
from photonloupe.errors import ArgumentError
from photonloupe.nearest import MAX_NEIGHBORS
from photonloupe.progress import ProgressLike, follow_progress

KERNELS = ("epanechnikov", "disc", "cone", "gaussian")
# Best k of the unrelaxed ring caustic, 200,000 photons: 50 on Sobol emission, about 100 on random (METHODS section 7).
DEFAULT_K = {"sobol": 50, "random": 100}


def choose_k(settings: dict[str, Any]) -> int:
    """Return the number of photons an estimate gathers when nothing is said."""
    return DEFAULT_K.get(str(settings.get("emission")), DEFAULT_K["random"])


def estimate_irradiance(
    device: Device,
    photons: _engine.PhotonMap,
    points: ArrayLike,
    normals: ArrayLike,
    *,
    k: int,
    kernel: str = "epanechnikov",
    progress: ProgressLike = None,
) -> NDArray[np.float32]:
    """Check the query and run it; see `PhotonMap.irradiance`."""
    check_choice("kernel", kernel, KERNELS)
    k = check_count("k", k, 1, MAX_NEIGHBORS)
    where = check_vectors("points", points)
    facing = np.asarray(normals)
    if facing.ndim == 1:
        facing = np.broadcast_to(facing, (len(where), len(facing)))
    facing = check_vectors("normals", facing)
    if len(facing) != len(where):
        raise ArgumentError(f"normals has {len(facing)} rows, points has {len(where)}")
    length = np.linalg.norm(facing, axis=1, keepdims=True)
    if (length == 0.0).any():
        raise ArgumentError(f"normals[{int(np.argmin(length))}] is zero; a normal needs a direction")
    unit = np.ascontiguousarray(facing / length, dtype=np.float32)
    with follow_progress(progress) as callback:
        return np.asarray(_engine.estimate_irradiance(device._native, photons, where, unit, k, kernel, callback))
