# SPDX-License-Identifier: Apache-2.0
"""The photon map: photons as columns, with the questions one can ask of them."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine, exporting, storage
from photonloupe.checks import check_count, check_rows
from photonloupe.columns import PATH_NAMES, PHOTON_COLUMNS, RELAXED_NAMES, STATE_COLUMNS, Columns, check_columns
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError, PhotonLoupeError
from photonloupe.parameters import Parameter, describe_parameters
from photonloupe.paths import find_traced_rows, gather_paths, match_signature, read_path_columns, trace_paths
from photonloupe.photon_stages import PhotonStages
from photonloupe.provenance import describe_origin, reload_scene
from photonloupe.scene import Scene

if TYPE_CHECKING:
    import pandas
    import pyarrow

# Emitted indices are counted in 64 bits, signed at the interfaces.
MAX_EMITTED = 2**63 - 1


class PhotonMap(PhotonStages):
    """Photons and what is known of them, as columns.

    Made by `trace_photons`, `load_photons` or `from_arrays`; afterwards only `run_script` and `set_parameters` change
    it. Row i of every column belongs to photon i. Path columns are recorded the first time they are read, by tracing
    the same photons again.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> pair = {"positions": [[0, 0, 0], [1, 0, 0]], "normals": [[0, 1, 0]] * 2, "power": np.ones((2, 3))}
    >>> photons = pl.PhotonMap.from_arrays(**pair)
    >>> len(photons), photons.total_flux.tolist()
    (2, [2.0, 2.0, 2.0])
    """

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

    @classmethod
    def from_arrays(
        cls,
        *,
        positions: ArrayLike,
        normals: ArrayLike,
        power: ArrayLike,
        emitter: ArrayLike | None = None,
        emitted_index: ArrayLike | None = None,
        object: ArrayLike | None = None,
        path_offsets: ArrayLike | None = None,
        path_vertices: ArrayLike | None = None,
        path_normals: ArrayLike | None = None,
        path_interactions: ArrayLike | None = None,
        path_objects: ArrayLike | None = None,
        path_scatter: ArrayLike | None = None,
        emitted: int | None = None,
        surface: Scene | None = None,
        device: Device | int | str | None = None,
    ) -> PhotonMap:
        """Make a map of your own photons.

        Parameters
        ----------
        positions, normals, power
            (n, 3) each: m, unit vectors, W per channel.
        emitter, emitted_index, object
            (n,) whole numbers; defaults 0, the row, -1 (none).
        path_offsets
            (n + 1,) first vertex of each path in the flat columns, then their number.
        path_vertices, path_normals, path_interactions, path_objects, path_scatter
            (v, 3), (v, 3), (v,), (v,), (v,): vertices from the emitter to the storage point, both included;
            interaction 1 reflected, 2 transmitted, 0 at the ends; scatter 0 mirror-like to 1 diffuse.
        emitted
            Number of photons emitted; default: the largest emitted index + 1.
        surface
            Scene whose objects the photons lie on, told apart by `object` (-1: any); relaxed photons return to it.
            Without one they move in their tangent planes.
        device
            Where queries will run.

        Returns
        -------
        PhotonMap

        Raises
        ------
        ArgumentError
            Naming the column, and the row where one is to blame.
        """
        columns = check_columns(
            {
                "positions": positions,
                "normals": normals,
                "power": power,
                "emitter": emitter,
                "emitted_index": emitted_index,
                "object": object,
                "path_offsets": path_offsets,
                "path_vertices": path_vertices,
                "path_normals": path_normals,
                "path_interactions": path_interactions,
                "path_objects": path_objects,
                "path_scatter": path_scatter,
            }
        )
        least = int(columns["emitted_index"].max(initial=0)) + 1
        emitted = least if emitted is None else check_count("emitted", emitted, least, MAX_EMITTED)
        provenance = {**describe_origin(None, surface, {}), "source": "arrays"}
        return cls(columns, emitted=emitted, provenance=provenance, scene=surface, device=device)

    @property
    def emitted(self) -> int:
        """Number of photons emitted for this map."""
        return self._emitted

    @property
    def total_flux(self) -> NDArray[np.float64]:
        """Flux of all photons together, (3,), W per channel."""
        return self.power.sum(axis=0, dtype=np.float64)

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

    @property
    def tree(self) -> dict[str, Any]:
        """The kd-tree: split_axis, split_value, first, count, box (nodes, 6), order."""
        return dict(self.upload().tree(open_device(self._device)._native))

    def select(self, ids: ArrayLike | None = None, *, signature: str | int | None = None) -> PhotonMap:
        """Make a map of some of the photons; fluxes and the number emitted stay as they are.

        Parameters
        ----------
        ids
            Boolean mask (n,), or ids in the order wanted.
        signature
            Instead: interactions such as ``"22"`` (transmitted twice), or the number of [SJL15] eq. 2.

        Returns
        -------
        PhotonMap

        Raises
        ------
        ArgumentError
            If an id is not a photon, a mask is not n long, or not exactly one of the two is given.
        """
        if signature is not None and ids is None:
            self._record_paths()
            rows = match_signature(self._columns, signature)
        elif ids is not None and signature is None:
            rows = check_rows(ids, len(self))
        else:
            raise ArgumentError("select takes either a mask or ids, or signature=")
        kept = [column.name for column in (*PHOTON_COLUMNS, *STATE_COLUMNS) if column.name in self._columns]
        columns = {name: self._columns[name][rows] for name in kept}
        columns.update(gather_paths(self._columns, rows))
        return PhotonMap(
            columns,
            emitted=self._emitted,
            settings=self._settings,
            report=self._report,
            provenance=self._provenance,
            scene=self._scene,
            device=self._device,
            parameters=self._parameters,
            relaxation=self._relaxation,
        )

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the map as a Zarr v3 folder; an older map there stays until the new one is whole.

        Raises
        ------
        FileFormatError
            If something that is not a photon map is in the way, or the folder cannot be written.
        """
        storage.write_map(path, self._columns, self._describe())

    def to_arrow(self) -> pyarrow.Table:
        """Copy the recorded columns into an Arrow table; vectors are fixed-size lists, paths lists."""
        return exporting.build_table(self._columns)

    def to_pandas(self) -> pandas.DataFrame:
        """Copy the photon columns into a data frame, vectors as three columns each; needs pandas."""
        return exporting.build_frame(self._columns)

    def __repr__(self) -> str:
        flux = ", ".join(f"{value:.4g}" for value in self.total_flux)
        place = f" in {self._scene.path.name}" if self._scene else ""
        return f"<PhotonMap{place}: {len(self):,} photons of {self.emitted:,} emitted, flux ({flux}) W>"

    def _as_map(self) -> PhotonMap:
        return self

    def _describe(self) -> dict[str, Any]:
        described: dict[str, Any] = {
            "emitted": self._emitted,
            "settings": self._settings,
            "report": self._report,
            "provenance": self._provenance,
        }
        if self._parameters:
            described["parameters"] = describe_parameters(self._parameters)
        if self._relaxation:
            described["relaxation"] = self._relaxation
        return described

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

    def replace_positions(self, native: _engine.PhotonMap, state: Columns, relaxation: Mapping[str, Any]) -> PhotonMap:
        """Return this map with the photons where a relaxation put them; paths keep their traced end points."""
        columns: Columns = {column.name: np.asarray(getattr(native, column.name)) for column in PHOTON_COLUMNS}
        kept = ("parameters", "colors", *(name for name in PATH_NAMES))
        columns.update({name: self._columns[name] for name in kept if name in self._columns})
        columns["traced_positions"] = self._columns.get("traced_positions", self._columns["positions"])
        columns.update(state)
        moved = PhotonMap(
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
