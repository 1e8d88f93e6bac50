# SPDX-License-Identifier: Apache-2.0
"""Questions asked of a photon map: who is near, and how much light arrives."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_choice, check_count, check_vectors
from photonloupe.device import Device
from photonloupe.errors import ArgumentError
from photonloupe.progress import ProgressLike, follow_progress

MAX_NEIGHBORS = 1000
KERNELS = ("epanechnikov", "disc", "cone", "gaussian")
# Best k of the unrelaxed ring caustic, 200,000 photons: 50 on Sobol emission, about 100 on random (METHODS section 7).
DEFAULT_K = {"sobol": 50, "random": 100}


def choose_k(settings: dict[str, Any]) -> int:
    """Return the number of photons an estimate gathers when nothing is said."""
    return DEFAULT_K.get(str(settings.get("emission")), DEFAULT_K["random"])


def find_neighbors(
    device: Device,
    photons: _engine.PhotonMap,
    points: ArrayLike,
    k: int,
    *,
    space: str = "world",
    progress: ProgressLike = None,
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """Check the query and run it; see `PhotonMap.neighbors`."""
    check_choice("space", space, ("world",))
    k = check_count("k", k, 1, MAX_NEIGHBORS)
    try:
        query = np.asarray(points)
    except ValueError:
        raise ArgumentError("points must have shape (n, 3), ids shape (n,)") from None
    ids: NDArray[np.uint32] | None = None
    vectors: NDArray[np.float64] | None = None
    if query.dtype.kind in "iu" and query.ndim == 1:
        outside = (query < 0) | (query >= photons.count)
        if outside.any():
            row = int(np.argmax(outside))
            raise ArgumentError(f"ids[{row}] = {query[row]} is not a photon; they run from 0 to {photons.count - 1}")
        ids = np.ascontiguousarray(query, dtype=np.uint32)
    elif query.dtype.kind in "iuf" and query.ndim == 2:
        vectors = check_vectors("points", query)
    else:
        raise ArgumentError(
            "points must be numbers of shape (n, 3), or ids whole numbers of shape (n,), "
            f"not {query.dtype} {query.shape}"
        )
    with follow_progress(progress) as callback:
        found, distances = _engine.find_neighbors(device._native, photons, vectors, ids, k, callback)
    return np.asarray(found), np.asarray(distances)


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
