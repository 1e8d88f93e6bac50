# SPDX-License-Identifier: Apache-2.0
"""Who is near: exact neighbor queries in world space, in parameter space, and among a photon's layer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_number, check_rows, check_vectors
from photonloupe.device_photons import DevicePhotons
from photonloupe.errors import ArgumentError
from photonloupe.isotropy import check_beta
from photonloupe.parameters import FIRST_DIMENSION, Parameter
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.settings import list_settings

Found = tuple[NDArray[np.int32], NDArray[np.float32]]


def find_neighbors(
    photons: DevicePhotons,
    points: ArrayLike,
    k: int,
    *,
    space: str | None = None,
    beta: float | str | None = None,
    center: int | None = None,
    ranges: Mapping[int | str, tuple[float, float]] | None = None,
    progress: ProgressLike = None,
) -> Found:
    """Check the query and run it; see `PhotonMap.neighbors`."""
    k, query, reach = check_look(photons, k, space, beta, center, ranges)
    ids, vectors = _read_query(photons, points, query["space"])
    if query["space"] == "constrained":
        if ids is None and (center is None) == (ranges is None):
            raise ArgumentError("points in the constrained space need either center= or ranges=")
        query.update(check_layer(photons, ids is not None, reach, center, ranges, progress))
    with follow_progress(progress) as callback:
        device = photons.device._native
        found, distances = _engine.find_neighbors(device, photons._native, vectors, ids, k, query, callback)
    return np.asarray(found), np.asarray(distances)


def check_look(
    photons: DevicePhotons, k: Any, space: Any, beta: Any, center: Any, ranges: Any
) -> tuple[int, dict[str, Any], float | str]:
    """Check how many photons are looked at, and where; β, center and ranges are checked where they count."""
    known = list_settings("loupe")
    k, space = known["k"].check(k), known["space"].check(space)
    if space != "constrained" and (center is not None or ranges is not None):
        raise ArgumentError('center and ranges lock the layer of space="constrained"')
    if space != "world" and "parameters" not in photons.recorded:
        raise ArgumentError(f'space="{space}" needs parameters; set_parameters() or a script sets them')
    query = {"space": space, "beta": 0.0, "center": None, "low": None, "high": None}
    return k, query, known["beta"].default if beta is None else beta


def _read_query(
    photons: DevicePhotons, points: ArrayLike, space: str
) -> tuple[NDArray[np.uint32] | None, NDArray[np.float64] | None]:
    """Tell ids from points, and check either."""
    width = len(photons.parameter_names) if space == "parameter" else 3
    try:
        query = np.asarray(points)
    except ValueError:
        raise ArgumentError(f"points must have shape (n, {width}), ids shape (n,)") from None
    if query.dtype.kind in "iu" and query.ndim == 1:
        return np.ascontiguousarray(check_rows(query, len(photons)), dtype=np.uint32), None
    if query.dtype.kind in "iuf" and query.ndim == 2:
        return None, check_vectors("points", query, width)
    raise ArgumentError(
        f"points must be numbers of shape (n, {width}), or ids whole numbers of shape (n,), "
        f"not {query.dtype} {query.shape}"
    )


def check_layer(
    photons: DevicePhotons,
    has_ids: bool,
    beta: float | str,
    center: int | None,
    ranges: Mapping[int | str, tuple[float, float]] | None,
    progress: ProgressLike,
) -> dict[str, Any]:
    """Who belongs to the layer: neighbors of each photon, of one photon, or whoever lies within ranges."""
    if has_ids and (center is not None or ranges is not None):
        raise ArgumentError("photons have layers of their own; center and ranges lock the layer around points")
    if center is not None and ranges is not None:
        raise ArgumentError("center and ranges both lock the layer; give one of them")
    if ranges is not None:
        low, high = read_ranges(photons.parameter_list, ranges)
        return {"low": low, "high": high}
    checked = check_beta(beta, photons, progress)
    return {
        "beta": checked,
        "center": None if center is None else check_count("center", center, 0, len(photons) - 1),
    }


def read_ranges(
    parameters: tuple[Parameter, ...], ranges: Mapping[int | str, tuple[float, float]]
) -> tuple[list[float], list[float]]:
    """Check ranges and spread them over all parameters; those not named have none."""
    largest = float(np.finfo(np.float32).max)
    low, high = [-largest] * len(parameters), [largest] * len(parameters)
    names = [parameter.name for parameter in parameters]
    for key, pair in ranges.items():
        index = names.index(key) if key in names else key - FIRST_DIMENSION if isinstance(key, int) else -1
        if not 0 <= index < len(names):
            dimensions = f"{FIRST_DIMENSION} to {FIRST_DIMENSION + len(names) - 1}"
            raise ArgumentError(f"ranges names {key!r}; the parameters are {', '.join(names)}, dimensions {dimensions}")
        if len(tuple(pair)) != 2:
            raise ArgumentError(f"ranges[{key!r}] must be (low, high), not {pair!r}")
        low[index] = check_number(f"ranges[{key!r}]", pair[0], -largest, largest)
        high[index] = check_number(f"ranges[{key!r}]", pair[1], -largest, largest)
        if low[index] > high[index] and not parameters[index].periodic:
            raise ArgumentError(
                f"ranges[{key!r}] runs from {pair[0]} down to {pair[1]}; only a periodic parameter goes over the seam"
            )
    return low, high
