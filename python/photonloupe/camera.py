# SPDX-License-Identifier: Apache-2.0
"""Cameras of one's own, beside those of the scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

from photonloupe import _engine
from photonloupe.checks import check_number, check_vector
from photonloupe.errors import ArgumentError
from photonloupe.scene import Scene

_LARGEST = 1e30


@dataclass(frozen=True)
class Camera:
    """A perspective camera.

    Attributes
    ----------
    position, target
        Where it stands and where it looks, (3,) m.
    up
        Which way is up in its image, roughly: (3,), not along the view.
    yfov
        Vertical angle of view, radians, up to 3.

    Examples
    --------
    >>> import photonloupe as pl
    >>> scene = pl.load_scene("scenes/ring/ring.gltf")
    >>> camera = pl.Camera(position=(0, 3, 3), target=(0, 0, 0), yfov=0.7)
    >>> pl.render(scene, pl.trace_photons(scene, count=10_000), camera=camera, width=32, height=32)
    <Image 32 × 32, linear>
    """

    position: Sequence[float]
    target: Sequence[float]
    up: Sequence[float] = (0.0, 1.0, 0.0)
    yfov: float = 0.8


def check_camera(scene: Scene, camera: str | Camera | None) -> str | dict[str, Any]:
    """Check a camera's name, or work out the axes of one of the user's own.

    Raises
    ------
    ArgumentError
        If the scene has no camera of that name, or a camera looks nowhere.
    """
    if isinstance(camera, Camera):
        position, target, up = (
            check_vector(f"the camera's {name}", getattr(camera, name), -_LARGEST, _LARGEST)
            for name in ("position", "target", "up")
        )
        return dict(_engine.aim_camera(position, target, up, check_number("yfov", camera.yfov, 1e-4, 3.0)))
    names = [str(entry["name"]) for entry in scene.cameras]
    if camera is not None and camera not in names:
        there = f"there are {', '.join(names)}" if names else "the scene has none"
        raise ArgumentError(f"there is no camera {camera!r}; {there}")
    return camera or ""
