# SPDX-License-Identifier: Apache-2.0
"""The ring's caustic cell by cell: the reference, which cells are edge or smooth, and the errors of an estimate."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

import numpy as np
from caustic_truth import RED, bin_photons, find_cache, load_truth
from numpy.lib.stride_tricks import sliding_window_view
from numpy.typing import NDArray
from scene_data import RING, WINDOW_CELLS, build_cell_centers, load_scene
from scipy.spatial import cKDTree

import photonloupe as pl

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))

from oracles import MirrorCylinder

Doubles = NDArray[np.float64]
Mask = NDArray[np.bool_]
Kind = TypeVar("Kind", np.bool_, np.float64)

CELL_SIDE = 2.0 * RING.window_half / WINDOW_CELLS  # m
# METHODS section 7, figures of merit, in cells.
EDGE_MARGIN, SMOOTH_MARGIN = 3, 12
JUMP, JUMP_WINDOW = 3.0, 5
LIT = 0.1  # of the window's mean
# The sum over lines is a midpoint rule across them: with so many it differs from 10⁸ binned paths by their noise only.
LINES = 100_000
# Farther than this from light the estimate is a faint and even halo, of which every fourth point tells enough.
HALO_MARGIN, HALO_STEP = 16, 4
# The committed line crosses the cusp 8 cm behind its tip, where both branches of the fold enclose the light that has
# crossed itself: x = -0.08 m ... 0.08 m at z = -0.48 m, the row of cells with this middle.
LINE_Z, LINE_HALF = -0.48, 0.08  # m
# The inner band: two arcs behind the fold across which the light that met the wall once more or less ends, steps of
# 1.2× to 1.8×. Its cells are those where the reference steps so much from the cell before to the cell after, and
# near them; what survives is found from values less their local mean.
STEP, STEP_MARGIN, STEP_AWAY, LOCAL = 0.16, 3, 9, 4


@dataclass(frozen=True)
class Errors:
    """Of one estimate: the first two over all cells in units of the window's mean, smooth and edge relative."""

    rmse: float
    mean_abs: float
    smooth: float  # RMS of E / reference - 1 over the smooth cells
    edge: float  # sum of |E - reference| over sum of the reference, edge cells
    contrast: float  # of the band on the committed line, 1 = the reference's
    inner: float  # share of the inner band's local contrast that survives


def average_errors(errors: list[Errors]) -> Errors:
    """Mean of every figure over seeds."""
    return Errors(*(float(np.mean([getattr(each, field.name) for each in errors])) for field in fields(Errors)))


def spread(values: NDArray[Kind], reach: int, pick: np.ufunc = np.maximum) -> NDArray[Kind]:
    """Greatest (or by `pick`) value within `reach` cells along both axes."""
    for axis in (0, 1):
        pads = [(reach, reach) if each == axis else (0, 0) for each in (0, 1)]
        windows = sliding_window_view(np.pad(values, pads, mode="edge"), 2 * reach + 1, axis=axis)
        values = pick.reduce(windows, axis=-1)
    return values


def sharpen(values: Doubles) -> Doubles:
    """Values less the mean of the (2 LOCAL + 1)² cells about each."""
    size = 2 * LOCAL + 1
    summed = np.pad(values, LOCAL, mode="edge")
    for axis in (0, 1):
        totals = np.insert(np.cumsum(summed, axis), 0, 0.0, axis)
        count = values.shape[axis]
        summed = np.take(totals, range(size, size + count), axis) - np.take(totals, range(count), axis)
    return values - summed / size**2


class Reference:
    """Mean irradiance of every cell, (512, 512) [x, z], red, W/m²."""

    def __init__(self, cells: Doubles, noise: float) -> None:
        self.cells, self.noise = cells.reshape(WINDOW_CELLS, WINDOW_CELLS), noise
        self.mean = float(cells.mean())
        lit = self.cells > LIT * self.mean
        self.edge: Mask = self._find_edge()
        self.smooth: Mask = lit & ~spread(self.edge, SMOOTH_MARGIN)
        self.near: Mask = spread(lit, HALO_MARGIN)
        self.inner: Mask = self._find_inner(lit)
        self._local = sharpen(self.cells)[self.inner]

    def _find_edge(self) -> Mask:
        """Cells near the caustic's curve, and where the rims cut the light."""
        edges = np.linspace(-RING.window_half, RING.window_half, WINDOW_CELLS + 1)
        curve = build_oracle().find_caustic_cells(edges, edges, margin=EDGE_MARGIN)
        most = spread(self.cells, JUMP_WINDOW // 2)
        least = spread(self.cells, JUMP_WINDOW // 2, np.minimum)
        return curve | ((most > JUMP * least) & (most > LIT * self.mean))

    def _find_inner(self, lit: Mask) -> Mask:
        """Cells near the steps of the inner band."""
        steps = np.zeros(lit.shape, dtype=bool)
        logs = np.log(np.maximum(self.cells, LIT * self.mean))
        for axis in (0, 1):
            steps |= np.abs(np.roll(logs, 1, axis) - np.roll(logs, -1, axis)) > STEP
        steps &= lit & ~spread(self.edge, STEP_AWAY)
        return spread(steps, STEP_MARGIN)

    def find_survival(self, cells: Doubles) -> float:
        """Slope of an estimate against the reference over the inner band, both less their local means."""
        return float(np.sum(sharpen(cells)[self.inner] * self._local) / np.sum(self._local**2))

    def find_contrast(self, cells: Doubles) -> float:
        """(peak - trough)/(peak + trough) on the committed line, where the reference has its peaks and its trough."""
        half = round(LINE_HALF / CELL_SIDE)
        middle, row = WINDOW_CELLS // 2, int((LINE_Z + RING.window_half) / CELL_SIDE)
        line, truth = (values[middle - half : middle + half, row] for values in (cells, self.cells))
        peaks = [int(truth[:half].argmax()), half + int(truth[half:].argmax())]
        peak, trough = line[peaks].mean(), line[half - 1 : half + 1].mean()
        return float((peak - trough) / (peak + trough))

    def measure(self, cells: Doubles) -> Errors:
        """Hold an estimate against the reference; its noise is in the errors."""
        difference = cells - self.cells
        relative = difference[self.smooth] / self.cells[self.smooth]
        return Errors(
            rmse=float(np.sqrt(np.mean(difference**2)) / self.mean),
            mean_abs=float(np.mean(np.abs(difference)) / self.mean),
            smooth=float(np.sqrt(np.mean(relative**2))),
            edge=float(np.abs(difference[self.edge]).sum() / self.cells[self.edge].sum()),
            contrast=self.find_contrast(cells) / self.find_contrast(self.cells),
            inner=self.find_survival(cells),
        )


def build_oracle() -> MirrorCylinder:
    """The ring's closed form."""
    return MirrorCylinder(RING.radius, RING.wall_height, RING.light, RING.intensity, RING.mirror_color)


@lru_cache
def load_reference(*, one_reflection: bool = True) -> Reference:
    """Cells of light reflected once, from the closed form, kept beside the truth; or binned cells of all light."""
    if not one_reflection:
        truth = load_truth()
        return Reference(truth.cells, truth.noise)
    scene = load_scene("ring")
    cache = find_cache(scene).with_name(f"closed-form-{scene.hash[:16]}-{LINES}.npy")
    if not cache.exists():
        print(f"  summing {LINES:,} lines of light for the reference, once", flush=True)
        edges = np.linspace(-RING.window_half, RING.window_half, WINDOW_CELLS + 1)
        flux = build_oracle().cell_flux(edges, edges, count=LINES)[RED]
        with cache.with_suffix(".part").open("wb") as file:
            np.save(file, flux / CELL_SIDE**2)
        cache.with_suffix(".part").replace(cache)
    return Reference(np.load(cache), 0.0)


@lru_cache
def find_points(reference: Reference) -> tuple[NDArray[np.float32], NDArray[np.int64]]:
    """Cell middles to estimate at, (n, 3), and which of them stands for each cell, (512, 512)."""
    index = np.arange(WINDOW_CELLS)
    coarse = index - index % HALO_STEP + HALO_STEP // 2
    itself = index[:, None] * WINDOW_CELLS + index
    stands = np.where(reference.near, itself, coarse[:, None] * WINDOW_CELLS + coarse)
    chosen, rows = np.unique(stands, return_inverse=True)
    return np.ascontiguousarray(build_cell_centers()[chosen]), rows.reshape(stands.shape)


# Places whose neighbors are summed at once: bounds the memory.
BLOCK = 8_192


def estimate_at(photons: pl.PhotonMap, points: NDArray[np.float32], ks: Sequence[int]) -> dict[int, Doubles]:
    """Red Epanechnikov estimates (METHODS section 2) for all k from one search; on one plane those of `irradiance`.

    SciPy searches: what measures our photons shares no search with what moves them.
    """
    tree = cKDTree(np.asarray(photons.positions, dtype=np.float64))
    power = photons.power[:, RED].astype(np.float64)
    estimates = {k: np.empty(len(points)) for k in ks}
    for first in range(0, len(points), BLOCK):
        distances, ids = tree.query(points[first : first + BLOCK], max(ks) + 1, workers=-1)
        squares = distances**2
        flux = power[ids]
        summed, moment = np.cumsum(flux, axis=1), np.cumsum(flux * squares, axis=1)
        for k in ks:
            r2 = np.maximum(squares[:, k], np.finfo(np.float32).tiny)
            values = 2.0 / (np.pi * r2) * (summed[:, k - 1] - moment[:, k - 1] / r2)
            estimates[k][first : first + BLOCK] = values
    return estimates


def estimate_cells(photons: pl.PhotonMap, ks: Sequence[int], reference: Reference) -> dict[int, Doubles]:
    """Irradiance at the cells' middles for several k; a cell with more than k photons, wider than the support, counts.

    The reference holds averages, and the estimate at one point is none where its support is smaller than the cell.
    """
    points, rows = find_points(reference)
    counted = bin_photons(photons).reshape(rows.shape)
    share = counted * CELL_SIDE**2 / photons.power[:, RED].max()
    estimates = estimate_at(photons, points, ks)
    return {k: np.where(share > k, counted, values[rows]) for k, values in estimates.items()}
