# SPDX-License-Identifier: Apache-2.0
"""Shoots photons from the lights of a scene and keeps those that land."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from photonloupe import _engine
from photonloupe.checks import check_choice, check_count
from photonloupe.columns import MAX_PHOTONS, PATH_NAMES, PHOTON_COLUMNS
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.photons import PhotonMap
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.provenance import describe_origin
from photonloupe.scene import Scene

EMISSIONS = ("sobol", "random")
STORES = ("caustic", "indirect", "all")
# Where tracing gives up on a scene that stores nothing, too (METHODS section 1).
MAX_EMITTED = 2**30
MAX_BOUNCES = 64
MAX_SEED = 2**32 - 1


def trace_photons(
    scene: Scene,
    count: int = 200_000,
    *,
    seed: int = 1,
    emitted: int | None = None,
    emission: str = "sobol",
    store: str = "caustic",
    max_bounces: int = 16,
    columns: Sequence[str] | None = None,
    device: Device | int | str | None = None,
    progress: ProgressLike = None,
) -> PhotonMap:
    """Trace photons until enough are stored.

    Parameters
    ----------
    scene
        What `load_scene` returned.
    count
        Least number of stored photons; photons are emitted in whole blocks of 4,096 until it is reached, so a
        larger map begins with the same paths (their flux is divided by all emitted).
    seed
        Every random number is a function of it, the emitted index, the bounce and the dimension, nothing else.
    emitted
        Number of photons to emit instead, whatever is stored.
    emission
        ``"sobol"`` (Owen-scrambled, worth about four times the photons on a smooth caustic) or ``"random"``.
    store
        ``"caustic"``: light that only mirrors and glass touched, L S+ D; ``"indirect"``: any bounce;
        ``"all"``: direct light too.
    max_bounces
        Longest path, 1 to 64; what is cut off appears in the report as truncated.
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
    settings = _check_settings(scene, count, seed, emitted, emission, store, max_bounces, columns)
    opened = open_device(device)
    with follow_progress(progress) as callback:
        native = _engine.trace_photons(opened._native, scene._native, settings, callback)
    return PhotonMap(
        native,
        opened,
        settings=settings,
        report=native.report,
        provenance=describe_origin(opened, scene, settings),
        scene=scene,
    )


def _check_settings(
    scene: Scene,
    count: int,
    seed: int,
    emitted: int | None,
    emission: str,
    store: str,
    max_bounces: int,
    columns: Sequence[str] | None,
) -> dict[str, Any]:
    if not isinstance(scene, Scene):
        raise ArgumentError(f"scene must come from load_scene, not {scene!r}")
    known = {*PATH_NAMES, *(column.name for column in PHOTON_COLUMNS)}
    asked = [columns] if isinstance(columns, str) else list(columns or ())
    for name in asked:
        check_choice("columns", name, sorted(known))
    return {
        "count": check_count("count", count, 1, MAX_PHOTONS),
        "emitted": 0 if emitted is None else check_count("emitted", emitted, 1, MAX_EMITTED),
        "seed": check_count("seed", seed, 0, MAX_SEED),
        "emission": check_choice("emission", emission, EMISSIONS),
        "store": check_choice("store", store, STORES),
        "max_bounces": check_count("max_bounces", max_bounces, 1, MAX_BOUNCES),
        "paths": any(name in PATH_NAMES for name in asked),
    }
