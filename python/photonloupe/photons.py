# SPDX-License-Identifier: Apache-2.0
"""The photon map: photons as columns, with the questions one can ask of them."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine, exporting, queries, storage
from photonloupe.checks import check_count
from photonloupe.columns import PHOTON_COLUMNS, Columns, check_columns
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError, PhotonLoupeError
from photonloupe.paths import find_traced_rows, gather_paths, match_signature, read_path_columns, trace_paths
from photonloupe.photon_columns import Float3, PhotonColumns
from photonloupe.progress import ProgressLike
from photonloupe.scene import Scene, load_scene

if TYPE_CHECKING:
    import pandas
    import pyarrow

# Emitted indices are counted in 64 bits, signed at the interfaces.
MAX_EMITTED = 2**63 - 1


class PhotonMap(PhotonColumns):
    """Photons and what is known of them, as columns.

    Made by `trace_photons`, `load_photons` or `from_arrays`; never changed afterwards. Row i of every column
    belongs to photon i. Path columns are recorded the first time they are read, by tracing the same photons again.

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
        provenance = {"version": _engine.version, "source": "arrays"}
        return cls(columns, emitted=emitted, provenance=provenance, device=device)

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
    def tree(self) -> dict[str, Any]:
        """The kd-tree: split_axis, split_value, first, count, box (nodes, 6), order."""
        return dict(self._upload().tree(open_device(self._device)._native))

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
        if (ids is None) == (signature is None):
            raise ArgumentError("select takes either a mask or ids, or signature=")
        if signature is not None:
            self._record_paths()
            rows = match_signature(self._columns, signature)
        else:
            rows = self._check_rows(np.asarray(ids))
        columns = {column.name: self._columns[column.name][rows] for column in PHOTON_COLUMNS}
        columns.update(gather_paths(self._columns, rows))
        return PhotonMap(
            columns,
            emitted=self._emitted,
            settings=self._settings,
            report=self._report,
            provenance=self._provenance,
            scene=self._scene,
            device=self._device,
        )

    def neighbors(
        self, points: ArrayLike, k: int, *, space: str = "world", progress: ProgressLike = None
    ) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
        """Find the k nearest photons, nearest first, ties by id.

        Parameters
        ----------
        points
            Points (n, 3) in m, or ids (n,) of photons; a photon is not its own neighbor.
        k
            How many, 1 to 1000.
        space
            ``"world"``: distance in m.
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

        Returns
        -------
        ids : (n, k) int32
            Padded with -1 where there are fewer photons.
        distances : (n, k) float32
            In m, padded with inf.

        Raises
        ------
        ArgumentError
            If a point is not finite, an id is not a photon, or k is out of range.

        Examples
        --------
        >>> import numpy as np, photonloupe as pl
        >>> line = np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]])
        >>> photons = pl.PhotonMap.from_arrays(positions=line, normals=[[0, 1, 0]] * 3, power=np.ones((3, 3)))
        >>> photons.neighbors([1], 3)[0].tolist()
        [[0, 2, -1]]
        """
        native = self._upload()
        return queries.find_neighbors(open_device(self._device), native, points, k, space=space, progress=progress)

    def irradiance(
        self,
        points: ArrayLike,
        normals: ArrayLike,
        *,
        k: int | None = None,
        kernel: str = "epanechnikov",
        progress: ProgressLike = None,
    ) -> Float3:
        """Estimate the irradiance from the k nearest photons of the same surface (METHODS section 2).

        Parameters
        ----------
        points, normals
            (n, 3) each: m, directions; one normal (3,) serves all points.
        k
            How many photons, 1 to 1000; by default what suits the map's emission.
        kernel
            ``"epanechnikov"``, ``"disc"``, ``"cone"`` or ``"gaussian"``.
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

        Returns
        -------
        (n, 3) float32
            W/m² per channel; 0 where no photon is accepted.

        Raises
        ------
        ArgumentError
            If a point or normal is not finite, a normal is zero, or k or kernel is not offered.
        """
        native = self._upload()
        k = queries.choose_k(self._settings) if k is None else k
        device = open_device(self._device)
        return queries.estimate_irradiance(device, native, points, normals, k=k, kernel=kernel, progress=progress)

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

    def __len__(self) -> int:
        return len(self.positions)

    def __repr__(self) -> str:
        flux = ", ".join(f"{value:.4g}" for value in self.total_flux)
        place = f" in {self._scene.path.name}" if self._scene else ""
        return f"<PhotonMap{place}: {len(self):,} photons of {self.emitted:,} emitted, flux ({flux}) W>"

    def _describe(self) -> dict[str, Any]:
        return {
            "emitted": self._emitted,
            "settings": self._settings,
            "report": self._report,
            "provenance": self._provenance,
        }

    def _check_rows(self, ids: NDArray[Any]) -> NDArray[np.int64]:
        if ids.ndim != 1:
            raise ArgumentError(f"ids or mask must have shape (n,), not {ids.shape}")
        if ids.dtype == np.bool_:
            if len(ids) != len(self):
                raise ArgumentError(f"the mask has {len(ids)} entries, the map {len(self)} photons")
            return np.flatnonzero(ids)
        if ids.dtype.kind not in "iu" and len(ids):
            raise ArgumentError(f"ids must be whole numbers or a mask, not {ids.dtype}")
        outside = (ids < 0) | (ids >= len(self))
        if outside.any():
            row = int(np.argmax(outside))
            raise ArgumentError(f"ids[{row}] = {ids[row]} is not a photon; they run from 0 to {len(self) - 1}")
        return ids.astype(np.int64)

    def _upload(self) -> _engine.PhotonMap:
        if self._native is None:
            columns = {column.name: np.ascontiguousarray(self._columns[column.name]) for column in PHOTON_COLUMNS}
            # What a map stores decides what a composite adds to it.
            store = str(self._settings.get("store", "caustic"))
            self._native = _engine.photons_from_columns(open_device(self._device)._native, columns, store)
        return self._native

    def _find_scene(self) -> Scene:
        """Return the scene the map was traced in, loading it again if its file is unchanged."""
        if self._scene is not None:
            return self._scene
        path = self._provenance.get("scene_path")
        if not path or not self._settings:
            raise PhotonLoupeError("this map was not traced here, so paths that it lacks cannot be recorded")
        scene = load_scene(path)
        if scene.hash != self._provenance.get("scene_hash"):
            raise PhotonLoupeError(f"{path} has changed since this map was traced; trace it anew to have its paths")
        self._scene = scene
        return scene

    def _record_paths(self) -> None:
        if "path_offsets" in self._columns:
            return
        traced = trace_paths(open_device(self._device), self._find_scene(), self._settings, self._emitted)
        rows = find_traced_rows(self._columns, traced)
        self._add_columns(gather_paths(read_path_columns(traced), rows))


def load_photons(path: str | os.PathLike[str], *, device: Device | int | str | None = None) -> PhotonMap:
    """Read a map that `PhotonMap.save` wrote.

    Parameters
    ----------
    path
        The Zarr folder.
    device
        Where queries will run.

    Returns
    -------
    PhotonMap

    Raises
    ------
    FileFormatError
        If the folder is missing, is not a photon map, or an array in it is damaged; the message names which.
    """
    columns, meta = storage.read_map(path)
    return PhotonMap(
        columns,
        emitted=meta["emitted"],
        settings=meta["settings"],
        report=meta["report"],
        provenance=meta["provenance"],
        device=device,
    )
