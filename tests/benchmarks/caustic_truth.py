# SPDX-License-Identifier: Apache-2.0
"""The ring's caustic as binned photons of more than 10^8 Sobol paths, kept in the user's temporary folder."""

from __future__ import annotations

import getpass
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scene_data import RING, WINDOW_CELLS, load_scene

import photonloupe as pl

SETS = 3  # independent scramblings: their spread is the truth's own noise
PATHS_PER_SET = 2**25
FIRST_SEED = 90_001
RED = 0  # the mirror reflects all of it, so that photons carry equal flux


@dataclass(frozen=True)
class Truth:
    """Mean irradiance of each cell in the red channel, W/m², and the standard error of a cell (RMS)."""

    cells: NDArray[np.float64]
    noise: float

    def find_error(self, irradiance: NDArray[np.floating]) -> float:
        """RMSE over the cells in units of the mean; the truth's own noise is in it."""
        return float(np.sqrt(np.mean((irradiance - self.cells) ** 2)) / self.cells.mean())


def bin_photons(photons: pl.PhotonMap) -> NDArray[np.float64]:
    """Red irradiance averaged over the cells, in the order of `build_cell_centers`."""
    half, side = RING.window_half, 2.0 * RING.window_half / WINDOW_CELLS
    x, z = (np.floor((photons.positions[:, axis] + half) / side).astype(np.int32) for axis in (0, 2))
    inside = (x >= 0) & (x < WINDOW_CELLS) & (z >= 0) & (z < WINDOW_CELLS)
    cell = (x * WINDOW_CELLS + z)[inside]
    return np.bincount(cell, photons.power[inside, RED], WINDOW_CELLS**2) / side**2


def find_cache(scene: pl.Scene) -> Path:
    """Where the truth of this scene and version lies."""
    folder = Path(tempfile.gettempdir()) / f"photonloupe-benchmarks-{getpass.getuser()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    return folder / f"truth-{scene.hash[:16]}-{pl.__version__}-{SETS}x{PATHS_PER_SET}.npz"


def load_truth() -> Truth:
    """Read the truth, or trace it once: about one and a half minutes on two cores."""
    scene = load_scene("ring")
    cache = find_cache(scene)
    if not cache.exists():
        print(f"  tracing {SETS * PATHS_PER_SET:,} paths for the truth, once", flush=True)
        sets = []
        for number in range(SETS):
            sets.append(bin_photons(pl.trace_photons(scene, emitted=PATHS_PER_SET, seed=FIRST_SEED + number)))
        noise = np.sqrt(np.mean(np.var(sets, axis=0, ddof=1)) / SETS)
        with cache.with_suffix(".part").open("wb") as file:
            np.savez(file, cells=np.mean(sets, axis=0), noise=noise)
        cache.with_suffix(".part").replace(cache)
    with np.load(cache) as kept:
        return Truth(kept["cells"], float(kept["noise"]))
