# SPDX-License-Identifier: Apache-2.0
"""The photon map's columns: their names, types and shapes, and the checks a user's own arrays must pass."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe.checks import check_finite
from photonloupe.errors import ArgumentError
from photonloupe.settings import list_settings

Columns = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Column:
    """One column: `width` 0 is one value a row; rows belong to photons or to the vertices of their paths."""

    name: str
    dtype: str
    width: int = 0
    of_vertices: bool = False
    low: float | None = None
    high: float | None = None
    depth: int = 0  # rows of `depth` vectors of `width` values each
    any_width: bool = False  # as many values a row as the map has parameters
    may_be_nan: bool = False

    @property
    def tail(self) -> tuple[int, ...]:
        """Shape of one row; -1 stands for any number."""
        if self.any_width:
            return (-1,)
        return (*((self.depth,) if self.depth else ()), *((self.width,) if self.width else ()))


# The engine packs objects into 24 bits, of which one value stands for none.
LARGEST_OBJECT = 2**24 - 2

PHOTON_COLUMNS = (
    Column("positions", "f4", 3),
    Column("normals", "f4", 3),
    Column("power", "f4", 3, low=0.0),
    Column("emitter", "i4", low=0),
    Column("emitted_index", "u8", low=0),
    Column("object", "i4", low=-1, high=LARGEST_OBJECT),
)
PATH_COLUMNS = (
    Column("path_vertices", "f4", 3, of_vertices=True),
    Column("path_normals", "f4", 3, of_vertices=True),
    Column("path_interactions", "u1", of_vertices=True, low=0, high=3),
    Column("path_objects", "i4", of_vertices=True, low=-1, high=LARGEST_OBJECT),
    Column("path_scatter", "f4", of_vertices=True, low=0.0, high=1.0),
)
PATH_OFFSETS = Column("path_offsets", "i8")
# What a script, a user or relaxation adds to the photons.
STATE_COLUMNS = (
    Column("parameters", "f4", any_width=True, may_be_nan=True),
    Column("colors", "f4", 3, may_be_nan=True),
    Column("constraint_basis", "f4", 3, depth=2),
    Column("constraint_weights", "f4", 2, low=0.0, high=1.0),
    Column("gradient", "f4", 3),
    Column("one_sidedness", "f4", low=0.0),
    Column("traced_positions", "f4", 3),
    Column("drift", "f4", 3),
    Column("pressure", "f4", low=0.0),
)
ALL_COLUMNS = {column.name: column for column in (*PHOTON_COLUMNS, PATH_OFFSETS, *PATH_COLUMNS, *STATE_COLUMNS)}
PATH_NAMES = (PATH_OFFSETS.name, *(column.name for column in PATH_COLUMNS))
REQUIRED = ("positions", "normals", "power")

# Photon ids are 32-bit signed in every neighbor list.
MAX_PHOTONS = list_settings("trace")["count"].limits[1]
# Normals written as text with four digits still pass.
_UNIT_TOLERANCE = 1e-3
# A photon in a medium has no surface: its normal is half the direction it came from.
_MEDIUM_LENGTH = 0.5
# A map without objects says so in every row.
NO_OBJECT = -1


def _convert(column: Column, values: ArrayLike) -> NDArray[Any]:
    """Convert to the column's type, refusing what would lose its meaning."""
    try:
        given = np.asarray(values)
    except ValueError:
        raise ArgumentError(f"{column.name} is not a rectangular array") from None
    shape = f"(n, {column.width})" if column.width else "(n,)"
    if given.ndim != (2 if column.width else 1) or (column.width and given.shape[1] != column.width):
        raise ArgumentError(f"{column.name} must have shape {shape}, not {given.shape}")
    if given.dtype.kind not in "fiu":
        raise ArgumentError(f"{column.name} must hold numbers, not {given.dtype}")
    dtype = np.dtype(column.dtype)
    if given.dtype.kind == "f":
        check_finite(column.name, given)
    if dtype.kind in "iu":
        info = np.iinfo(dtype)
        with np.errstate(invalid="ignore"):
            whole = given == np.trunc(given) if given.dtype.kind == "f" else np.ones(given.shape, dtype=bool)
        _refuse_rows(column.name, ~whole, given, "is not a whole number")
        outside = (given < info.min) | (given > info.max)
        _refuse_rows(column.name, outside, given, f"does not fit {dtype.name}")
    with np.errstate(over="ignore"):
        # A copy: the map must not change when the caller's array does.
        array = np.array(given, dtype=dtype, order="C", copy=True)
    if dtype.kind == "f":
        _refuse_rows(column.name, ~np.isfinite(array), given, "does not fit a 32-bit float")
    _check_range(column, array)
    return array


def _check_range(column: Column, values: NDArray[Any]) -> None:
    if column.low is not None:
        _refuse_rows(column.name, values < column.low, values, f"is below {column.low:g}")
    if column.high is not None:
        _refuse_rows(column.name, values > column.high, values, f"is above {column.high:g}")


def _refuse_rows(name: str, bad: NDArray[np.bool_], values: NDArray[Any], why: str) -> None:
    if not bad.any():
        return
    place = np.unravel_index(int(np.argmax(bad)), bad.shape)
    row = "".join(f"[{int(i)}]" for i in place)
    raise ArgumentError(f"{name}{row} = {values[place]} {why}")


def _check_offsets(columns: Columns, photon_count: int) -> None:
    offsets = columns["path_offsets"]
    vertex_count = len(columns["path_vertices"])
    if len(offsets) != photon_count + 1:
        raise ArgumentError(
            f"path_offsets must have {photon_count + 1} entries, one more than photons, not {len(offsets)}"
        )
    if offsets[0] != 0 or offsets[-1] != vertex_count:
        raise ArgumentError(
            f"path_offsets must run from 0 to the number of vertices {vertex_count}, "
            f"not from {offsets[0]} to {offsets[-1]}"
        )
    _refuse_rows("path_offsets", np.diff(offsets, prepend=offsets[:1]) < 0, offsets, "is less than the one before it")


def check_columns(given: Mapping[str, ArrayLike | None]) -> Columns:
    """Check a user's columns and bring them to their types.

    Parameters
    ----------
    given
        Arrays by column name; None counts as absent. Required: positions, normals, power.

    Returns
    -------
    dict
        C-contiguous arrays of the types in `ALL_COLUMNS`, the photon columns all present.

    Raises
    ------
    ArgumentError
        Naming the column, and the row where one is to blame: NaN, infinity, wrong shape or type, a value out of its
        range, a normal that is not a unit vector, offsets that are not ascending, columns of different lengths.
    """
    present = {name: values for name, values in given.items() if values is not None}
    unknown = sorted(set(present) - set(ALL_COLUMNS))
    if unknown:
        raise ArgumentError(f"there is no column {unknown[0]!r}; the columns are {', '.join(ALL_COLUMNS)}")
    missing = [name for name in REQUIRED if name not in present]
    if missing:
        raise ArgumentError(f"the column {missing[0]} is missing")
    columns = {name: _convert(ALL_COLUMNS[name], values) for name, values in present.items()}
    count = len(columns["positions"])
    if count > MAX_PHOTONS:
        raise ArgumentError(f"a map holds at most {MAX_PHOTONS:,} photons, not {count:,}")
    columns.setdefault("emitter", np.zeros(count, dtype=np.int32))
    columns.setdefault("emitted_index", np.arange(count, dtype=np.uint64))
    columns.setdefault("object", np.full(count, NO_OBJECT, dtype=np.int32))
    for column in PHOTON_COLUMNS:
        if len(columns[column.name]) != count:
            raise ArgumentError(f"{column.name} has {len(columns[column.name])} rows, positions has {count}")
    length = np.linalg.norm(columns["normals"].astype(np.float64), axis=1)
    _refuse_rows(
        "normals",
        (np.abs(length - 1.0) > _UNIT_TOLERANCE) & (np.abs(length - _MEDIUM_LENGTH) > _UNIT_TOLERANCE),
        length,
        "is its length; normals must be unit vectors, or half as long where a medium scatters",
    )
    _check_paths(columns, count)
    return columns


def check_state(name: str, values: NDArray[Any], count: int) -> NDArray[Any]:
    """Check a state column read from a file against the number of photons.

    Raises
    ------
    ArgumentError
        Naming the column, and the row where one is to blame.
    """
    column = ALL_COLUMNS[name]
    if len(values) != count:
        raise ArgumentError(f"{name} has {len(values)} rows, positions has {count}")
    bad = np.isinf(values) if column.may_be_nan else ~np.isfinite(values)
    _refuse_rows(name, bad, values, "is not finite")
    _check_range(column, values)
    return values


def _check_paths(columns: Columns, count: int) -> None:
    paths = [name for name in PATH_NAMES if name in columns]
    if not paths:
        return
    for name in ("path_offsets", "path_vertices"):
        if name not in columns:
            raise ArgumentError(f"the column {name} is missing; {paths[0]} needs it")
    _check_offsets(columns, count)
    vertex_count = len(columns["path_vertices"])
    for column in PATH_COLUMNS:
        if column.name in columns and len(columns[column.name]) != vertex_count:
            raise ArgumentError(f"{column.name} has {len(columns[column.name])} rows, path_vertices has {vertex_count}")
