# SPDX-License-Identifier: Apache-2.0
"""A photon map on its device, with what made it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Self

from photonloupe import _engine
from photonloupe.device import Device
from photonloupe.errors import PhotonLoupeError
from photonloupe.photon_columns import PhotonColumns
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.provenance import reload_scene
from photonloupe.scene import Scene


class DevicePhotons(PhotonColumns):
    """What the stages need of a photon map: the engine's map, and where it came from."""

    def __init__(
        self,
        native: _engine.PhotonMap,
        device: Device,
        *,
        settings: Mapping[str, Any] | None = None,
        report: Mapping[str, Any] | None = None,
        provenance: Mapping[str, Any] | None = None,
        scene: Scene | None = None,
        relaxation: Mapping[str, Any] | None = None,
    ) -> None:
        self._native = native
        self._device = device
        self._views = {}
        self._settings = dict(settings or {})
        self._report = dict(report or {})
        self._provenance = dict(provenance or {})
        self._scene = scene
        self._relaxation = dict(relaxation or {})

    @property
    def emitted(self) -> int:
        """Number of photons emitted for this map."""
        return int(self._native.emitted)

    @property
    def settings(self) -> dict[str, Any]:
        """What `trace_photons` was asked for; empty for a map from arrays."""
        return dict(self._settings)

    @property
    def report(self) -> dict[str, Any]:
        """Balance of the tracing: paths and flux emitted, absorbed, escaped, truncated, ended on a receiver."""
        return dict(self._report)

    @property
    def provenance(self) -> dict[str, Any]:
        """Version, device, driver, scene and settings that made this map."""
        return dict(self._provenance)

    @property
    def relaxation(self) -> dict[str, Any]:
        """Settings and steps of the relaxation that made this map; empty for one that was not relaxed."""
        return dict(self._relaxation)

    @property
    def device(self) -> Device:
        """Where queries run."""
        return self._device

    @property
    def can_have_paths(self) -> bool:
        """Whether the map holds paths, or may record them by tracing the same photons again."""
        return "path_offsets" in self.recorded or bool(self._settings)

    def record_paths(self, *, progress: ProgressLike = None) -> None:
        """Record the paths, by tracing the photons again, unless they are there.

        Raises
        ------
        PhotonLoupeError
            If the map was not traced, or its photons are not met again: the scene or the program changed since.
        """
        if "path_offsets" in self.recorded:
            return
        if not self._settings:
            raise PhotonLoupeError("this map was not traced here, so paths that it lacks cannot be recorded")
        # How many were emitted the map knows; old files have 0 where nothing was said.
        scene, settings = self._find_scene(), {**self._settings, "emitted": None, "paths": True}
        with follow_progress(progress) as callback:
            _engine.record_paths(self._device._native, self._native, scene._native, settings, callback)

    def take_script(self, script: Mapping[str, Any]) -> None:
        """Note the script that gave the engine's map other parameters and colors."""
        self._views.pop("parameters", None)
        self._views.pop("colors", None)
        self._provenance["script"] = dict(script)

    def find_surface(self) -> Scene | None:
        """Return the scene whose surfaces the photons lie on; None for a map from arrays without one."""
        return self._find_scene() if self._scene is not None or "scene_path" in self._provenance else None

    def share(self) -> Self:
        """Return the same photons in the same memory, for a script to give other parameters and colors."""
        return self.replace(_engine.share_photons(self._device._native, self._native))

    def replace(self, native: _engine.PhotonMap, relaxation: Mapping[str, Any] | None = None) -> Self:
        """Return another map of the same origin: some of the photons, or where a relaxation put them."""
        relaxed = {} if relaxation is None else {"relaxation": relaxation["settings"]}
        return type(self)(
            native,
            self._device,
            settings=self._settings,
            report=self._report,
            provenance={**self._provenance, **relaxed},
            scene=self._scene,
            relaxation=relaxation or self._relaxation,
        )

    def _find_scene(self) -> Scene:
        """Return the scene the map was traced in, loading it again if its file is unchanged."""
        if self._scene is None:
            self._scene = reload_scene(self._provenance)
        return self._scene
