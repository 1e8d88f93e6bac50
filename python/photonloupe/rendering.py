# SPDX-License-Identifier: Apache-2.0
"""Renders a scene with the light of its photon map."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Unpack

from numpy.typing import ArrayLike

from photonloupe import _engine
from photonloupe.camera import Camera, check_camera
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.image import Image
from photonloupe.photons import PhotonMap, check_map
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.provenance import describe_origin
from photonloupe.scene import Scene
from photonloupe.setting_keywords import RenderKeywords
from photonloupe.settings import check_settings, list_settings, takes_settings

MAX_SIDE = list_settings("render")["width"].limits[1]


@takes_settings("render")
def render(
    scene: Scene,
    photons: PhotonMap | None = None,
    *,
    camera: str | Camera | None = None,
    device: Device | int | str | None = None,
    progress: ProgressLike = None,
    **settings: Unpack[RenderKeywords],
) -> Image:
    """Render what a camera of the scene sees.

    Parameters
    ----------
    scene
        What `load_scene` returned.
    photons
        The map to gather from; only ``mode="direct"`` does without.
    camera
        Its name, or a `Camera` of your own; by default the scene's first, or one that fits the bounds if there is none.
    {settings}
    device
        A `Device`, its name or index; default the best there is.
    progress
        True for a bar with the time left, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    Image
        Linear radiance, W/(m²·sr), (height, width, 3).

    Raises
    ------
    ArgumentError
        If a setting is out of its range, the camera is not there, or the mode needs photons.
    DeviceError
        If no device is usable.

    Examples
    --------
    >>> import photonloupe as pl
    >>> scene = pl.load_scene("scenes/ring/ring.gltf")
    >>> pl.render(scene, pl.trace_photons(scene, count=10_000), camera="top", width=32, height=32)
    <Image 32 × 32, linear>
    """
    told = _check_settings(scene, photons, camera, check_settings("render", settings))
    opened = open_device(device)
    native = None if photons is None else photons._native
    with follow_progress(progress) as callback:
        pixels = _engine.render_image(opened._native, scene._native, native, told, callback)
    return describe_image(pixels, opened, scene, photons, told)


def describe_image(
    pixels: ArrayLike, device: Device, scene: Scene, photons: PhotonMap | None, told: Mapping[str, Any]
) -> Image:
    """Say what made a picture; settings as the engine took them."""
    native = None if photons is None else photons._native
    k = _engine.choose_k(native) if told["k"] is None else told["k"]
    provenance = describe_origin(device, scene, {**told, "k": k})
    if photons is not None:
        provenance["photons"] = {"stored": len(photons), "emitted": photons.emitted, "settings": photons.settings}
        if photons.relaxation:
            provenance["photons"]["relaxation"] = photons.relaxation["settings"]
    return Image(pixels, provenance=provenance)


def _check_settings(
    scene: Scene, photons: PhotonMap | None, camera: str | Camera | None, settings: dict[str, Any]
) -> dict[str, Any]:
    if not isinstance(scene, Scene):
        raise ArgumentError(f"scene must come from load_scene, not {scene!r}")
    if photons is not None:
        check_map(photons)
    elif settings["mode"] != "direct":
        raise ArgumentError(f'mode="{settings["mode"]}" needs a photon map; trace_photons makes one')
    return {**settings, "camera": check_camera(scene, camera)}
