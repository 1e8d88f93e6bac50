# SPDX-License-Identifier: Apache-2.0
"""Renders a scene with the light of its photon map."""

from __future__ import annotations

from typing import Any

from photonloupe import _engine, queries
from photonloupe.camera import Camera, check_camera
from photonloupe.checks import check_choice, check_count
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.image import Image
from photonloupe.photons import PhotonMap
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.provenance import describe_origin
from photonloupe.scene import Scene
from photonloupe.tracing import MAX_SEED

MODES = ("composite", "caustic", "direct", "photons", "false-color", "voronoi")
MAX_SIDE = 16_384
MAX_SAMPLES = 65_536


def render(
    scene: Scene,
    photons: PhotonMap | None = None,
    *,
    camera: str | Camera | None = None,
    width: int = 512,
    height: int = 512,
    samples: int = 4,
    mode: str = "composite",
    k: int | None = None,
    kernel: str = "epanechnikov",
    seed: int = 1,
    device: Device | int | str | None = None,
    progress: ProgressLike = None,
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
    width, height
        In pixels; the camera's vertical angle is kept whatever the aspect.
    samples
        Per pixel, box filter.
    mode
        ``"composite"`` emission + direct light + map, ``"caustic"`` the map alone, ``"direct"`` direct light alone,
        ``"photons"`` the stored photons as dots, ``"false-color"`` the mean color a script gave the photons around
        times the luminance of their irradiance, ``"voronoi"`` the cells of the photons on the surfaces seen, in the
        colors a script gave, else in one of its own each (`photonloupe.inspect.voronoi` tells which is which).
    k, kernel
        As in `PhotonMap.irradiance`.
    seed
        Of the samples within the pixel.
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
    settings = _check_settings(scene, photons, camera, width, height, samples, mode, k, kernel, seed)
    opened = open_device(device)
    native = None if photons is None else photons._native
    with follow_progress(progress) as callback:
        pixels = _engine.render_image(opened._native, scene._native, native, settings, callback)
    provenance = describe_origin(opened, scene, settings)
    if photons is not None:
        provenance["photons"] = {"stored": len(photons), "emitted": photons.emitted, "settings": photons.settings}
        if photons.relaxation:
            provenance["photons"]["relaxation"] = photons.relaxation["settings"]
    return Image(pixels, provenance=provenance)


def _check_settings(
    scene: Scene,
    photons: PhotonMap | None,
    camera: str | Camera | None,
    width: int,
    height: int,
    samples: int,
    mode: str,
    k: int | None,
    kernel: str,
    seed: int,
) -> dict[str, Any]:
    if not isinstance(scene, Scene):
        raise ArgumentError(f"scene must come from load_scene, not {scene!r}")
    if photons is not None and not isinstance(photons, PhotonMap):
        raise ArgumentError(f"photons must be a PhotonMap, not {photons!r}")
    check_choice("mode", mode, MODES)
    if photons is None and mode != "direct":
        raise ArgumentError(f'mode="{mode}" needs a photon map; trace_photons makes one')
    if k is None:
        k = queries.choose_k(photons.settings if photons is not None else {})
    return {
        "camera": check_camera(scene, camera),
        "width": check_count("width", width, 1, MAX_SIDE),
        "height": check_count("height", height, 1, MAX_SIDE),
        "samples": check_count("samples", samples, 1, MAX_SAMPLES),
        "mode": mode,
        "k": check_count("k", k, 1, queries.MAX_NEIGHBORS),
        "kernel": check_choice("kernel", kernel, queries.KERNELS),
        "seed": check_count("seed", seed, 0, MAX_SEED),
    }
