# SPDX-License-Identifier: Apache-2.0
"""The scenes and photon maps that the benchmarks share."""

from __future__ import annotations

import sys
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl

SCENES = Path(__file__).resolve().parents[2] / "scenes"
sys.path.append(str(SCENES))

from generate import RING, SLAB  # noqa: E402 - found through the line above
from gltf import Mesh, build_box, build_cylinder, build_quad  # noqa: E402

WINDOW_CELLS = 512
UP = (0.0, 1.0, 0.0)


@lru_cache
def load_scene(name: str) -> pl.Scene:
    """Load a scene of the repository once."""
    return pl.load_scene(SCENES / name / f"{name}.gltf")


def build_meshes(name: str) -> tuple[Mesh, Mesh]:
    """Build the specular mesh and the floor of a scene, the triangles its file holds."""
    if name == "ring":
        wall = build_cylinder(RING.radius, RING.wall_height, RING.segments, RING.rows)
        return wall, build_quad(RING.floor_half)
    half = SLAB.slab_half
    slab = build_box((-half, SLAB.slab_bottom, -half), (half, SLAB.slab_top, half))
    return slab, build_quad(SLAB.floor_half)


@lru_cache(maxsize=2)
def trace_ring_map(count: int) -> pl.PhotonMap:
    """Trace exactly `count` photons of the ring caustic, random emission."""
    photons = pl.trace_photons(load_scene("ring"), count, seed=1, emission="random")
    return photons.select(np.arange(count))


def build_cell_centers() -> NDArray[np.float32]:
    """Middles of the 512² cells of the ring's window x, z in [-2, 2] on the floor, (cells, 3)."""
    steps = (np.arange(WINDOW_CELLS) + 0.5) / WINDOW_CELLS * 2.0 * RING.window_half - RING.window_half
    x, z = np.meshgrid(steps, steps, indexing="ij")
    return np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3).astype(np.float32)
