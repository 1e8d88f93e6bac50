# SPDX-License-Identifier: Apache-2.0
"""Shoots photons from the lights of a scene and keeps those that land."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

from photonloupe import _engine
from photonloupe.checks import check_choice
from photonloupe.columns import PATH_NAMES, PHOTON_COLUMNS
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.photons import PhotonMap
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.provenance import describe_origin
from photonloupe.scene import Scene
from photonloupe.setting_keywords import TraceKeywords
from photonloupe.settings import check_settings, takes_settings


@takes_settings("trace")
def trace_photons(
    scene: Scene,
    count: int | None = None,
    *,
    columns: Sequence[str] | None = None,
    device: Device | int | str | None = None,
    progress: ProgressLike = None,
    **settings: Unpack[TraceKeywords],
) -> PhotonMap:
    """Trace photons until enough are stored.

    A larger map begins with the same paths, their flux divided by all emitted.

    Parameters
    ----------
    scene
        What `load_scene` returned.
    {settings}
    columns
        Path columns to record now, such as ``["path_vertices"]``; by default none: they are recorded when first read.
    device
        A `Device`, its name or index; default the best there is.
    progress
        True for a bar with the time left, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    PhotonMap

    Raises
    ------
    ArgumentError
        If a setting is out of its range.
    SceneError
        If the scene has no light, or stores nothing; the message says why.
    DeviceError
        If no device is usable.
    Cancelled
        If the callback asked to stop.

    Examples
    --------
    >>> import photonloupe as pl
    >>> photons = pl.trace_photons(pl.load_scene("scenes/ring/ring.gltf"), count=10_000, seed=1)
    >>> len(photons) >= 10_000
    True
    """
    told = _check_settings(scene, columns, {**settings, "count": count})
    opened = open_device(device)
    with follow_progress(progress) as callback:
        native = _engine.trace_photons(opened._native, scene._native, told, callback)
    return PhotonMap(
        native,
        opened,
        settings=told,
        report=native.report,
        provenance=describe_origin(opened, scene, told),
        scene=scene,
    )


def _check_settings(scene: Scene, columns: Sequence[str] | None, given: dict[str, Any]) -> dict[str, Any]:
    if not isinstance(scene, Scene):
        raise ArgumentError(f"scene must come from load_scene, not {scene!r}")
    known = {*PATH_NAMES, *(column.name for column in PHOTON_COLUMNS)}
    asked = [columns] if isinstance(columns, str) else list(columns or ())
    for name in asked:
        check_choice("columns", name, sorted(known))
    return {**check_settings("trace", given), "paths": any(name in PATH_NAMES for name in asked)}
