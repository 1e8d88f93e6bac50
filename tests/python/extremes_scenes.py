# SPDX-License-Identifier: Apache-2.0
"""Scenes for the extremes: a study scene moved or scaled, lights in glass, floors of nasty triangles."""

from __future__ import annotations

import json
import shutil
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import photonloupe as pl
from conftest import find_scene
from gltf import GltfWriter, Mesh, build_box, build_quad, make_diffuse, make_glass

FLOOR_HALF = 2.0
# 200 slivers 1 m long and 1 µm wide.
SLIVER_COUNT = 200
SLIVER_WIDTH = 1e-6


def move_scene(name: str, folder: Path, *, scale: float = 1.0, offset: Sequence[float] = (0.0, 0.0, 0.0)) -> pl.Scene:
    """Load a study scene below a node that scales and moves it."""
    source = find_scene(name)
    document = json.loads(source.read_text(encoding="utf-8"))
    root = {
        "name": "root",
        "scale": [scale] * 3,
        "translation": list(offset),
        "children": document["scenes"][0]["nodes"],
    }
    document["scenes"][0]["nodes"] = [len(document["nodes"])]
    document["nodes"].append(root)
    shutil.copy(source.with_suffix(".bin"), folder)
    path = folder / source.name
    path.write_text(json.dumps(document), encoding="utf-8")
    return pl.load_scene(path)


def load_lit_floor(
    folder: Path,
    *meshes: Mesh,
    light: tuple[float, float, float] = (0.0, 1.0, 0.0),
    intensity: float = 1.0,
    half: float = FLOOR_HALF,
) -> pl.Scene:
    """Load a light over a floor, made of `meshes` or of one square."""
    writer = GltfWriter("lit")
    for number, mesh in enumerate(meshes or (build_quad(half),)):
        writer.add_mesh(f"floor {number}", mesh, make_diffuse("plaster", 0.5))
    writer.add_point_light("lamp", light, intensity)
    writer.write(folder)
    return pl.load_scene(folder / "lit.gltf")


def load_glass_block(folder: Path, ior: float, *, light: tuple[float, float, float]) -> pl.Scene:
    """Load a glass cube of side 1 m above a floor; nothing else."""
    writer = GltfWriter("block")
    block = build_box((-0.5, 0.5, -0.5), (0.5, 1.5, 0.5))
    writer.add_mesh("block", block, make_glass("glass", ior, 1.0))
    writer.add_mesh("floor", build_quad(FLOOR_HALF), make_diffuse("plaster", 0.5))
    writer.add_point_light("lamp", light, 1.0)
    writer.write(folder)
    return pl.load_scene(folder / "block.gltf")


def find_trapped_share(ior: float) -> float:
    """Share of isotropic light that a cube keeps: all but six escape cones, where they do not overlap (ior > √2)."""
    return 1.0 - 6.0 * (1.0 - np.sqrt(1.0 - 1.0 / ior**2)) / 2.0


def _build_rectangles(x: np.ndarray, depth: tuple[float, float]) -> Mesh:
    """Facing up, one rectangle between each two of `x`, neighbors sharing their edges."""
    count = len(x)
    near = np.stack([x, np.zeros(count), np.full(count, depth[0])], axis=1)
    far = np.stack([x, np.zeros(count), np.full(count, depth[1])], axis=1)
    here = np.arange(count - 1)
    indices = np.concatenate(
        [np.stack([here, here + count, here + count + 1], 1), np.stack([here, here + count + 1, here + 1], 1)]
    )
    return Mesh(np.concatenate([near, far]), np.tile([0.0, 1.0, 0.0], (2 * count, 1)), indices)


def build_sliver_floor() -> Mesh:
    """Build the floor's strip |z| <= 0.5 as two wide rectangles with slivers between."""
    x = np.arange(SLIVER_COUNT + 1) * SLIVER_WIDTH
    return _build_rectangles(np.concatenate([[-FLOOR_HALF], x, [FLOOR_HALF]]), (-0.5, 0.5))


def build_plain_floor() -> Mesh:
    """Build the same strip as one rectangle."""
    return _build_rectangles(np.array([-FLOOR_HALF, FLOOR_HALF]), (-0.5, 0.5))


def add_zero_areas(mesh: Mesh) -> Mesh:
    """Add a triangle that is a point, one that is a line, and one with three corners on a line."""
    positions = np.concatenate([mesh.positions, [[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0]]])
    first = len(mesh.positions)
    extra = np.array([[0, 0, 0], [0, 1, 1], [first, first + 1, first + 2]])
    normals = np.concatenate([mesh.normals, np.tile([0.0, 1.0, 0.0], (3, 1))])
    return Mesh(positions, normals, np.concatenate([mesh.indices, extra]))
