# SPDX-License-Identifier: Apache-2.0
"""What the studio has made, as Python's maps, scenes and pictures."""

from __future__ import annotations

from typing import Any

from photonloupe import _engine
from photonloupe.device import Device
from photonloupe.image import Image
from photonloupe.photons import PhotonMap
from photonloupe.provenance import describe_origin
from photonloupe.relaxing import describe_relaxation
from photonloupe.rendering import describe_image
from photonloupe.scene import Scene


class Results:
    """Views of what the engine's stages hold now; the same as long as that stays."""

    def __init__(self, native: _engine.Studio, device: Device) -> None:
        self._native = native
        self._device = device
        self._scene: Scene | None = None
        self._photons: PhotonMap | None = None
        self._relaxed: PhotonMap | None = None

    @property
    def scene(self) -> Scene | None:
        """The scene the photons lie in."""
        return self._wrap_scene(self._native.made()["scene"])

    @property
    def photons(self) -> PhotonMap | None:
        """The photons with what the script gave them."""
        made = self._native.made()
        native = made["photons"]
        if native is None or self._photons is None or self._photons._native is not native:
            self._photons = None if native is None else self._describe(native, made)
        return self._photons

    @property
    def relaxed(self) -> PhotonMap | None:
        """The relaxed photons, if any."""
        made, photons = self._native.made(), self.photons
        native = made["relaxed"]
        if native is None or photons is None:
            self._relaxed = None
        elif self._relaxed is None or self._relaxed._native is not native:
            told = describe_relaxation(made["relaxation"], self._wrap_scene(made["scene"]))
            self._relaxed = photons.replace(native, told)
        return self._relaxed

    @property
    def image(self) -> Image | None:
        """The last rendered view."""
        rendered, scene = self._native.rendered(), self.scene
        if rendered is None or scene is None:
            return None
        pixels, told, is_relaxed = rendered
        return describe_image(pixels, self._device, scene, self.relaxed if is_relaxed else self.photons, told)

    def _wrap_scene(self, native: _engine.Scene | None) -> Scene | None:
        if native is None or self._scene is None or self._scene._native is not native:
            self._scene = None if native is None else Scene(native)
        return self._scene

    def _describe(self, native: _engine.PhotonMap, made: dict[str, Any]) -> PhotonMap:
        told, scene = made["trace"], self._wrap_scene(made["scene"])
        if told is None:
            photons: PhotonMap = made["origin"].replace(native)
        else:
            origin = describe_origin(self._device, scene, told)
            photons = PhotonMap(
                native, self._device, settings=told, report=native.report, provenance=origin, scene=scene
            )
        if made["script"] is not None:
            photons.take_script(made["script"])
        return photons
