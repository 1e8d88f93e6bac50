# SPDX-License-Identifier: Apache-2.0
"""A glTF scene as Python sees it: what is in it, and what was left out."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine


class Scene:
    """A loaded scene; made by `load_scene`."""

    def __init__(self, native: _engine.Scene) -> None:
        self._native = native

    @property
    def path(self) -> Path:
        """The file it was read from."""
        return Path(self._native.path)

    @property
    def hash(self) -> str:
        """Hash of the file and of every buffer it uses, hexadecimal."""
        return str(self._native.hash)

    @property
    def bounds(self) -> NDArray[np.float64]:
        """Lower and upper corner, (2, 3), m."""
        return np.asarray(self._native.bounds, dtype=np.float64).reshape(2, 3)

    @property
    def origin(self) -> NDArray[np.float64]:
        """World position the kernels count from, (3,), m."""
        return np.asarray(self._native.origin, dtype=np.float64).reshape(3)

    @property
    def cameras(self) -> list[dict[str, Any]]:
        """One entry per camera: name, position, axes, yfov."""
        return [dict(row) for row in self._native.cameras]

    @property
    def lights(self) -> list[dict[str, Any]]:
        """One entry per light: name, kind, position, intensity (W/sr per channel)."""
        return [dict(row) for row in self._native.lights]

    @property
    def materials(self) -> list[dict[str, Any]]:
        """One entry per material."""
        return [dict(row) for row in self._native.materials]

    @property
    def objects(self) -> list[dict[str, Any]]:
        """One entry per drawn primitive: name, material, triangle count; photons refer to these."""
        return [dict(row) for row in self._native.objects]

    @property
    def report(self) -> dict[str, Any]:
        """What was ignored, changed (notes), required of the kernels, and left out of them."""
        return dict(self._native.report)

    @property
    def triangle_count(self) -> int:
        """Number of triangles."""
        return int(self._native.triangle_count)

    def describe(self) -> str:
        """Account of the scene in a few lines, as ``photonloupe doctor SCENE`` prints it."""
        return str(self._native.describe())

    def __repr__(self) -> str:
        size = self.bounds[1] - self.bounds[0]
        return (
            f"<Scene {self.path.name}: {self.triangle_count:,} triangles, {len(self.lights)} lights, "
            f"cameras {[camera.get('name') for camera in self.cameras]}, "
            f"{size[0]:.3g} × {size[1]:.3g} × {size[2]:.3g} m>"
        )


def load_scene(path: str | os.PathLike[str]) -> Scene:
    """Read a glTF scene (.gltf or .glb).

    Parameters
    ----------
    path
        The file; buffers and images are looked for in its folder and below only.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        If the file is missing, malformed, refers outside its folder, or requires an extension that is not modelled.

    Examples
    --------
    >>> import photonloupe as pl
    >>> scene = pl.load_scene("scenes/ring/ring.gltf")
    >>> [camera["name"] for camera in scene.cameras]
    ['top', 'view', 'close']
    """
    return Scene(_engine.load_scene(os.fspath(path)))
