# SPDX-License-Identifier: Apache-2.0
"""Python's part of the studio's work: maps from Zarr folders, and FLIP. The engine asks for it, from its own thread."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.device import Device
from photonloupe.errors import PhotonLoupeError
from photonloupe.image import load_image
from photonloupe.inspect.error_map import error_map
from photonloupe.loading import load_photons
from photonloupe.metrics import compare_images
from photonloupe.photons import PhotonMap

Pixels = NDArray[np.float32]
Found = TypeVar("Found")
LoadedMap = tuple[PhotonMap, _engine.PhotonMap, "_engine.Scene | None", list[str]]


def load_map(path: str, *, device: Device) -> LoadedMap:
    """Return a map as Python has it and as the engine has it, the scene it lies in, and what is missing."""
    photons = load_photons(path, device=device)
    remarks: list[str] = []
    scene = _try("scene", photons.find_surface, remarks)
    _try("paths", photons.record_paths, remarks)
    return photons, photons._native, None if scene is None else scene._native, remarks


def _try(what: str, find: Callable[[], Found], remarks: list[str]) -> Found | None:
    try:
        return find()
    except PhotonLoupeError as error:
        remarks.append(f"without {what}: {error}")
        return None


def compare_with_file(image: Pixels, path: str) -> tuple[Pixels, Pixels | None, float, float, float, str]:
    """Return a reference's pixels, the error map, rmse, relmse and FLIP; or why there are none."""
    reference = load_image(path)
    pixels = np.ascontiguousarray(reference)
    try:
        difference = compare_images(image, reference)
    except PhotonLoupeError as error:
        return pixels, None, 0.0, 0.0, 0.0, str(error)
    colored = np.ascontiguousarray(error_map(image, reference).image)
    return pixels, colored, difference.rmse, difference.relmse, difference.flip, ""
