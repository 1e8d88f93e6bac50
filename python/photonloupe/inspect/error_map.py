# SPDX-License-Identifier: Apache-2.0
"""Where one picture differs from another."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_number
from photonloupe.image import Image
from photonloupe.metrics import check_pair

_LARGEST = 1e30


@dataclass(frozen=True)
class ErrorMap:
    """Errors by pixel.

    Attributes
    ----------
    absolute
        (h, w) luminance of |a - b|, in the images' unit.
    relative
        (h, w) the same over √(b² + 0.01·mean(b)²).
    rmse, relmse
        √mean((a - b)²) and mean((a - b)² / (b² + 0.01·mean(b)²)) over pixels and channels.
    image
        The errors in colors, dark where there is none.
    """

    absolute: NDArray[np.float32]
    relative: NDArray[np.float32]
    rmse: float
    relmse: float
    image: Image


def error_map(a: ArrayLike | Image, b: ArrayLike | Image, *, relative: bool = False, full: float = 0.0) -> ErrorMap:
    """Measure and color the errors of `a` against the reference `b`.

    Parameters
    ----------
    a, b
        (h, w, 3) each, linear.
    relative
        Whether the picture shows relative errors.
    full
        Error at the bright end of the colors; 0: the largest one.

    Returns
    -------
    ErrorMap

    Raises
    ------
    ArgumentError
        If the sizes differ or a pixel is not finite.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> gray = np.full((8, 8, 3), 0.5)
    >>> round(pl.inspect.error_map(gray + 0.25, gray).rmse, 6)
    0.25
    """
    image, reference = check_pair(a, b)
    row = _engine.map_errors(image, reference, bool(relative), check_number("full", full, 0.0, _LARGEST))
    return ErrorMap(image=Image(row.pop("pixels")), **row)
