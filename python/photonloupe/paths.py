# SPDX-License-Identifier: Apache-2.0
"""Ragged path columns: picking rows of them, matching signatures, and recording them by tracing again."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.checks import check_count
from photonloupe.columns import PATH_COLUMNS, PATH_NAMES, Columns
from photonloupe.device import Device
from photonloupe.errors import ArgumentError, PhotonLoupeError
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.scene import Scene

_NOT_FOUND = -1


def gather_paths(columns: Mapping[str, NDArray[Any]], rows: NDArray[np.int64]) -> Columns:
    """Pick the paths of `rows`, in that order, from whatever path columns there are."""
    if "path_offsets" not in columns:
        return {}
    offsets = columns["path_offsets"]
    lengths = np.diff(offsets)[rows]
    picked = np.zeros(len(rows) + 1, dtype=np.int64)
    np.cumsum(lengths, out=picked[1:])
    vertices = np.repeat(offsets[:-1][rows] - picked[:-1], lengths) + np.arange(picked[-1], dtype=np.int64)
    gathered: Columns = {"path_offsets": picked}
    for column in PATH_COLUMNS:
        if column.name in columns:
            gathered[column.name] = np.ascontiguousarray(columns[column.name][vertices])
    return gathered


def parse_signature(signature: str | int) -> NDArray[np.uint8]:
    """Turn a signature into its interactions, first one first.

    Parameters
    ----------
    signature
        Digits 1 (reflected) and 2 (transmitted) in the order of the path, as in ``"22"``,
        or the number of [SJL15] eq. 2, whose least significant base-3 digit is the first interaction.
    """
    if isinstance(signature, str):
        if set(signature) - {"1", "2"}:
            raise ArgumentError(f"a signature is made of 1 (reflected) and 2 (transmitted), not {signature!r}")
        return np.array([int(digit) for digit in signature], dtype=np.uint8)
    number = check_count("signature", signature, 0, 2**63 - 1)
    digits = []
    while number:
        number, digit = divmod(number, 3)
        if digit == 0:
            raise ArgumentError(f"signature {signature} has a digit 0 in base 3, which no interaction writes")
        digits.append(digit)
    return np.array(digits, dtype=np.uint8)


def match_signature(columns: Mapping[str, NDArray[Any]], signature: str | int) -> NDArray[np.int64]:
    """Ids of the photons whose interactions between emitter and storage point are `signature`."""
    wanted = parse_signature(signature)
    offsets = columns["path_offsets"]
    interactions = columns["path_interactions"]
    # Emitter and storage point are vertices too.
    ids = np.flatnonzero(np.diff(offsets) == len(wanted) + 2)
    inner = offsets[ids][:, None] + 1 + np.arange(len(wanted))
    return ids[(interactions[inner] == wanted).all(axis=1)]


def trace_paths(
    device: Device, scene: Scene, settings: Mapping[str, Any], emitted: int, *, progress: ProgressLike = None
) -> _engine.PhotonMap:
    """Trace the photons of `settings` and `emitted` once more, this time with their paths."""
    again = {**settings, "emitted": emitted, "paths": True}
    with follow_progress(progress) as callback:
        return _engine.trace_photons(device._native, scene._native, again, callback)


def find_traced_rows(columns: Mapping[str, NDArray[Any]], traced: _engine.PhotonMap) -> NDArray[np.int64]:
    """Row of every photon in a map traced with the same settings.

    Photons of one emitted index (a path can store several) are told apart by their position.

    Raises
    ------
    PhotonLoupeError
        If a photon is not found: the scene or the program changed since it was traced.
    """
    indices, positions = columns["emitted_index"], columns.get("traced_positions", columns["positions"])
    order = np.argsort(traced.emitted_index, kind="stable")
    sorted_index = np.asarray(traced.emitted_index)[order]
    first = np.searchsorted(sorted_index, indices, side="left")
    last = np.searchsorted(sorted_index, indices, side="right")
    rows = np.full(len(indices), _NOT_FOUND, dtype=np.int64)
    for step in range(int((last - first).max(initial=0))):
        open_rows = np.flatnonzero((rows == _NOT_FOUND) & (first + step < last))
        candidates = order[first[open_rows] + step]
        same = (np.asarray(traced.positions)[candidates] == positions[open_rows]).all(axis=1)
        rows[open_rows[same]] = candidates[same]
    lost = int(np.count_nonzero(rows == _NOT_FOUND))
    if lost:
        raise PhotonLoupeError(
            f"{lost} of {len(rows)} photons were not met again when their paths were traced: "
            "the scene, the program or the device differs from the one that made the map; trace it anew"
        )
    return rows


def read_path_columns(traced: _engine.PhotonMap) -> Columns:
    """Take the path columns out of a native map that recorded them."""
    columns = {name: getattr(traced, name) for name in PATH_NAMES}
    return {name: np.asarray(values) for name, values in columns.items() if values is not None}
