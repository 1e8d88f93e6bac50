# SPDX-License-Identifier: Apache-2.0
"""Measures irradiance in every shipped scene with squares above its receiver and a wall: seconds, checked by the twin.

Points lie on all receivers (photons of the map, moved a little in their surface) and, a tenth of them, on the squares'
dark parts. A hundred of them are checked against the naive twin.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
from pathlib import Path

import numpy as np
from measure import format_seconds
from scene_data import SCENES

import photonloupe as pl

sys.path += [str(Path(__file__).resolve().parents[1] / "python"), str(SCENES)]

from raised_scenes import HEIGHTS, SLAB_HEIGHTS, WINDOWS, raise_receivers
from surface_twin import check_irradiance

COUNTS = (5_000, 50_000, 500_000)
POINTS, CHECKED, K = 20_000, 100, 50


def choose_points(name: str, photons: pl.PhotonMap) -> tuple[np.ndarray, np.ndarray]:
    """Places (n, 3) m and normals (n, 3)."""
    random = np.random.default_rng(1)
    rows = random.integers(0, len(photons), POINTS)
    places, normals = photons.positions[rows].copy(), photons.normals[rows].copy()
    dark = random.random(POINTS) < 0.1
    heights = SLAB_HEIGHTS if name == "slab" else HEIGHTS
    places[dark] = random.uniform(-WINDOWS[name], WINDOWS[name], (int(dark.sum()), 3))
    places[dark, 1] = random.choice(heights, int(dark.sum()))
    normals[dark] = (0.0, 1.0, 0.0)
    return places, normals


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, nargs="*", default=list(COUNTS))
    counts = parser.parse_args().count
    print(f"| scene | {' | '.join(f'{count:,} photons' for count in counts)} |")
    print("|---|" + "---|" * len(counts))
    with tempfile.TemporaryDirectory() as folder:
        for name in WINDOWS:
            scene = raise_receivers(name, Path(folder))
            cells = []
            for count in counts:
                photons = pl.trace_photons(scene, count, seed=1, store="indirect")
                places, normals = choose_points(name, photons)
                photons.irradiance(places[:100], normals[:100], k=K)  # the tree, and the kernels
                begin = time.perf_counter()
                photons.irradiance(places, normals, k=K)
                seconds = time.perf_counter() - begin
                check_irradiance(photons, places[:CHECKED], normals[:CHECKED], K, exact=False)
                cells.append(format_seconds(seconds))
            print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
