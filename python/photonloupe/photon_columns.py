# SPDX-License-Identifier: Apache-2.0
"""The columns of a photon map as attributes: photons, paths, parameters, and the state that relaxation leaves."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe.columns import Columns
from photonloupe.errors import PhotonLoupeError

Float3 = NDArray[np.float32]


class PhotonColumns:
    """Row i of every column belongs to photon i; path columns are flat, with offsets."""

    _columns: Columns

    @property
    def positions(self) -> Float3:
        """Where the photons are stored, (n, 3), m."""
        return self._columns["positions"]

    @property
    def normals(self) -> Float3:
        """Unit normal of the surface, on the side the light came from, (n, 3)."""
        return self._columns["normals"]

    @property
    def power(self) -> Float3:
        """Flux carried, (n, 3), W per channel."""
        return self._columns["power"]

    @property
    def emitter(self) -> NDArray[np.int32]:
        """Index of the light, (n,)."""
        return self._columns["emitter"]

    @property
    def emitted_index(self) -> NDArray[np.uint64]:
        """Which emitted photon it is, (n,): with the seed it determines the whole path."""
        return self._columns["emitted_index"]

    @property
    def object(self) -> NDArray[np.int32]:
        """Object it lies on, (n,); -1 where there is none."""
        return self._columns["object"]

    @property
    def path_offsets(self) -> NDArray[np.int64]:
        """First vertex of each path in the flat path columns, (n + 1,)."""
        return self._read_path_column("path_offsets")

    @property
    def path_vertices(self) -> Float3:
        """Vertices of all paths, emitter and storage point included, (v, 3), m."""
        return self._read_path_column("path_vertices")

    @property
    def path_normals(self) -> Float3:
        """Unit normals at the vertices, (v, 3)."""
        return self._read_path_column("path_normals")

    @property
    def path_interactions(self) -> NDArray[np.uint8]:
        """What happened at the vertices, (v,): 1 reflected, 2 transmitted, 0 at the ends."""
        return self._read_path_column("path_interactions")

    @property
    def path_objects(self) -> NDArray[np.int32]:
        """Objects the vertices lie on, (v,); -1 at a light."""
        return self._read_path_column("path_objects")

    @property
    def path_scatter(self) -> NDArray[np.float32]:
        """How diffuse each interaction was, (v,): 0 mirror-like to 1 diffuse."""
        return self._read_path_column("path_scatter")

    @property
    def parameters(self) -> NDArray[np.float32]:
        """Parameters set by a script or by `set_parameters`, (n, m); NaN where a photon has none."""
        return self._read_state("parameters", "set_parameters() or a script")

    @property
    def parameters_set(self) -> NDArray[np.bool_]:
        """Whether a photon has all its parameters, (n,); one without takes no part in parameter space."""
        return ~np.isnan(self.parameters).any(axis=1)

    @property
    def constraint_basis(self) -> NDArray[np.float32]:
        """Unit tangent vectors along and across the structure, u_b and v_b, (n, 2, 3)."""
        return self._read_state("constraint_basis", "constrain() or relax()")

    @property
    def constraint_weights(self) -> NDArray[np.float32]:
        """Share of movement forbidden along u_b and v_b, w_u and w_v, (n, 2): 0 free to 1 fixed."""
        return self._read_state("constraint_weights", "constrain() or relax()")

    @property
    def gradient(self) -> Float3:
        """Relative gradient of the photon density, ∇f/f, (n, 3), 1/m (METHODS section 5.1)."""
        return self._read_state("gradient", "constrain() or relax()")

    @property
    def one_sidedness(self) -> NDArray[np.float32]:
        """How far a photon's neighbors lie on one side, c_m, (n,): 0 evenly around, 1 on a hard edge."""
        return self._read_state("one_sidedness", "constrain() or relax()")

    @property
    def drift(self) -> Float3:
        """Displacement since the constraint was measured, (n, 3), m."""
        return self._read_state("drift", "relax()")

    @property
    def pressure(self) -> NDArray[np.float32]:
        """Force of the last step before constraint and limiter over the radius, |f'|/r, (n,)."""
        return self._read_state("pressure", "relax()")

    @property
    def recorded(self) -> tuple[str, ...]:
        """Names of the columns that are there without tracing again."""
        return tuple(self._columns)

    def _add_columns(self, columns: Columns) -> None:
        for name, array in columns.items():
            view = array.view()
            view.setflags(write=False)
            self._columns[name] = view

    def _record_paths(self) -> None:
        raise NotImplementedError

    def _read_path_column(self, name: str) -> NDArray[Any]:
        if name not in self._columns:
            self._record_paths()
        if name not in self._columns:
            raise PhotonLoupeError(f"this map has no {name}; it holds {', '.join(self.recorded)}")
        return self._columns[name]

    def _read_state(self, name: str, maker: str) -> NDArray[Any]:
        if name not in self._columns:
            raise PhotonLoupeError(f"this map has no {name}; {maker} makes it")
        return self._columns[name]
