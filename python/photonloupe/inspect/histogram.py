# SPDX-License-Identifier: Apache-2.0
"""How often a column's values occur."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_number
from photonloupe.errors import ArgumentError
from photonloupe.inspect.columns import Column, column
from photonloupe.photons import PhotonMap
from photonloupe.progress import ProgressLike

MAX_BINS = 65_536
_LARGEST = float(np.finfo(np.float32).max)


@dataclass(frozen=True)
class ColumnHistogram:
    """Counts of a column's values.

    Attributes
    ----------
    column
        What was counted.
    edges
        (bins + 1,).
    counts
        (bins,); a bin holds its lower edge, the last one its upper edge too.
    below, above, non_finite
        Values that lie in no bin.
    cdf
        (bins,) share of the finite values up to each bin's upper edge.
    """

    column: Column
    edges: NDArray[np.float64]
    counts: NDArray[np.int64]
    below: int
    above: int
    non_finite: int
    cdf: NDArray[np.float64]

    def quantile(self, share: float) -> float:
        """Return the value that a share of the finite ones lie below; NaN where none is finite."""
        return float(_engine.find_quantile(self.column.values, check_number("share", share, 0.0, 1.0)))


def histogram(
    photons: PhotonMap,
    name: str,
    bins: int = 64,
    range: Sequence[float] | None = None,
    *,
    progress: ProgressLike = None,
) -> ColumnHistogram:
    """Count a column's values ([SJL15] figure 8 f, g for the isotropy).

    Parameters
    ----------
    photons
        The map.
    name
        One of the columns that `photonloupe.inspect.columns` lists.
    bins
        1 to 65,536.
    range
        Lower and upper end; by default the column's own. One without extent is widened by a half on both sides.
    progress
        True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    ColumnHistogram

    Raises
    ------
    ArgumentError
        If there is no such column, the map lacks what it is made of, or bins or range are out of theirs.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> line = {"positions": np.eye(3)[[0, 1, 2, 2]], "normals": [[0, 1, 0]] * 4, "power": np.ones((4, 3))}
    >>> pl.inspect.histogram(pl.PhotonMap.from_arrays(**line), "z", bins=2).counts.tolist()
    [2, 2]
    """
    bins = check_count("bins", bins, 1, MAX_BINS)
    ends = None if range is None else _check_range(range)
    found = column(photons, name, progress=progress)
    row = _engine.count_column(found.values, bins, ends, (found.low, found.high))
    return ColumnHistogram(column=found, **row)


def _check_range(given: Sequence[float]) -> tuple[float, float]:
    ends = tuple(given)
    if len(ends) != 2:
        raise ArgumentError(f"range must be (low, high), not {given!r}")
    low, high = (check_number("range", end, -_LARGEST, _LARGEST) for end in ends)
    if low > high:
        raise ArgumentError(f"range runs from {low:g} down to {high:g}; the lower end comes first")
    return low, high
