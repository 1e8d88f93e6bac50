# SPDX-License-Identifier: Apache-2.0
"""Parallel coordinates: a curve per photon across any columns, on open and closed axes."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_number, check_rows, check_size
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError, FileFormatError, PhotonLoupeError
from photonloupe.image import Image, decode_srgb, encode_srgb
from photonloupe.inspect.columns import Column
from photonloupe.inspect.parallel_axes import Axis, complete_axis, find_column

if TYPE_CHECKING:
    from photonloupe.photons import PhotonMap

LEAST_SIDE, LARGEST_SIDE = 64, 16384
MOST_CURVES = 2000
_LINEAR = decode_srgb(np.arange(256) / 255.0).astype(np.float32)


@dataclass(frozen=True)
class AxisDensity:
    """How many of the photons in focus lie at each place of an axis, relative to the densest.

    Attributes
    ----------
    positions
        (s,) places along the axis, 0 at its low end to 1 at its high one; of bars their middles.
    heights
        (s,) density there, 0 to 1.
    is_bars
        True: the column is discrete, and each of its values has a bar.
    bandwidth
        Standard deviation of the Gaussian kernel, in the column's unit; 0 for bars.
    peak
        What height 1 stands for: the share of the photons per unit of the column, or a number of photons.
    """

    positions: NDArray[np.float32]
    heights: NDArray[np.float32]
    is_bars: bool
    bandwidth: float
    peak: float


@dataclass(frozen=True)
class ParallelCoordinates:
    """A plot and the numbers in it.

    Attributes
    ----------
    image
        The picture.
    axes
        As asked for, limits filled in.
    values
        (n, a) value of every photon on every axis; NaN: none.
    points
        (n, a, 2) where the curves meet the axes, pixels from the image's top left corner, y downwards.
    tangents
        (n, a - 1, 2) slope dy/dx of the curves at the two ends of every gap; NaN where a gap has no curve.
    density
        Of each axis; empty when none was asked for.
    selected
        (s,) ids of the photons in focus, ascending; the others are context, in grey.
    broken
        Number of photons without a value on some axis: their curve has a gap there.
    is_density
        True: there are so many curves that their number in each pixel is shown, on a logarithmic scale.
    """

    image: Image
    axes: tuple[Axis, ...]
    values: NDArray[np.float32]
    points: NDArray[np.float32]
    tangents: NDArray[np.float32]
    density: tuple[AxisDensity, ...]
    selected: NDArray[np.int64]
    broken: int
    is_density: bool
    _figure: _engine.ParallelFigure = field(repr=False)

    def save_svg(self, path: str | os.PathLike[str]) -> None:
        """Write the plot as SVG: curves as paths, or as a picture where their density is shown.

        Parameters
        ----------
        path
            The file, replaced only when the new one is whole.

        Raises
        ------
        ArgumentError
            If the path does not end in .svg.
        FileFormatError
            If it cannot be written.
        """
        target = os.fspath(path)
        if not target.lower().endswith(".svg"):
            raise ArgumentError(f"{target} must end in .svg")
        try:
            self._figure.write_svg(target)
        except PhotonLoupeError as error:
            raise FileFormatError(str(error)) from error


def parallel_coordinates(
    photons: PhotonMap | Mapping[str, ArrayLike],
    axes: Sequence[str | Axis],
    selection: ArrayLike | None = None,
    size: Sequence[int] = (900, 360),
    *,
    color: str | ArrayLike | None = None,
    closed: Iterable[str] | None = None,
    tension: float = 1.0,
    brushes: Mapping[str, Sequence[tuple[float, float]]] | None = None,
    density: bool = True,
    most_curves: int = MOST_CURVES,
    device: Device | int | str | None = None,
) -> ParallelCoordinates:
    """Plot every photon as a curve through its values on parallel axes ([SJL15] section 4.4).

    Between two axes a curve is a monotone cubic (Fritsch and Butland 1984): it never swings beyond the values it
    joins. Beside each axis stands the density of the photons in focus (Gaussian kernel, Silverman's bandwidth).

    Parameters
    ----------
    photons
        A map, or arrays (n,) by name.
    axes
        Names or `Axis`, from left to right: columns that `photonloupe.inspect.columns` lists, or keys of the arrays.
    selection
        Ids or mask of the photons in focus; the others are drawn beneath, in grey. None or empty: all.
    size
        Width and height in pixels.
    color
        Column by which the curves in focus are colored, or (n, 3) linear colors; default the map's false colors, else
        the first axis. Ordered values go through Viridis, periodic ones through Twilight.
    closed
        Names of the axes shown as ellipses; default those of periodic columns. `Axis.closed` goes before.
    tension
        1 for smooth curves, 0 for straight lines, or between.
    brushes
        Intervals by axis name, added to those of the axes. They narrow the focus to photons that are in some interval
        of every brushed axis.
    density
        False leaves the densities out.
    most_curves
        Beyond this number the density of curves is drawn instead of each.
    device
        Where it is drawn; default the map's, else the best there is.

    Returns
    -------
    ParallelCoordinates

    Raises
    ------
    ArgumentError
        If a name is unknown, an array does not fit, a limit or brush makes no sense, or the image has no room.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> rng = np.random.default_rng(1)
    >>> data = {"x": rng.normal(size=250), "phi": rng.uniform(0, 6.28, 250)}
    >>> plot = pl.inspect.parallel_coordinates(data, ["x", pl.inspect.Axis("phi", 0, 6.28, closed=True)])
    >>> plot.points.shape, len(plot.selected)
    ((250, 2, 2), 250)
    """
    shown, columns = _complete_axes(photons, axes, closed, brushes or {})
    count = len(columns[0].values)
    focus = check_rows([] if selection is None else selection, count)
    color_column, colors = _find_colors(photons, columns[0], color, count)
    settings = {
        "size": check_size(size, LEAST_SIDE, LARGEST_SIDE),
        "tension": check_number("tension", tension, 0.0, 1.0),
        "density": bool(density),
        "most_curves": check_count("most_curves", most_curves, 0, 2**31),
    }
    described = [vars(column) | vars(axis) for column, axis in zip(columns, shown, strict=True)]
    chosen = device if device is not None else getattr(photons, "device", None)
    try:
        figure = _engine.make_parallel_figure(
            open_device(chosen)._native,
            described,
            np.unique(focus).astype(np.uint32),
            vars(color_column) if color_column else None,
            colors,
            settings,
        )
    except PhotonLoupeError as error:
        if type(error) is PhotonLoupeError:
            raise ArgumentError(str(error)) from None
        raise
    return _gather_plot(figure, shown, columns, settings["size"])


def _complete_axes(
    photons: PhotonMap | Mapping[str, ArrayLike],
    axes: Sequence[str | Axis],
    closed: Iterable[str] | None,
    brushes: Mapping[str, Sequence[tuple[float, float]]],
) -> tuple[tuple[Axis, ...], list[Column]]:
    if isinstance(axes, str) or len(axes) == 0:
        raise ArgumentError(f"axes must be a list of at least one name or Axis, not {axes!r}")
    asked = [Axis(axis) if isinstance(axis, str) else axis for axis in axes]
    columns = [find_column(photons, axis.name) for axis in asked]
    names = [axis.name for axis in asked]
    for column in columns:
        if len(column.values) != len(columns[0].values):
            raise ArgumentError(
                f"{column.name} has {len(column.values)} values, {columns[0].name} has {len(columns[0].values)}"
            )
    ellipses = None if closed is None else set(closed)
    for name in {*(ellipses or ()), *brushes} - set(names):
        raise ArgumentError(f"closed or brushes name {name!r}, which is no axis; the axes are {', '.join(names)}")
    shown = []
    for axis, column in zip(asked, columns, strict=True):
        is_closed = column.period > 0 if ellipses is None else axis.name in ellipses
        widened = replace(axis, brush=(*axis.brush, *brushes.get(axis.name, ())))
        shown.append(complete_axis(widened, column, is_closed))
    return tuple(shown), columns


def _find_colors(
    photons: PhotonMap | Mapping[str, ArrayLike], first: Column, color: str | ArrayLike | None, count: int
) -> tuple[Column | None, NDArray[np.float32]]:
    none = np.empty((0, 3), np.float32)
    if color is None and not isinstance(photons, Mapping) and "colors" in photons.recorded:
        color = photons.colors
    if color is None:
        return first, none
    if isinstance(color, str):
        column = find_column(photons, color)
        if len(column.values) != count:
            raise ArgumentError(f"color {color} has {len(column.values)} values, the axes have {count}")
        return column, none
    colors = np.asarray(color, dtype=np.float64)
    if colors.shape != (count, 3):
        raise ArgumentError(f"color must be a column's name or have shape ({count}, 3), not {colors.shape}")
    unset = np.isnan(colors).any(axis=1, keepdims=True)
    return None, np.where(unset, _UNSET, encode_srgb(np.nan_to_num(colors))).astype(np.float32)


# sRGB of what has no color; that of engine/inspect/colormap.h.
_UNSET = 0.45


def _gather_plot(
    figure: _engine.ParallelFigure, axes: tuple[Axis, ...], columns: list[Column], size: tuple[int, int]
) -> ParallelCoordinates:
    from photonloupe.inspect.figure_marks import draw_marks  # noqa: PLC0415 - Pillow at first use

    count, width = len(columns[0].values), len(axes)
    points = np.empty((count, width, 2), np.float32)
    tangents = np.empty((count, width - 1, 2), np.float32)
    broken = 0
    for ids, its_points, its_tangents, its_broken in (figure.read_context(), figure.read_selected()):
        points[ids] = its_points.reshape(len(ids), width, 2)
        tangents[ids] = its_tangents.reshape(len(ids), width - 1, 2)
        broken += its_broken
    labels = [column.label for column in columns]
    pixels = draw_marks(np.asarray(figure.read_pixels()).reshape(size[1], size[0], 4), figure.read_marks(), labels)
    provenance = {"plot": "parallel coordinates", "axes": [axis.name for axis in axes]}
    return ParallelCoordinates(
        image=Image(_LINEAR[pixels], provenance=provenance),
        axes=axes,
        values=np.stack([column.values for column in columns], axis=1),
        points=points,
        tangents=tangents,
        density=tuple(AxisDensity(*row) for row in figure.read_densities()),
        selected=figure.read_selected()[0].astype(np.int64),
        broken=broken,
        is_density=figure.is_density,
        _figure=figure,
    )
