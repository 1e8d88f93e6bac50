# SPDX-License-Identifier: Apache-2.0
"""How far two images are apart: RMSE, relMSE and FLIP."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.errors import ArgumentError

# FLIP picks its exposures from the reference and ends the process where the brightest pixel is below 1.2e-7;
# outside this range both images are scaled alike, which changes none of what it compares.
_FLIP_RANGE = (1e-3, 1e6)
_LUMINANCE = (0.2126, 0.7152, 0.0722)  # Rec. 709


@dataclass(frozen=True)
class ImageDifference:
    """How image A differs from reference B.

    Attributes
    ----------
    rmse
        √mean((a − b)²) over pixels and channels, in the images' unit.
    relmse
        mean((a − b)² / (b² + 0.01·mean(b)²)).
    flip
        Mean FLIP error in [0, 1]: HDR-FLIP of linear images, LDR-FLIP of 8-bit ones.
    error_map
        (h, w) FLIP error of each pixel.
    """

    rmse: float
    relmse: float
    flip: float
    error_map: NDArray[np.float32]


def compare_images(image: ArrayLike, reference: ArrayLike, *, linear: bool = True) -> ImageDifference:
    """Measure how far `image` is from `reference`.

    Parameters
    ----------
    image, reference
        (h, w, 3) linear radiance, or with ``linear=False`` sRGB values in [0, 1].
    linear
        Whether the values are linear: then FLIP is HDR-FLIP.

    Returns
    -------
    ImageDifference

    Raises
    ------
    ArgumentError
        If the sizes differ or a pixel is not finite.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> gray = np.full((8, 8, 3), 0.5)
    >>> round(pl.compare_images(gray + 0.1, gray).rmse, 6)
    0.1
    """
    a, b = check_pair(image, reference)
    errors = _engine.map_errors(a, b, False, 0.0)
    error_map = _compute_flip(a.astype(np.float64), b.astype(np.float64), linear=linear)
    return ImageDifference(
        rmse=float(errors["rmse"]),
        relmse=float(errors["relmse"]),
        flip=float(error_map.mean(dtype=np.float64)),
        error_map=error_map,
    )


def check_pair(image: ArrayLike, reference: ArrayLike) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Return two images of one size as finite (h, w, 3) float32, or raise `ArgumentError` saying what is wrong."""
    a, b = _check_pixels("the image", image), _check_pixels("the reference", reference)
    if a.shape != b.shape:
        raise ArgumentError(
            f"the images differ in size: {a.shape[1]} × {a.shape[0]} and {b.shape[1]} × {b.shape[0]} pixels"
        )
    return a, b


def _check_pixels(name: str, image: ArrayLike) -> NDArray[np.float32]:
    with np.errstate(over="ignore"):
        pixels = np.ascontiguousarray(image, dtype=np.float32)
    if pixels.ndim != 3 or pixels.shape[2] != 3 or pixels.size == 0:
        raise ArgumentError(f"{name} must have shape (h, w, 3), not {pixels.shape}")
    finite = np.isfinite(pixels)
    if not finite.all():
        row, column, _ = np.unravel_index(int(np.argmin(finite)), pixels.shape)
        count = int(np.count_nonzero(~finite.all(axis=2)))
        raise ArgumentError(
            f"{name} has {count} pixels that are not finite in 32 bits, the first at row {row}, column {column}"
        )
    return pixels


def _compute_flip(a: NDArray[np.float64], b: NDArray[np.float64], *, linear: bool) -> NDArray[np.float32]:
    import flip_evaluator  # noqa: PLC0415 - imported at first use: `import photonloupe` stays quick

    parameters: dict[str, Any] = {}
    a, b = np.maximum(a, 0.0), np.maximum(b, 0.0)
    if linear:
        brightest = float((b @ np.array(_LUMINANCE)).max())
        if brightest == 0.0:
            # No exposure can be drawn from black; the values are compared as they are.
            parameters = {"startExposure": 0.0, "stopExposure": 0.0, "numExposures": 1}
        elif not _FLIP_RANGE[0] <= brightest <= _FLIP_RANGE[1]:
            a, b = a / brightest, b / brightest
    else:
        a, b = np.minimum(a, 1.0), np.minimum(b, 1.0)
    largest = float(np.finfo(np.float32).max)
    test = np.ascontiguousarray(np.minimum(a, largest), dtype=np.float32)
    reference = np.ascontiguousarray(np.minimum(b, largest), dtype=np.float32)
    error, _, _ = flip_evaluator.evaluate(
        reference, test, "HDR" if linear else "LDR", applyMagma=False, computeMeanError=False, parameters=parameters
    )
    return np.asarray(error, dtype=np.float32).reshape(b.shape[:2])
