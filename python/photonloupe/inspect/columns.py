# SPDX-License-Identifier: Apache-2.0
"""The columns that views can plot of a map."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.errors import ArgumentError, PhotonLoupeError
from photonloupe.photons import PhotonMap, check_map
from photonloupe.progress import ProgressLike, follow_progress


@dataclass(frozen=True)
class ColumnInfo:
    """A column before it is computed."""

    name: str
    label: str  # with its unit
    period: float  # 0: it does not wrap
    discrete: bool  # few distinct values
    needs_paths: bool
    missing: str  # what to do before it can be had; empty: it can be had now


@dataclass(frozen=True)
class Column:
    """One number per photon.

    Attributes
    ----------
    name, label
        As it is asked for, and as axes show it, with its unit.
    values
        (n,); NaN where a photon has none.
    low, high
        Declared bounds, or those of the finite values.
    period
        After which it repeats; 0 where it does not.
    discrete
        Whether it has few distinct values: counted, not smoothed.
    """

    name: str
    label: str
    values: NDArray[np.float32]
    low: float
    high: float
    period: float
    discrete: bool


def columns(photons: PhotonMap) -> tuple[ColumnInfo, ...]:
    """List the columns of a map, those included that it cannot give yet.

    Places, normals and flux; what paths tell: the signature ([SJL15] eq. 2), tortuosity (eq. 1), primal and incident
    trajectories (eq. 3), the normal angle at the first specular vertex (figure 9 f); what a relaxation left; every
    parameter by its name, or as ``parameter.NAME`` where another column has that name.

    Parameters
    ----------
    photons
        The map.

    Returns
    -------
    tuple of ColumnInfo

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> pair = {"positions": [[0, 0, 0], [1, 0, 0]], "normals": [[0, 1, 0]] * 2, "power": np.ones((2, 3))}
    >>> [info.name for info in pl.inspect.columns(pl.PhotonMap.from_arrays(**pair))][:3]
    ['x', 'y', 'z']
    """
    rows = [ColumnInfo(**row) for row in _engine.list_columns(check_map(photons)._native)]
    if not photons.can_have_paths:
        return tuple(rows)
    # They are recorded when they are asked for.
    return tuple(ColumnInfo(**{**vars(row), "missing": ""}) if row.needs_paths else row for row in rows)


def column(photons: PhotonMap, name: str, *, progress: ProgressLike = None) -> Column:
    """Compute one column.

    Parameters
    ----------
    photons
        The map; paths that the column needs are recorded now.
    name
        One of those that `columns` lists.
    progress
        True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    Column

    Raises
    ------
    ArgumentError
        If there is no such column, or the map lacks what it is made of.

    Examples
    --------
    >>> import photonloupe as pl
    >>> photons = pl.trace_photons(pl.load_scene("scenes/ring/ring.gltf"), count=10_000, seed=1)
    >>> float(pl.inspect.column(photons, "signature").values.min())
    1.0
    """
    require_columns(photons, (name,))
    with follow_progress(progress) as callback:
        return make_column(_engine.find_column(photons.device._native, photons._native, name, callback))


def make_column(row: dict[str, Any]) -> Column:
    """Turn what the engine gives into a column."""
    return Column(**{**row, "values": np.asarray(row["values"])})


def require_columns(photons: PhotonMap, names: tuple[str, ...]) -> None:
    """Record what these columns need, if need be.

    Raises
    ------
    ArgumentError
        If one of them cannot be had.
    """
    infos = {info.name: info for info in columns(photons)}
    for name in names:
        if name not in infos:
            raise ArgumentError(f"there is no column {name!r}; the columns are {', '.join(infos)}")
        if infos[name].missing:
            raise ArgumentError(f"column {name!r}: {infos[name].missing}")
    if any(infos[name].needs_paths for name in names):
        try:
            photons.record_paths()
        except PhotonLoupeError as error:
            raise ArgumentError(f"column {names[0]!r} needs paths: {error}") from error
