# SPDX-License-Identifier: Apache-2.0
"""Draws axes, densities, brushes and labels over the curves of parallel coordinates."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image as Pillow
from PIL import ImageColor, ImageDraw, ImageFont

# The look of the SVG, see FigureStyle of engine/inspect/parallel_figure.h.
AXIS_COLOR = "#333333"
DENSITY_COLOR = "#8c8c8c"
BRUSH_COLOR = "#d97706"
DENSITY_OPACITY = 0.45
BRUSH_OPACITY = 0.55
FONT_SIZE = 12
# Shapes are drawn this much larger and averaged down.
_FINER = 3
_BAR_CORNERS = 4


def draw_marks(pixels: NDArray[np.uint8], marks: list[Any], labels: list[str]) -> NDArray[np.uint8]:
    """Return (h, w, 3) of opaque curves (h, w, 4) with everything else that a figure needs to stand alone.

    Examples
    --------
    >>> import numpy as np
    >>> from photonloupe.inspect.figure_marks import draw_marks
    >>> draw_marks(np.zeros((2, 4, 4), np.uint8), [], []).shape
    (2, 4, 3)
    """
    height, width = pixels.shape[:2]
    picture = Pillow.frombuffer("RGBX", (width, height), pixels, "raw", "RGBX", 0, 1).convert("RGB")
    draw = ImageDraw.Draw(picture)
    for (place, above, below, areas, brushes, ticks), label in zip(marks, labels, strict=True):
        is_line = place[2] == 0
        for outline in areas:
            if is_line and len(outline) > _BAR_CORNERS:
                _draw_graph(picture, outline, place[0], DENSITY_COLOR, DENSITY_OPACITY)
            else:
                _draw_area(picture, outline, DENSITY_COLOR, DENSITY_OPACITY)
        for outline in brushes:
            _draw_area(picture, outline, BRUSH_COLOR, BRUSH_OPACITY)
        _draw_axis(picture, place)
        for tick in ticks:
            draw.line(tick, fill=AXIS_COLOR)
        x, y, _, ry = place
        for text, at in ((label, y - ry - 20), (above, y - ry - 5), (below, y + ry + 14)):
            if text:
                draw.text((x, at), text, fill=AXIS_COLOR, font=_load_font(), anchor="ms")
    return np.asarray(picture)


@cache
def _load_font() -> Any:
    return ImageFont.load_default(FONT_SIZE)


def _draw_area(picture: Pillow.Image, outline: NDArray[np.float32], color: str, opacity: float) -> None:
    if len(outline) == 0:
        return
    low = np.maximum(np.floor(outline.min(axis=0)), 0).astype(int)
    high = np.minimum(np.ceil(outline.max(axis=0)), picture.size).astype(int)
    if np.any(high <= low):
        return
    mask = Pillow.new("L", tuple((high - low) * _FINER))
    points = ((outline - low) * _FINER).ravel().tolist()
    ImageDraw.Draw(mask).polygon(points, fill=round(255 * opacity))
    picture.paste(ImageColor.getrgb(color), tuple(low), mask.reduce(_FINER))


def _draw_graph(picture: Pillow.Image, outline: NDArray[np.float32], left: float, color: str, opacity: float) -> None:
    """Fill between the line x = `left` and an outline to its right, row by row: quicker than a polygon."""
    graph = outline[:-2]  # the last two are the ends of the line
    graph = graph[np.argsort(graph[:, 1])]
    top, bottom = int(graph[0, 1]), int(np.ceil(graph[-1, 1]))
    widths = np.interp(np.arange(top, bottom) + 0.5, graph[:, 1], graph[:, 0]) - left
    cover = np.clip(widths[:, None] - np.arange(int(np.ceil(widths.max()))), 0.0, 1.0)
    mask = Pillow.fromarray((255 * opacity * cover + 0.5).astype(np.uint8))
    picture.paste(ImageColor.getrgb(color), (int(left), top), mask)


def _draw_axis(picture: Pillow.Image, place: tuple[float, float, float, float]) -> None:
    x, y, rx, ry = place
    if rx == 0:
        ImageDraw.Draw(picture).line((x, y - ry, x, y + ry), fill=AXIS_COLOR)
        return
    left, top = int(x - rx) - 1, int(y - ry) - 1
    size = (int(2 * rx) + 4, int(2 * ry) + 4)
    mask = Pillow.new("L", (size[0] * _FINER, size[1] * _FINER))
    box = np.array([x - rx - left, y - ry - top, x + rx - left, y + ry - top]) * _FINER
    ImageDraw.Draw(mask).ellipse(box.tolist(), outline=255, width=_FINER)
    picture.paste(ImageColor.getrgb(AXIS_COLOR), (left, top), mask.reduce(_FINER))
