# SPDX-License-Identifier: Apache-2.0
"""Axes of parallel coordinates: the column behind a name, and how it is shown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from photonloupe.checks import check_count, check_number
from photonloupe.errors import ArgumentError
from photonloupe.inspect.columns import Column
from photonloupe.inspect.columns import column as compute_column

if TYPE_CHECKING:
    from photonloupe.photons import PhotonMap

_LARGEST = float(np.finfo(np.float32).max)
MOST_PERIODS = 1000
# Whole numbers of which there are no more than this are counted, not smoothed.
MOST_DISTINCT = 64


@dataclass(frozen=True)
class Axis:
    """How one column is shown.

    Attributes
    ----------
    name
        Of the column: one that `photonloupe.inspect.columns` lists, or a key of the arrays given.
    low, high
        Range between the axis's ends, in the column's unit; default its bounds, or its least and largest value.
    closed
        True: an ellipse whose start is its end; None: where the column is periodic.
    periods
        How often the range winds round the ellipse, from 1.
    flipped
        True: downwards, or clockwise.
    brush
        Intervals ``(low, high)``, both ends included; photons in any of them are in focus. On a closed axis low may
        be the larger: the interval then goes on through the ends.

    Examples
    --------
    >>> import photonloupe as pl
    >>> pl.inspect.Axis("primal_phi", closed=True, brush=[(3.0, -3.0)]).periods
    1
    """

    name: str
    low: float | None = None
    high: float | None = None
    closed: bool | None = None
    periods: int = 1
    flipped: bool = False
    brush: Sequence[tuple[float, float]] = ()


def find_column(photons: PhotonMap | Mapping[str, ArrayLike], name: str) -> Column:
    """Return the column of that name, or raise `ArgumentError` that lists those there are."""
    if isinstance(photons, Mapping):
        if name not in photons:
            raise ArgumentError(f"there is no array {name!r}; there are {', '.join(map(str, photons))}")
        return _measure_column(name, photons[name])
    return compute_column(photons, name)


def _measure_column(name: str, given: ArrayLike) -> Column:
    array = np.asarray(given)
    if array.ndim != 1 or array.dtype.kind not in "fiub":
        raise ArgumentError(f"{name} must be numbers of shape (n,), not {array.dtype} {array.shape}")
    with np.errstate(over="ignore"):
        values = np.ascontiguousarray(array, dtype=np.float32)
    finite = values[np.isfinite(values)]
    low, high = (float(finite.min()), float(finite.max())) if len(finite) else (0.0, 0.0)
    is_whole = bool(len(finite)) and bool(np.all(finite == np.floor(finite)))
    is_discrete = is_whole and len(np.unique(finite)) <= MOST_DISTINCT
    return Column(name, name, values, low, high, 0.0, is_discrete)


def complete_axis(axis: Axis, column: Column, closed: bool) -> Axis:
    """Return `axis` with limits and form filled in, or raise `ArgumentError` that names it."""
    where = f"axis {axis.name}"
    low = column.low if axis.low is None else check_number(f"{where}: low", axis.low, -_LARGEST, _LARGEST)
    high = column.high if axis.high is None else check_number(f"{where}: high", axis.high, -_LARGEST, _LARGEST)
    if low > high:
        raise ArgumentError(f"{where} runs from {low:g} down to {high:g}; swap the limits and set flipped=True")
    periods = check_count(f"{where}: periods", axis.periods, 1, MOST_PERIODS)
    is_closed = closed if axis.closed is None else bool(axis.closed)
    brush = tuple(check_interval(where, interval, is_closed) for interval in axis.brush)
    return Axis(axis.name, low, high, is_closed, periods, bool(axis.flipped), brush)


def check_interval(where: str, interval: Any, is_closed: bool) -> tuple[float, float]:
    """Return a brushed interval, or raise `ArgumentError`."""
    try:
        low, high = interval
    except (TypeError, ValueError):
        raise ArgumentError(f"{where}: a brush is a pair (low, high), not {interval!r}") from None
    low = check_number(f"{where}: low end of a brush", low, -_LARGEST, _LARGEST)
    high = check_number(f"{where}: high end of a brush", high, -_LARGEST, _LARGEST)
    if low > high and not is_closed:
        raise ArgumentError(f"{where}: brush ({low:g}, {high:g}) ends before it begins; only a closed axis goes on")
    return low, high
