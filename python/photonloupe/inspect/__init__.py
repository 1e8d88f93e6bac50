# SPDX-License-Identifier: Apache-2.0
"""What is computed for looking at photons: columns, the loupe, cells, plots, errors.

The studio shows the same things; here they are arrays.

Examples
--------
>>> import photonloupe as pl
>>> photons = pl.trace_photons(pl.load_scene("scenes/ring/ring.gltf"), count=10_000, seed=1)
>>> view = pl.inspect.loupe(photons, photons.positions[0], k=50)
>>> len(view.ids), view.numbers.interactions
(50, 'R')
"""

from photonloupe.inspect.cells import CellView, NodeBox, SurfaceView, kd_tree, surfaces, voronoi
from photonloupe.inspect.columns import Column, ColumnInfo, column, columns
from photonloupe.inspect.error_map import ErrorMap, error_map
from photonloupe.inspect.histogram import ColumnHistogram, histogram
from photonloupe.inspect.loupe import LoupeNumbers, LoupeView, PathLine, loupe
from photonloupe.inspect.parallel_axes import Axis
from photonloupe.inspect.parallel_coordinates import AxisDensity, ParallelCoordinates, parallel_coordinates
from photonloupe.inspect.scatter import ScatterPlot, scatter

__all__ = [
    "Axis",
    "AxisDensity",
    "CellView",
    "Column",
    "ColumnHistogram",
    "ColumnInfo",
    "ErrorMap",
    "LoupeNumbers",
    "LoupeView",
    "NodeBox",
    "ParallelCoordinates",
    "PathLine",
    "ScatterPlot",
    "SurfaceView",
    "column",
    "columns",
    "error_map",
    "histogram",
    "kd_tree",
    "loupe",
    "parallel_coordinates",
    "scatter",
    "surfaces",
    "voronoi",
]
