# SPDX-License-Identifier: Apache-2.0
"""Floors under lights of every kind, with and without something specular."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from conftest import write_scene
from gltf import GltfWriter, Mesh, build_box, build_quad, make_diffuse, make_glass, make_mirror

Doubles = NDArray[np.float64]
HEIGHT = 1.0
INNER, OUTER = 0.3, 0.6  # radians


def load(folder: Path, change: Callable[[GltfWriter], Any]) -> pl.Scene:
    return pl.load_scene(write_scene(folder, "lit", change, lamp=False))


def add_spot(writer: GltfWriter, inner: float = INNER, outer: float = OUTER) -> None:
    writer.add_spot_light("spot", (0.1, HEIGHT, -0.2), (0.1, 0.0, -0.2), 10.0, inner, outer)


def make_lamp(radiance: float, *, is_two_sided: bool = False) -> dict[str, Any]:
    return {
        **make_diffuse("lamp", 0.0),
        "doubleSided": is_two_sided,
        "emissiveFactor": [1.0, 0.5, 0.25],
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}},
    }


def build_panel(half: float, y: float, *, faces_up: bool = False) -> Mesh:
    quad = build_quad(half, y)
    return quad if faces_up else Mesh(quad.positions, -quad.normals, quad.indices[:, ::-1])


def render_below(scene: pl.Scene, samples: int = 64) -> Doubles:
    """Irradiance of the floor's middle, from a picture of it."""
    camera = pl.Camera(position=(0.3, 0.2, 0.0), target=(0.0, 0.0, 0.0), yfov=0.02)
    image = pl.render(scene, mode="direct", camera=camera, width=8, height=8, samples=samples)
    return np.asarray(image, dtype=np.float64).mean(axis=(0, 1)) * np.pi / 0.5


def add_optics(writer: GltfWriter) -> None:
    """A mirror and a glass block over part of the floor."""
    writer.add_mesh("mirror", build_panel(0.4, 0.45, faces_up=True), make_mirror("mirror", (1.0, 1.0, 1.0)))
    writer.add_mesh("glass", build_box((0.6, 0.1, 0.2), (1.1, 0.5, 0.9)), make_glass("glass", 1.5, 0.4))
    writer.add_mesh("wall", build_box((-2.1, 0.0, -2.0), (-2.0, 1.2, 2.0)), make_diffuse("wall", 0.5))


def add_curved_lamp(writer: GltfWriter) -> None:
    writer.add_mesh("lamp", build_box((-0.2, 1.2, -0.2), (0.1, 1.4, 0.2)), make_lamp(8.0))


LIGHTS: dict[str, Callable[[GltfWriter], Any]] = {
    "spot": lambda writer: writer.add_spot_light("spot", (0.2, 2.0, 0.1), (0.3, 0.0, 0.2), 10.0, 0.2, 0.9),
    "directional": lambda writer: writer.add_directional_light("sun", (0.2, -1.0, 0.3), 3.0),
    "panel": lambda writer: writer.add_mesh("lamp", build_panel(0.3, 1.5), make_lamp(8.0)),
    "two-sided panel": lambda writer: writer.add_mesh("lamp", build_panel(0.3, 1.5), make_lamp(8.0, is_two_sided=True)),
    "box": add_curved_lamp,
    "environment": lambda writer: None,
}


def build_ball(radius: float, height: float, rows: int = 256) -> Mesh:
    """A sphere about (0, `height`, 0) with exact normals."""
    polar, turn = np.meshgrid(
        np.linspace(0.0, np.pi, rows + 1), np.linspace(0.0, 2.0 * np.pi, 2 * rows + 1), indexing="ij"
    )
    normals = np.stack([np.sin(polar) * np.cos(turn), np.cos(polar), np.sin(polar) * np.sin(turn)], axis=2).reshape(
        -1, 3
    )
    first = (np.arange(rows)[:, None] * (2 * rows + 1) + np.arange(2 * rows)[None, :]).ravel()
    below = first + 2 * rows + 1
    faces = np.concatenate(
        [np.stack([first, first + 1, below], axis=1), np.stack([first + 1, below + 1, below], axis=1)]
    )
    positions = radius * normals + [0.0, height, 0.0]
    areas = np.linalg.norm(
        np.cross(positions[faces[:, 1]] - positions[faces[:, 0]], positions[faces[:, 2]] - positions[faces[:, 0]]),
        axis=1,
    )
    return Mesh(positions, normals, faces[areas > 1e-12])
