# SPDX-License-Identifier: Apache-2.0
"""Pictures side by side with a line of text above each."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from photonloupe.image import decode_srgb

# In pixels: height of the text's letters, of its line, and the gap between pictures.
_LETTERS, _LINE, _GAP = 18, 28, 4
_WHITE = 255.0


def build_contact_sheet(pictures: Mapping[str, pl.Image], *, columns: int, exposure: float = 0.0) -> pl.Image:
    """Put pictures of one size side by side, row by row, each below its label.

    Parameters
    ----------
    pictures
        Labels and pictures.
    columns
        Pictures in a row.
    exposure
        In stops; the sheet is brightened by it already, so that its labels stay white.
    """
    tiles = [
        np.concatenate([_draw_label(label, image.width), np.asarray(image) * 2.0**exposure])
        for label, image in pictures.items()
    ]
    height, width = tiles[0].shape[:2]
    rows = -(-len(tiles) // columns)
    sheet = np.zeros((rows * (height + _GAP) - _GAP, columns * (width + _GAP) - _GAP, 3))
    for number, tile in enumerate(tiles):
        top, left = (number // columns) * (height + _GAP), (number % columns) * (width + _GAP)
        sheet[top : top + height, left : left + width] = tile
    origin = {label: image.provenance for label, image in pictures.items()}
    return pl.Image(sheet, provenance={"version": pl.__version__, "pictures": origin})


def _draw_label(text: str, width: int) -> NDArray[np.float64]:
    """Draw white text on black, (line, width, 3), linear."""
    from PIL import Image, ImageDraw, ImageFont  # noqa: PLC0415 - only the demo draws text

    line = Image.new("L", (width, _LINE))
    place = (_GAP, _LINE // 2)
    ImageDraw.Draw(line).text(place, text, fill=int(_WHITE), font=ImageFont.load_default(_LETTERS), anchor="lm")
    return np.repeat(decode_srgb(np.asarray(line) / _WHITE)[:, :, None], 3, axis=2)
