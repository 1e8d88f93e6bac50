# SPDX-License-Identifier: Apache-2.0
"""Reads photon maps back from disk."""

from __future__ import annotations

import os

from photonloupe import storage
from photonloupe.device import Device
from photonloupe.parameters import read_parameters
from photonloupe.photons import PhotonMap


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
    return PhotonMap(
        columns,
        emitted=meta["emitted"],
        settings=meta["settings"],
        report=meta["report"],
        provenance=meta["provenance"],
        device=device,
        parameters=() if values is None else read_parameters(meta.get("parameters", []), values),
        relaxation=meta.get("relaxation"),
    )
