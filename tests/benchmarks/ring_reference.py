# SPDX-License-Identifier: Apache-2.0
"""The ring's caustic after one reflection: binned truth, cells by their kind, and errors against it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from caustic_truth import FIRST_SEED, PATHS_PER_SET, SETS, Truth, bin_photons, find_cache
from numpy.typing import NDArray
from scene_data import RING, WINDOW_CELLS, load_scene

import photonloupe as pl


def load_order_truth() -> Truth:
    """Read the truth of photons of signature 1, or trace it once: `max_bounces=1` stores exactly those."""
    scene = load_scene("ring")
    whole = find_cache(scene)
    cache = whole.with_name(f"{whole.stem}-signature-1.npz")
    if not cache.exists():
        print(f"  tracing {SETS * PATHS_PER_SET:,} paths of one reflection for the truth, once", flush=True)
        sets = []
        for number in range(SETS):
            photons = pl.trace_photons(scene, emitted=PATHS_PER_SET, seed=FIRST_SEED + number, max_bounces=1)
            sets.append(bin_photons(photons))
        noise = np.sqrt(np.mean(np.var(sets, axis=0, ddof=1)) / SETS)
        with cache.with_suffix(".part").open("wb") as file:
            np.savez(file, cells=np.mean(sets, axis=0), noise=noise)
        cache.with_suffix(".part").replace(cache)
    with np.load(cache) as kept:
        return Truth(kept["cells"], float(kept["noise"]))
