# SPDX-License-Identifier: Apache-2.0
"""How much light arrives: estimates of irradiance and fluence asked of a photon map."""

from __future__ import annotations

from typing import Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_vectors
from photonloupe.device_photons import DevicePhotons
from photonloupe.errors import ArgumentError
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.setting_keywords import IrradianceKeywords
from photonloupe.settings import check_settings


def estimate_irradiance(
    photons: DevicePhotons,
    points: ArrayLike,
    normals: ArrayLike,
    *,
    progress: ProgressLike = None,
    **given: Unpack[IrradianceKeywords],
) -> NDArray[np.float32]:
    """Check the query and run it; see `PhotonMap.irradiance`."""
    settings = check_settings("irradiance", given)
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
    native = photons.device._native
    with follow_progress(progress) as callback:
        return np.asarray(_engine.estimate_irradiance(native, photons._native, where, unit, settings, callback))


def estimate_fluence(
    photons: DevicePhotons, points: ArrayLike, k: int | None, progress: ProgressLike
) -> NDArray[np.float32]:
    """Check the query and run it; see `PhotonMap.fluence`."""
    settings = check_settings("irradiance", {"k": k})
    where = check_vectors("points", points)
    scene = photons.find_surface()
    if scene is None:
        raise ArgumentError("the map knows of no scene, whose media fluence is asked of; trace one")
    native = photons.device._native
    with follow_progress(progress) as callback:
        return np.asarray(_engine.estimate_fluence(native, photons._native, scene._native, where, settings, callback))
