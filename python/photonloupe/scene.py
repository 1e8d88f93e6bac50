# SPDX-License-Identifier: Apache-2.0
"""A glTF scene as Python sees it: what is in it, and what was left out."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_choice, check_number, check_path, check_vector
from photonloupe.errors import ArgumentError

_LARGEST = 1e30  # of a coordinate or a power
_LONGEST = 1e9  # s

# What is told of each kind of light that can be added.
LIGHTS = {
    "point": ("position", "intensity", "color"),
    "spot": ("position", "direction", "intensity", "color", "cone"),
    "directional": ("direction", "intensity", "color"),
    "area": ("position", "direction", "intensity", "color", "size"),
    "environment": ("intensity", "color"),
    "auto": (),
}


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
        """One entry per light: name, kind, position, intensity per channel, and what its kind has (`add_light`).

        Of an environment by an image, the intensity is the mean radiance.
        """
        return [dict(row) for row in self._native.lights]

    @property
    def materials(self) -> list[dict[str, Any]]:
        """One entry per material: its factors, which textures multiply.

        Colors are linear, absorption is in 1/m, emission in W/(m² sr).
        """
        return [dict(row) for row in self._native.materials]

    @property
    def objects(self) -> list[dict[str, Any]]:
        """One entry per drawn primitive: name, material, triangle count; photons refer to these."""
        return [dict(row) for row in self._native.objects]

    @property
    def report(self) -> dict[str, Any]:
        """What was ignored, changed (notes), required of the kernels, and left out of them."""
        return dict(self._native.report)

    def add_light(
        self,
        kind: str,
        *,
        position: ArrayLike = (0.0, 0.0, 0.0),
        direction: ArrayLike = (0.0, -1.0, 0.0),
        intensity: float = 1.0,
        color: ArrayLike = (1.0, 1.0, 1.0),
        size: ArrayLike = (1.0, 1.0),
        cone: ArrayLike = (0.0, math.pi / 4.0),
        image: str | os.PathLike[str] | None = None,
        rotation: float = 0.0,
    ) -> None:
        """Add a light to what the file holds; photon maps and pictures made before stay as they are.

        Parameters
        ----------
        kind
            ``"point"``, ``"spot"``, ``"directional"``, ``"area"`` or ``"environment"``, light from all around, the
            same everywhere or as an image says; ``"auto"``: a point light above and before the bounds, of which
            nothing else is asked.
        position
            (3,) m; of an area light the middle.
        direction
            (3,), where a spot, directional or area light shines.
        intensity
            On the axis: W/sr; directional: W/m² across the light; area, environment: radiance, W/(m²·sr), of an image
            the factor that makes it so.
        color
            (3,) factors of the channels.
        size
            (2,) m, sides of an area light.
        cone
            (2,) radians from a spot's axis: where it begins to fade, and where it is dark, up to π/2.
        image
            Of an environment: an equirectangular EXR file, twice as wide as high, at most 8192 × 4096. Its upper border
            is +y, its middle +x, and what is right of the middle lies towards +z; each texel is one radiance. Negative
            values count as 0. Maps and sessions keep the path and a hash of the file, and refuse it once it changed.
        rotation
            Radians the image is turned about y, counter-clockwise seen from above, -2π to 2π.

        Raises
        ------
        ArgumentError
            If a value is out of range.
        SceneError
            If the direction is zero, the cone is inside out, or the image is black, not finite, or of another shape.

        Examples
        --------
        >>> import photonloupe as pl
        >>> scene = pl.load_scene("scenes/ring/ring.gltf")
        >>> scene.add_light("spot", position=(0, 2, 0), intensity=5.0, cone=(0.1, 0.3))
        >>> [light["kind"] for light in scene.lights]
        ['point', 'spot']
        """
        told = {
            "kind": check_choice("kind", kind, LIGHTS),
            "position": check_vector("position", position, -_LARGEST, _LARGEST),
            "direction": check_vector("direction", direction, -_LARGEST, _LARGEST),
            "intensity": check_number("intensity", intensity, 0.0, _LARGEST),
            "color": check_vector("color", color, 0.0, _LARGEST),
            "size": check_vector("size", size, 1e-30, _LARGEST, width=2),
            "cone": check_vector("cone", cone, 0.0, math.pi / 2.0, width=2),
        }
        names = ("kind", *LIGHTS[kind])
        if image is not None:
            if kind != "environment":
                raise ArgumentError(f'image is what an environment shows, not a {kind} light; say kind="environment"')
            told["image"] = str(check_path("image", image).absolute())
            told["rotation"] = check_number("rotation", rotation, -2.0 * math.pi, 2.0 * math.pi)
            names = (*names, "image", "rotation")
        self.restore([{"add": "light", **{name: told[name] for name in names}}])

    def add_floor(self, y: float | None = None) -> None:
        """Add a diffuse square of albedo 0.5 below the scene, four times as wide.

        Parameters
        ----------
        y
            Its height, m; default a thousandth of the scene's radius below the lowest point.
        """
        self.restore([{"add": "floor", "y": None if y is None else check_number("y", y, -_LARGEST, _LARGEST)}])

    @property
    def additions(self) -> list[dict[str, Any]]:
        """What was added to the file's, in order."""
        return [json.loads(text) for text in self._native.additions]

    def restore(self, additions: Sequence[Mapping[str, Any]]) -> None:
        """Add what another scene of the same file has as `additions`."""
        native = self._native
        for addition in additions:
            native = _engine.add_to_scene(native, json.dumps(addition, sort_keys=True))
        self._native = native

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


def load_scene(path: str | os.PathLike[str], *, time: float | None = None) -> Scene:
    """Read a glTF scene (.gltf or .glb).

    Parameters
    ----------
    path
        The file; buffers and images are looked for in its folder and below only.
    time
        Seconds: things are where the file's first animation has them then; default: at rest.

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
    name = os.fspath(path)
    try:
        name.encode()
    except UnicodeEncodeError:
        raise _engine.SceneError(f"{name!r}: its name is no UTF-8, which files of scenes need; rename it") from None
    scene = Scene(_engine.load_scene(name))
    if time is not None:
        scene.restore([{"add": "time", "time": check_number("time", time, -_LONGEST, _LONGEST)}])
    return scene
