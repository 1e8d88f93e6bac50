# SPDX-License-Identifier: Apache-2.0
"""Photons with their copy on the device: uploaded when first asked, their paths recorded when first read."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.columns import PATH_NAMES, PHOTON_COLUMNS, RELAXED_NAMES, Columns
from photonloupe.device import Device, open_device
from photonloupe.errors import PhotonLoupeError
from photonloupe.parameters import Parameter
from photonloupe.paths import find_traced_rows, gather_paths, read_path_columns, trace_paths
from photonloupe.photon_columns import PhotonColumns
from photonloupe.provenance import reload_scene
from photonloupe.scene import Scene


class DevicePhotons(PhotonColumns):
    """What the stages need of a photon map: columns, where they came from, and the map on the device."""

    def __init__(
        self,
        columns: Columns,
        *,
        emitted: int,
        settings: Mapping[str, Any] | None = None,
        report: Mapping[str, Any] | None = None,
        provenance: Mapping[str, Any] | None = None,
        scene: Scene | None = None,
        device: Device | int | str | None = None,
        native: _engine.PhotonMap | None = None,
        parameters: Sequence[Parameter] = (),
        relaxation: Mapping[str, Any] | None = None,
    ) -> None:
        self._columns: Columns = {}
        self._add_columns(columns)
        self._emitted = emitted
        self._settings = dict(settings or {})
        self._report = dict(report or {})
        self._provenance = dict(provenance or {})
        self._scene = scene
        self._device = device
        self._native = native
        self._parameters = tuple(parameters)
        self._relaxation = dict(relaxation or {})
        self._has_uploaded_paths = False

    @property
    def emitted(self) -> int:
        """Number of photons emitted for this map."""
        return self._emitted

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
    def device(self) -> Device | int | str | None:
        """Where queries run."""
        return self._device

    def upload(self) -> _engine.PhotonMap:
        """Return the map on the device, uploaded the first time."""
        if self._native is None:
            columns = {column.name: np.ascontiguousarray(self._columns[column.name]) for column in PHOTON_COLUMNS}
            # What a map stores decides what a composite adds to it.
            store = str(self._settings.get("store", "caustic"))
            device = open_device(self._device)._native
            self._native = _engine.photons_from_columns(device, columns, store)
            self._upload_parameters()
            self._upload_colors()
            self._upload_state()
        return self._native

    def upload_columns(self, names: Sequence[str]) -> _engine.PhotonMap:
        """Return the map on the device with the path columns a script reads, recorded now if need be."""
        native = self.upload()
        wanted = [name for name in PATH_NAMES if name in names]
        if not wanted:
            return native
        self._record_paths()
        missing = [name for name in wanted if name not in self._columns]
        if missing:
            raise PhotonLoupeError(
                f"the script reads {missing[0]}, which this map does not have; give it to from_arrays"
            )
        return self.upload_paths()

    def upload_paths(self) -> _engine.PhotonMap:
        """Return the map on the device with its paths, recorded now if need be; columns it lacks are empty."""
        native = self.upload()
        self._record_paths()
        if not self._has_uploaded_paths:
            paths = {name: np.ascontiguousarray(self._columns[name]) for name in PATH_NAMES if name in self._columns}
            _engine.set_paths(open_device(self._device)._native, native, paths)
            self._has_uploaded_paths = True
        return native

    @property
    def can_have_paths(self) -> bool:
        """Whether the map holds paths, or may record them by tracing the same photons again."""
        return "path_offsets" in self._columns or bool(self._settings)

    def take_script_columns(
        self,
        values: NDArray[np.float32],
        parameters: Sequence[Parameter],
        colors: NDArray[np.float32] | None,
        script: Mapping[str, Any],
    ) -> None:
        """Take what a script run left on the device as the columns of this map."""
        self._columns.pop("parameters", None)
        self._columns.pop("colors", None)
        if parameters:
            self._add_columns({"parameters": values})
        if colors is not None:
            self._add_columns({"colors": colors})
        self._parameters = tuple(parameters)
        self._provenance["script"] = dict(script)

    def _upload_parameters(self) -> None:
        if "parameters" in self._columns and self._native is not None:
            values = np.ascontiguousarray(self._columns["parameters"])
            axes = [{**asdict(parameter), "period": parameter.period} for parameter in self._parameters]
            _engine.set_parameters(open_device(self._device)._native, self._native, values, axes)

    def _upload_colors(self) -> None:
        """Show photons without a color, or without one of their parameters, in grey."""
        if "colors" in self._columns and self._native is not None:
            colors = np.array(self._columns["colors"], copy=True)
            if self._parameters:
                colors[~self.parameters_set] = np.nan
            _engine.set_colors(open_device(self._device)._native, self._native, colors)

    def _upload_state(self) -> None:
        names = [name for name in RELAXED_NAMES if name in self._columns]
        if names and self._native is not None:
            _engine.set_state(self._native, {name: np.ascontiguousarray(self._columns[name]) for name in names})

    def find_surface(self) -> Scene | None:
        """Return the scene whose surfaces the photons lie on; None for a map from arrays without one."""
        return self._find_scene() if self._scene is not None or "scene_path" in self._provenance else None

    def replace_positions(self, native: _engine.PhotonMap, state: Columns, relaxation: Mapping[str, Any]) -> Self:
        """Return this map with the photons where a relaxation put them; paths keep their traced end points."""
        columns: Columns = {column.name: np.asarray(getattr(native, column.name)) for column in PHOTON_COLUMNS}
        kept = ("parameters", "colors", *(name for name in PATH_NAMES))
        columns.update({name: self._columns[name] for name in kept if name in self._columns})
        columns["traced_positions"] = self._columns.get("traced_positions", self._columns["positions"])
        columns.update(state)
        moved = type(self)(
            columns,
            emitted=self._emitted,
            settings=self._settings,
            report=self._report,
            provenance={**self._provenance, "relaxation": relaxation["settings"]},
            scene=self._scene,
            device=self._device,
            native=native,
            parameters=self._parameters,
            relaxation=relaxation,
        )
        moved._upload_parameters()
        moved._upload_colors()
        return moved

    def _find_scene(self) -> Scene:
        """Return the scene the map was traced in, loading it again if its file is unchanged."""
        if self._scene is None:
            self._scene = reload_scene(self._provenance)
        return self._scene

    def _record_paths(self) -> None:
        if "path_offsets" in self._columns:
            return
        if not self._settings:
            raise PhotonLoupeError("this map was not traced here, so paths that it lacks cannot be recorded")
        traced = trace_paths(open_device(self._device), self._find_scene(), self._settings, self._emitted)
        rows = find_traced_rows(self._columns, traced)
        self._add_columns(gather_paths(read_path_columns(traced), rows))
