# SPDX-License-Identifier: Apache-2.0
"""Pictures: linear pixels with what made them, saved as EXR or PNG."""

from __future__ import annotations

import math
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_number
from photonloupe.errors import ArgumentError, FileFormatError
from photonloupe.metrics import ImageDifference, compare_images
from photonloupe.provenance import decode_attributes, encode_attributes

SUFFIXES = (".exr", ".png")
# 2^±64 spans every radiance a 32-bit float can hold next to 1.
MAX_EXPOSURE = 64.0
_EIGHT_BITS = 255.0
_FITTING_SHARE = 0.98


class Image:
    """A picture: (h, w, 3) float32, row 0 at the top, linear Rec. 709 radiance in W/(m²·sr).

    Parameters
    ----------
    pixels
        (h, w, 3) linear values.
    provenance
        What made it; goes into the file's header.
    exposure
        Stops that `_repr_png_` and PNG files brighten by.
    linear
        False for a picture read from a PNG: it was clipped and rounded to 8 bits, and compares as such.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> image = pl.Image(np.zeros((2, 3, 3)))
    >>> np.asarray(image).shape
    (2, 3, 3)
    """

    def __init__(
        self,
        pixels: ArrayLike,
        *,
        provenance: Mapping[str, Any] | None = None,
        exposure: float = 0.0,
        linear: bool = True,
    ) -> None:
        array = np.array(pixels, dtype=np.float32, order="C", copy=True)
        if array.ndim != 3 or array.shape[2] != 3 or array.size == 0:
            raise ArgumentError(f"pixels must have shape (h, w, 3), not {array.shape}")
        array.setflags(write=False)
        self._pixels = array
        self.provenance: dict[str, Any] = dict(provenance or {})
        self.exposure = check_number("exposure", exposure, -MAX_EXPOSURE, MAX_EXPOSURE)
        self.linear = linear

    @property
    def width(self) -> int:
        """Pixels in a row."""
        return int(self._pixels.shape[1])

    @property
    def height(self) -> int:
        """Rows."""
        return int(self._pixels.shape[0])

    def find_exposure(self) -> float:
        """Find the stops that make all but the brightest fiftieth of the lit pixels fit a PNG, in steps of 0.1."""
        brightest = self._pixels.max(axis=2)
        lit = brightest[np.isfinite(brightest) & (brightest > 0.0)]
        if len(lit) == 0:
            return 0.0
        stops = -math.log2(float(np.quantile(lit.astype(np.float64), _FITTING_SHARE)))
        return round(min(max(stops, -MAX_EXPOSURE), MAX_EXPOSURE), 1)

    def find_clipped_share(self, exposure: float) -> float:
        """Find the share of the pixels that a PNG of that exposure cannot hold, for a channel is above 1."""
        with np.errstate(over="ignore"):
            return float((self._pixels.max(axis=2) * np.float32(2.0**exposure) > 1.0).mean())

    def save(self, path: str | os.PathLike[str], *, exposure: float | str | None = None) -> None:
        """Write an .exr (32-bit float, ZIP) or a .png (clip(linear · 2^exposure), sRGB curve).

        Parameters
        ----------
        path
            Its suffix decides the format.
        exposure
            In stops, PNG only; ``"auto"``: what `find_exposure` says; default the image's own.

        Raises
        ------
        ArgumentError
            If the suffix is neither.
        FileFormatError
            If the file cannot be written.
        """
        target = check_image_path(path)
        attributes = encode_attributes(self.provenance)
        try:
            if target.suffix.lower() == ".exr":
                _engine.write_exr(os.fspath(target), self._pixels, attributes)
            else:
                _engine.write_png(os.fspath(target), self._pixels, self._choose_exposure(exposure), attributes)
        except OSError as error:
            raise FileFormatError(f"{target} cannot be written: {error.strerror or error}") from error

    def compare(self, reference: Image) -> ImageDifference:
        """Measure how far this image is from `reference`; see `compare_images`.

        Raises
        ------
        ArgumentError
            If the sizes differ, a pixel is not finite, or one is an 8-bit picture and the other is not.
        """
        if self.linear != reference.linear:
            raise ArgumentError("an 8-bit picture compares with another only; render both as EXR or both as PNG")
        if self.linear:
            return compare_images(self._pixels, reference._pixels, linear=True)
        return compare_images(encode_srgb(self._pixels), encode_srgb(reference._pixels), linear=False)

    def _choose_exposure(self, exposure: float | str | None) -> float:
        if exposure is None:
            return self.exposure
        if exposure == "auto":
            return self.find_exposure()
        return check_number("exposure", exposure, -MAX_EXPOSURE, MAX_EXPOSURE)

    def _repr_png_(self) -> bytes:
        return _engine.encode_png(self._pixels, self.exposure, encode_attributes(self.provenance))

    def __array__(self, dtype: DTypeLike | None = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False and dtype is not None and np.dtype(dtype) != self._pixels.dtype:
            raise ValueError("another type cannot be had without a copy")
        return np.array(self._pixels, dtype=dtype, copy=True) if copy else np.asarray(self._pixels, dtype=dtype)

    def __repr__(self) -> str:
        return f"<Image {self.width} × {self.height}, {'linear' if self.linear else '8-bit'}>"


def check_image_path(path: str | os.PathLike[str]) -> Path:
    """Return `path` if a picture can be written there: known suffix, existing folder."""
    target = Path(path)
    if target.suffix.lower() not in SUFFIXES:
        raise ArgumentError(f"{target} must end in {' or '.join(SUFFIXES)}")
    if not target.absolute().parent.is_dir():
        raise FileFormatError(f"{target.absolute().parent} is not a folder; make it first")
    return target


def load_image(path: str | os.PathLike[str]) -> Image:
    """Read an .exr or .png.

    Parameters
    ----------
    path
        The file.

    Returns
    -------
    Image
        Linear; the pixels of a PNG are taken back through the sRGB curve, and ``linear`` is False.

    Raises
    ------
    FileFormatError
        If the file is missing or damaged.
    ArgumentError
        If the suffix is neither.
    """
    source = Path(path)
    if source.suffix.lower() not in SUFFIXES:
        raise ArgumentError(f"{source} must end in {' or '.join(SUFFIXES)}")
    if not source.is_file():
        raise FileFormatError(f"{source} is not there, or is not a file")
    try:
        if source.suffix.lower() == ".exr":
            pixels, attributes = _engine.read_exr(os.fspath(source))
            return Image(pixels, provenance=decode_attributes(attributes))
        coded, attributes = _engine.read_png(os.fspath(source))
    except OSError as error:
        raise FileFormatError(f"{source} cannot be read: {error.strerror or error}") from error
    linear = decode_srgb(np.asarray(coded, dtype=np.float64) / _EIGHT_BITS)
    return Image(linear, provenance=decode_attributes(attributes), linear=False)


def encode_srgb(linear: ArrayLike) -> NDArray[np.float64]:
    """Apply the sRGB curve (IEC 61966-2-1) to values clipped to [0, 1]."""
    values = np.clip(np.asarray(linear, dtype=np.float64), 0.0, 1.0)
    return np.where(values <= 0.0031308, 12.92 * values, 1.055 * np.power(values, 1.0 / 2.4) - 0.055)


def decode_srgb(coded: ArrayLike) -> NDArray[np.float64]:
    """Undo `encode_srgb`."""
    values = np.asarray(coded, dtype=np.float64)
    return np.where(values <= 0.04045, values / 12.92, np.power((values + 0.055) / 1.055, 2.4))
