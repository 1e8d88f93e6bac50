# SPDX-License-Identifier: Apache-2.0
"""Shipped scenes with more receivers: two raised squares and a wall that cover part of the floor."""

from __future__ import annotations

import base64
import json
import shutil
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from conftest import find_scene
from generate import BOWL, LIGHTGUIDE, PRISM, RING, SLAB
from gltf import Mesh, make_diffuse

Doubles = NDArray[np.float64]

# Half the side of the floor's window; every scene of one receiver.
WINDOWS = {scene.name: scene.window_half for scene in (RING, PRISM, SLAB, BOWL, LIGHTGUIDE)}
HEIGHTS = (0.05, 0.3)  # m
# The slab's underside lies at 0.3 m: surfaces in one place would be met in no sure order.
SLAB_HEIGHTS = (0.05, 0.25)
WALL_HEIGHT = 0.6  # m
# Borders in windows' halves, x and z, of the squares; the wall's x, and how far along z it runs.
SQUARES = (((0.15, 0.6), (-0.5, 0.1)), ((0.3, 0.8), (-0.1, 0.5)))
WALL_X, WALL_HALF = 0.9, 0.7
FLOAT, UINT16 = 5126, 5123  # glTF component types
WHOLE_FILE = "data:application/octet-stream;base64,"


def build_rectangle(corner: Sequence[float], first: Sequence[float], second: Sequence[float]) -> Mesh:
    """Parallelogram that faces the side from which `first` turns to `second` counter-clockwise."""
    origin, u, v = (np.array(vector, dtype=np.float64) for vector in (corner, first, second))
    normal = np.cross(u, v)
    positions = np.stack([origin, origin + u, origin + u + v, origin + v])
    return Mesh(positions, np.tile(normal / np.linalg.norm(normal), (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def build_receivers(name: str) -> list[Mesh]:
    """The low square, the high one, and the wall, which faces −x."""
    half = WINDOWS[name]
    heights = SLAB_HEIGHTS if name == "slab" else HEIGHTS
    meshes = []
    for height, ((left, right), (back, front)) in zip(heights, SQUARES, strict=True):
        corner = (left * half, height, back * half)
        meshes.append(build_rectangle(corner, (0.0, 0.0, (front - back) * half), ((right - left) * half, 0.0, 0.0)))
    corner = (WALL_X * half, 0.0, -WALL_HALF * half)
    meshes.append(build_rectangle(corner, (0.0, 0.0, 2.0 * WALL_HALF * half), (0.0, WALL_HEIGHT, 0.0)))
    return meshes


def add_values(document: dict[str, Any], values: NDArray[Any], component: int, kind: str) -> int:
    """Append an accessor with a view and a buffer of its own; return its number."""
    text = WHOLE_FILE + base64.b64encode(values.tobytes()).decode()
    document["buffers"].append({"uri": text, "byteLength": values.nbytes})
    document["bufferViews"].append({"buffer": len(document["buffers"]) - 1, "byteLength": values.nbytes})
    count = len(values) if kind == "VEC3" else values.size
    accessor = {"bufferView": len(document["bufferViews"]) - 1, "componentType": component, "type": kind}
    bounds = {"min": values.min(axis=0).tolist(), "max": values.max(axis=0).tolist()} if kind == "VEC3" else {}
    document["accessors"].append({**accessor, "count": count, **bounds})
    return len(document["accessors"]) - 1


def add_mesh(document: dict[str, Any], name: str, mesh: Mesh, material: dict[str, Any]) -> None:
    """Append a mesh as a node of its own."""
    attributes = {
        "POSITION": add_values(document, mesh.positions.astype("<f4"), FLOAT, "VEC3"),
        "NORMAL": add_values(document, mesh.normals.astype("<f4"), FLOAT, "VEC3"),
    }
    indices = add_values(document, mesh.indices.astype("<u2").ravel(), UINT16, "SCALAR")
    document["materials"].append(material)
    primitive = {"attributes": attributes, "indices": indices, "material": len(document["materials"]) - 1}
    document["meshes"].append({"name": name, "primitives": [primitive]})
    document["nodes"].append({"name": name, "mesh": len(document["meshes"]) - 1})
    document["scenes"][0]["nodes"].append(len(document["nodes"]) - 1)


def raise_receivers(name: str, folder: Path) -> pl.Scene:
    """Load a shipped scene with the squares and the wall beside its own receiver."""
    source = find_scene(name)
    document = json.loads(source.read_text(encoding="utf-8"))
    for label, mesh in zip(("low", "high", "screen"), build_receivers(name), strict=True):
        add_mesh(document, label, mesh, make_diffuse(label, 0.7))
    shutil.copy(source.with_suffix(".bin"), folder)
    path = folder / source.name
    path.write_text(json.dumps(document), encoding="utf-8")
    return pl.load_scene(path)
