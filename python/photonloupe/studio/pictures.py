# SPDX-License-Identifier: Apache-2.0
"""8-bit pictures of the interface as PNG files."""

from __future__ import annotations

import io
import os
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.errors import ArgumentError


def encode_pixels(pixels: NDArray[np.uint8]) -> bytes:
    """Encode (h, w, 3) sRGB pixels as a PNG."""
    from PIL import Image as PillowImage  # noqa: PLC0415 - loaded when a picture is written

    stream = io.BytesIO()
    PillowImage.fromarray(np.ascontiguousarray(pixels)).save(stream, "png")
    return stream.getvalue()


def write_pixels(path: str | os.PathLike[str], pixels: NDArray[np.uint8]) -> None:
    """Write (h, w, 3) sRGB pixels as a PNG; a killed write leaves the old file or the new one."""
    target = Path(path)
    if target.suffix.lower() != ".png":
        raise ArgumentError(f"{target}: pictures of the interface are .png files")
    _engine.write_file(str(target), encode_pixels(pixels))
