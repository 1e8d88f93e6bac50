# SPDX-License-Identifier: Apache-2.0
"""Reads photon maps back from disk."""

from __future__ import annotations

import os

from photonloupe import _engine, storage
from photonloupe.device import Device, open_device
from photonloupe.errors import FileFormatError
from photonloupe.parameters import list_axes, read_parameters
from photonloupe.photons import MAX_EMITTED, PhotonMap
from photonloupe.settings import list_settings


def load_photons(path: str | os.PathLike[str], *, device: Device | int | str | None = None) -> PhotonMap:
    """Read a map that `PhotonMap.save` wrote.

    Parameters
    ----------
    path
        The Zarr folder.
    device
        Where queries will run.

    Returns
    -------
    PhotonMap

    Raises
    ------
    FileFormatError
        If the folder is missing, is not a photon map, or an array in it is damaged; the message names which.
    """
    columns, meta = storage.read_map(path)
    values = columns.get("parameters")
    axes = [] if values is None else list_axes(read_parameters(meta.get("parameters", []), values))
    opened = open_device(device)
    # What a map stores decides what a composite adds to it, how it was emitted what suits it.
    origin = {name: meta["settings"][name] for name in ("store", "emission") if name in meta["settings"]}
    is_known = all(value in list_settings("trace")[name].choices for name, value in origin.items())
    if not is_known or not 0 <= meta["emitted"] <= MAX_EMITTED:
        raise FileFormatError(f"{path} does not say rightly what was emitted and stored; save the map again")
    return PhotonMap(
        _engine.photons_from_columns(opened._native, columns, axes, origin, meta["emitted"]),
        opened,
        settings=meta["settings"],
        report=meta["report"],
        provenance=meta["provenance"],
        relaxation=meta.get("relaxation"),
    )
