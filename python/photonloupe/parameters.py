# SPDX-License-Identifier: Apache-2.0
"""Parameters of photons: names, bounds and periods, and the checks that a user's own values must pass."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe.checks import check_number
from photonloupe.errors import ArgumentError, FileFormatError

# Dimensions 0 to 2 are x, y, z; parameters are 3 to 15.
MAX_PARAMETERS = 13
FIRST_DIMENSION = 3
_LARGEST = float(np.finfo(np.float32).max)


@dataclass(frozen=True)
class Parameter:
    """One dimension of parameter space; distances wrap at `high` - `low` where it is periodic."""

    name: str
    low: float
    high: float
    periodic: bool = False

    @property
    def period(self) -> float:
        """Length after which the parameter repeats; 0 where it does not."""
        return self.high - self.low if self.periodic else 0.0


def check_parameters(
    values: ArrayLike,
    count: int,
    names: Sequence[str] | None,
    bounds: ArrayLike | None,
    periodic: Sequence[bool] | None,
) -> tuple[NDArray[np.float32], tuple[Parameter, ...]]:
    """Check a user's parameters for `count` photons; see `PhotonMap.set_parameters`."""
    try:
        given = np.asarray(values)
    except ValueError:
        raise ArgumentError("values is not a rectangular array") from None
    if given.ndim == 1:
        given = given[:, None]
    if given.ndim != 2 or given.dtype.kind not in "fiu" or not 1 <= given.shape[1] <= MAX_PARAMETERS:
        raise ArgumentError(
            f"values must be numbers of shape (n, m), m from 1 to {MAX_PARAMETERS}, not {given.dtype} {given.shape}"
        )
    if len(given) != count:
        raise ArgumentError(f"values has {len(given)} rows, the map has {count} photons")
    with np.errstate(over="ignore"):
        # A copy: the map must not change when the caller's array does.
        columns = np.array(given, dtype=np.float32, order="C", copy=True)
    if np.isinf(columns).any():
        row, dimension = np.unravel_index(int(np.argmax(np.isinf(columns))), columns.shape)
        raise ArgumentError(
            f"values[{row}][{dimension}] = {given[row, dimension]} is infinite or does not fit a 32-bit float; "
            "use NaN where a photon has no parameter"
        )
    width = columns.shape[1]
    taken = _check_names(names, width)
    flags = [False] * width if periodic is None else [bool(flag) for flag in periodic]
    if len(flags) != width:
        raise ArgumentError(f"periodic has {len(flags)} entries, values has {width} columns")
    limits = _check_bounds(bounds, columns)
    for name, (low, high), flag in zip(taken, limits, flags, strict=True):
        if flag and bounds is None:
            raise ArgumentError(f"{name} is periodic: its bounds must be given, they say where it wraps")
        if flag and not high > low:
            raise ArgumentError(f"{name} is periodic from {low:g} to {high:g}; the upper bound must be the larger")
    rows = zip(taken, limits, flags, strict=True)
    return columns, tuple(Parameter(name, low, high, flag) for name, (low, high), flag in rows)


def _check_names(names: Sequence[str] | None, width: int) -> list[str]:
    taken = [f"p{FIRST_DIMENSION + i}" for i in range(width)] if names is None else [str(name) for name in names]
    if len(taken) != width:
        raise ArgumentError(f"names has {len(taken)} entries, values has {width} columns")
    if len(set(taken)) != width or not all(taken):
        raise ArgumentError(f"names must be distinct and not empty, not {taken}")
    return taken


def _check_bounds(bounds: ArrayLike | None, columns: NDArray[np.float32]) -> list[tuple[float, float]]:
    if bounds is None:
        filled = np.where(np.isnan(columns).any(axis=1, keepdims=True), np.float32(np.nan), columns)
        filled = filled[~np.isnan(filled).any(axis=1)]
        if len(filled) == 0:
            return [(0.0, 0.0)] * columns.shape[1]
        return [(float(low), float(high)) for low, high in zip(filled.min(axis=0), filled.max(axis=0), strict=True)]
    try:
        given = np.asarray(bounds, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"bounds must be numbers of shape ({columns.shape[1]}, 2)") from None
    if given.shape != (columns.shape[1], 2):
        raise ArgumentError(f"bounds must have shape ({columns.shape[1]}, 2), not {given.shape}")
    limits = []
    for i, pair in enumerate(given):
        low, high = (check_number(f"bounds[{i}][{j}]", bound, -_LARGEST, _LARGEST) for j, bound in enumerate(pair))
        if high < low:
            raise ArgumentError(f"bounds[{i}] runs from {low:g} down to {high:g}; the upper bound comes second")
        limits.append((low, high))
    return limits


def list_axes(parameters: Sequence[Parameter]) -> list[tuple[str, float, float, float]]:
    """List name, bounds and period of each parameter, as the engine takes them."""
    return [(parameter.name, parameter.low, parameter.high, parameter.period) for parameter in parameters]


def describe_parameters(parameters: Sequence[Parameter]) -> list[dict[str, Any]]:
    """Turn parameters into what is saved with a map."""
    return [asdict(parameter) for parameter in parameters]


def read_parameters(rows: Sequence[Mapping[str, Any]], columns: NDArray[np.float32]) -> tuple[Parameter, ...]:
    """Turn what was saved with a map back into parameters."""
    try:
        names = [row["name"] for row in rows]
        bounds = [(row["low"], row["high"]) for row in rows]
        periodic = [row["periodic"] for row in rows]
        if not all(isinstance(flag, bool) for flag in periodic):
            raise ValueError("periodic is neither true nor false")
        return check_parameters(columns, len(columns), names, bounds, periodic)[1]
    except (ArgumentError, KeyError, TypeError, ValueError) as error:
        raise FileFormatError(f"the saved parameters are damaged: {error}; save the map again") from error
