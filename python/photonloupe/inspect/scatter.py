# SPDX-License-Identifier: Apache-2.0
"""Photons as points of a plane of two columns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_rows, check_size
from photonloupe.image import Image
from photonloupe.inspect.columns import require_columns
from photonloupe.photons import PhotonMap
from photonloupe.rendering import MAX_SIDE

# Of the picture behind the points, linear.
_BACKGROUND = 0.015
# Points from which on their density is drawn.
DENSE_FROM = 100_000
_MOST = 2**32 - 1


@dataclass(frozen=True)
class ScatterPlot:
    """A scatter plot.

    Attributes
    ----------
    image
        The points on a dark ground.
    rgba
        (h, w, 4) the points alone, sRGB with straight alpha.
    pixels
        (n, 2) column and row where each photon lies, pixel centers at halves; NaN where it lies nowhere.
    x_label, y_label, x_range, y_range
        Of the axes; polar: of angle and radius.
    drawn
        Photons within the picture.
    dense
        Whether their density is drawn, on a logarithmic scale, in place of the points.
    """

    image: Image
    rgba: NDArray[np.uint8]
    pixels: NDArray[np.float64]
    x_label: str
    y_label: str
    x_range: tuple[float, float]
    y_range: tuple[float, float]
    drawn: int
    dense: bool
    _find_data: Callable[[float, float], tuple[float, float]] = field(repr=False, compare=False)

    def to_data(self, column: float, row: float) -> tuple[float, float]:
        """Return the values of both columns at a place in the picture."""
        return self._find_data(float(column), float(row))


def scatter(
    photons: PhotonMap,
    x: str,
    y: str,
    size: Sequence[int] = (512, 512),
    polar: bool = False,
    selection: ArrayLike | None = None,
    color: str | None = None,
    *,
    dense_from: int = DENSE_FROM,
) -> ScatterPlot:
    """Plot photons by two columns ([SJL15] figures 9 f and 10).

    Parameters
    ----------
    photons
        The map; paths that the columns need are recorded now.
    x, y
        Columns that `photonloupe.inspect.columns` lists.
    size
        Width and height in pixels.
    polar
        `x` is the angle, `y` the radius: angle 0 points up, a quarter of a turn to the right, as (θ sin φ, θ cos φ).
    selection
        Boolean mask (n,) or ids; the others stay as context, in grey.
    color
        ``"encoding"`` (default): the colors a script gave, else one of its own for each photon; or a column.
    dense_from
        From so many points on their density is drawn.

    Returns
    -------
    ScatterPlot

    Raises
    ------
    ArgumentError
        If a column is not there, or size or selection do not fit.

    Examples
    --------
    >>> import photonloupe as pl
    >>> photons = pl.trace_photons(pl.load_scene("scenes/ring/ring.gltf"), count=10_000, seed=1)
    >>> plot = pl.inspect.scatter(photons, "primal_phi", "primal_theta", polar=True)
    >>> plot.drawn == len(photons)
    True
    """
    color = "encoding" if color is None else color
    names = (x, y) if color == "encoding" else (x, y, color)
    require_columns(photons, names)
    width, height = check_size(size, 1, MAX_SIDE)
    settings = {
        "x": x,
        "y": y,
        "color": color,
        "width": width,
        "height": height,
        "polar": bool(polar),
        "x_range": None,
        "y_range": None,
        "dense_from": check_count("dense_from", dense_from, 0, _MOST),
    }
    chosen = None if selection is None else check_rows(selection, len(photons)).tolist()
    row = _engine.plot_scatter(photons.device._native, photons._native, settings, chosen)
    rgba = row.pop("rgba").reshape(settings["height"], settings["width"], 4)
    return ScatterPlot(image=_lay_on_ground(rgba), rgba=rgba, _find_data=row.pop("to_data"), **row)


def _lay_on_ground(rgba: NDArray[np.uint8]) -> Image:
    srgb = rgba[..., :3] / 255.0
    linear = np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    alpha = rgba[..., 3:] / 255.0
    return Image(alpha * linear + (1.0 - alpha) * _BACKGROUND)
