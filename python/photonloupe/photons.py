# SPDX-License-Identifier: Apache-2.0
"""The photon map: photons as columns, with the questions one can ask of them."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine, exporting, storage
from photonloupe.checks import check_count, check_rows
from photonloupe.columns import check_columns
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.parameters import describe_parameters
from photonloupe.paths import parse_signature
from photonloupe.photon_stages import PhotonStages
from photonloupe.provenance import describe_origin
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
            interaction 1 reflected, 2 transmitted, 3 scattered by a medium, 0 at the ends; scatter 0 mirror-like to 1
            diffuse.
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
        opened = open_device(device)
        native = _engine.photons_from_columns(opened._native, columns, [], {}, emitted)
        return cls(native, opened, provenance=provenance, scene=surface)

    @property
    def total_flux(self) -> NDArray[np.float64]:
        """Flux of all photons together, (3,), W per channel."""
        return self.power.sum(axis=0, dtype=np.float64)

    @property
    def tree(self) -> dict[str, Any]:
        """The kd-tree: split_axis, split_value, first, count, box (nodes, 6), order."""
        return dict(self._native.tree(self._device._native))

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
            wanted = parse_signature(signature)
            self._read("path_interactions")
            rows = _engine.find_signature(self._native, wanted)
        elif ids is not None and signature is None:
            rows = np.ascontiguousarray(check_rows(ids, len(self)), dtype=np.uint32)
        else:
            raise ArgumentError("select takes either a mask or ids, or signature=")
        return self.replace(_engine.select_photons(self._device._native, self._native, rows))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the map as a Zarr v3 folder; an older map there stays until the new one is whole.

        Raises
        ------
        FileFormatError
            If something that is not a photon map is in the way, or the folder cannot be written.
        """
        storage.write_map(path, self.read_columns(), self._describe())

    def to_arrow(self) -> pyarrow.Table:
        """Copy the recorded columns into an Arrow table; vectors are fixed-size lists, paths lists."""
        return exporting.build_table(self.read_columns())

    def to_pandas(self) -> pandas.DataFrame:
        """Copy the photon columns into a data frame, vectors as three columns each; needs pandas."""
        return exporting.build_frame(self.read_columns())

    def __repr__(self) -> str:
        flux = ", ".join(f"{value:.4g}" for value in self.total_flux)
        place = f" in {self._scene.path.name}" if self._scene else ""
        return f"<PhotonMap{place}: {len(self):,} photons of {self.emitted:,} emitted, flux ({flux}) W>"

    def _describe(self) -> dict[str, Any]:
        described: dict[str, Any] = {
            "emitted": self.emitted,
            "settings": self._settings,
            "report": self._report,
            "provenance": self._provenance,
        }
        if self.parameter_list:
            described["parameters"] = describe_parameters(self.parameter_list)
        if self._relaxation:
            described["relaxation"] = self._relaxation
        return described


def check_map(photons: object) -> PhotonMap:
    """Return the map, or raise `ArgumentError`."""
    if not isinstance(photons, PhotonMap):
        raise ArgumentError(f"photons must be a PhotonMap, not {photons!r}")
    return photons
