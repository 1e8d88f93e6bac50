# SPDX-License-Identifier: Apache-2.0
"""The columns of a photon map as attributes: photons, paths, parameters, and the state that relaxation leaves."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.columns import PATH_NAMES, Columns
from photonloupe.device import Device
from photonloupe.errors import PhotonLoupeError
from photonloupe.parameters import Parameter, check_parameters, list_axes

Float3 = NDArray[np.float32]
T = TypeVar("T")
_STATE_MAKER = "constrain() or relax()"


class _Column(property, Generic[T]):
    """A read-only column, by the name it is assigned to; `maker` makes one that is missing."""

    def __init__(self, doc: str, maker: str = "") -> None:
        super().__init__()
        self.__doc__ = doc
        self._maker = maker

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, instance: Any, owner: type | None = None) -> T:  # pyright: ignore[reportIncompatibleMethodOverride]
        found: Any = self if instance is None else instance._read(self._name, self._maker)
        return found


class PhotonColumns:
    """Row i of every column belongs to photon i; path columns are flat, with offsets.

    The engine's map owns them; these are views, read-only and kept as long as the column stays the same.
    """

    _native: _engine.PhotonMap
    _device: Device
    _views: Columns

    def __len__(self) -> int:
        return int(self._native.count)

    positions = _Column[Float3]("Where the photons are stored, (n, 3), m.")
    normals = _Column[Float3](
        "Unit normal of the surface, on the side the light came from; in a medium half the way back, (n, 3)."
    )
    power = _Column[Float3]("Flux carried, (n, 3), W per channel.")
    emitter = _Column[NDArray[np.int32]]("Index of the light, (n,).")
    emitted_index = _Column[NDArray[np.uint64]](
        "Which emitted photon it is, (n,): with the seed it determines the whole path."
    )
    object = _Column[NDArray[np.int32]]("Object it lies on, (n,); -1 where there is none.")
    path_offsets = _Column[NDArray[np.int64]]("First vertex of each path in the flat path columns, (n + 1,).")
    path_vertices = _Column[Float3]("Vertices of all paths, emitter and storage point included, (v, 3), m.")
    path_normals = _Column[Float3]("Unit normals at the vertices, (v, 3).")
    path_interactions = _Column[NDArray[np.uint8]](
        "What happened at the vertices, (v,): 1 reflected, 2 transmitted, 3 scattered by a medium, 0 at the ends."
    )
    path_objects = _Column[NDArray[np.int32]]("Objects the vertices lie on, (v,); -1 at a light.")
    path_scatter = _Column[NDArray[np.float32]]("How diffuse each interaction was, (v,): 0 mirror-like to 1 diffuse.")

    def set_parameters(
        self,
        values: ArrayLike,
        names: Sequence[str] | None = None,
        bounds: ArrayLike | None = None,
        periodic: Sequence[bool] | None = None,
    ) -> None:
        """Give every photon its place in a parameter space of your own; replaces all parameters there were.

        Parameters
        ----------
        values
            (n, m), m from 1 to 13, or (n,); NaN where a photon has none: it then takes no part in parameter space.
        names
            m names; default p3, p4 …: dimensions 0 to 2 are x, y, z.
        bounds
            (m, 2) lower and upper bound; default the smallest and largest value. They scale plots, and say where a
            periodic parameter wraps; they never scale distances.
        periodic
            m flags; the difference of two values of a periodic parameter wraps at upper - lower.

        Raises
        ------
        ArgumentError
            If a shape does not fit, a value is infinite (by row and column), or a periodic parameter has no bounds.

        Examples
        --------
        >>> import numpy as np, photonloupe as pl
        >>> spots = {"positions": [[0, 0, 0], [1, 0, 0]], "normals": [[0, 1, 0]] * 2, "power": np.ones((2, 3))}
        >>> photons = pl.PhotonMap.from_arrays(**spots)
        >>> photons.set_parameters([0.1, 3.1], ["phi"], [[0.0, 3.14]], [True])
        >>> photons.parameter_names, photons.parameters_set.tolist()
        (('phi',), [True, True])
        """
        columns, parameters = check_parameters(values, len(self), names, bounds, periodic)
        _engine.set_parameters(self._device._native, self._native, columns, list_axes(parameters))
        self._views.pop("parameters", None)

    @property
    def parameter_list(self) -> tuple[Parameter, ...]:
        """Names, bounds and periods of the parameters."""
        return tuple(Parameter(name, low, high, period > 0.0) for name, low, high, period in self._native.axes)

    @property
    def parameter_names(self) -> tuple[str, ...]:
        """Names of the parameters, dimensions from 3 on."""
        return tuple(parameter.name for parameter in self.parameter_list)

    @property
    def parameter_bounds(self) -> NDArray[np.float32]:
        """Lower and upper bound of each parameter, (m, 2)."""
        rows = [(parameter.low, parameter.high) for parameter in self.parameter_list]
        return np.array(rows, dtype=np.float32).reshape(-1, 2)

    parameters = _Column[NDArray[np.float32]](
        "Parameters set by a script or by `set_parameters`, (n, m); NaN where a photon has none.",
        "set_parameters() or a script",
    )

    @property
    def parameters_set(self) -> NDArray[np.bool_]:
        """Whether a photon has all its parameters, (n,); one without takes no part in parameter space."""
        return np.all(~np.isnan(self.parameters), axis=1)

    colors = _Column[Float3](
        "False colors that a script encoded, (n, 3), linear; NaN where it gave none (shown in grey).",
        "run_script() with setPhotonColourEncoding",
    )
    constraint_basis = _Column[NDArray[np.float32]](
        "Unit tangent vectors along and across the structure, u_b and v_b, (n, 2, 3).", _STATE_MAKER
    )
    constraint_weights = _Column[NDArray[np.float32]](
        "Share of movement forbidden along u_b and v_b, w_u and w_v, (n, 2): 0 free to 1 fixed.", _STATE_MAKER
    )
    gradient = _Column[Float3](
        "Relative gradient of the photon density, ∇f/f, (n, 3), 1/m (METHODS section 5.1).", _STATE_MAKER
    )
    one_sidedness = _Column[NDArray[np.float32]](
        "How far a photon's neighbors lie on one side, c_m, (n,): 0 evenly around, 1 on a hard edge.", _STATE_MAKER
    )

    @property
    def traced_positions(self) -> Float3:
        """Where the photons were before any relaxation, (n, 3), m; paths end there."""
        return self._read("traced_positions") if "traced_positions" in self.recorded else self.positions

    drift = _Column[Float3]("Displacement since the constraint was measured, (n, 3), m.", "relax()")
    pressure = _Column[NDArray[np.float32]](
        "Force of the last step before constraint and limiter over the radius, |f'|/r, (n,).", "relax()"
    )

    @property
    def recorded(self) -> tuple[str, ...]:
        """Names of the columns that are there without tracing again."""
        return tuple(self._native.names)

    def read_columns(self) -> Columns:
        """Return all columns that are there, by name."""
        return {name: self._read(name) for name in self.recorded}

    def record_paths(self) -> None:
        """Record the paths, by tracing the photons again, unless they are there."""
        raise NotImplementedError

    def _read(self, name: str, maker: str = "") -> NDArray[Any]:
        """Read a column; paths are recorded now if need be, what else is missing has a maker."""
        if name not in self._views:
            if name in PATH_NAMES:
                self.record_paths()
            values = self._native.column(name)
            if values is None:
                how = f"; {maker} makes it" if maker else f"; it holds {', '.join(self.recorded)}"
                raise PhotonLoupeError(f"this map has no {name}{how}")
            view = np.asarray(values).view()
            view.setflags(write=False)
            self._views[name] = view
        return self._views[name]
