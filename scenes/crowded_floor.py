# SPDX-License-Identifier: Apache-2.0
"""The scene `crowd`: forty rings, prisms and balls on a floor under eight lamps, a million triangles."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from extrusion import Corner, build_bar
from gltf import GltfWriter, Mesh, build_cylinder, build_quad, make_diffuse, make_glass, make_mirror, move_mesh
from turning import build_ball


@dataclass(frozen=True)
class CrowdScene:
    """A jittered grid of bodies of three kinds above a diffuse floor y = 0, lamps on a circle above them."""

    name: str
    rows: int
    columns: int
    spacing: float  # m
    jitter: float  # m, at most, to any side
    seed: int  # of the bodies' places and turns
    size: float  # m, radius of rings and balls, half the length of prisms
    gap: float  # m, between bodies and floor: surfaces in one place would be met in no sure order
    ior: float
    lamp_count: int
    lamp_circle: float  # m, radius
    lamp_height: float  # m
    intensity: float  # W/sr, of all lamps together
    floor_half: float  # m
    floor_reflectance: float
    window_half: float  # m, what the camera `top` sees of the floor

    def build_bodies(self) -> dict[str, Mesh]:
        """One body of each kind about (0, 0, 0), standing `gap` above the floor; some 25,000 triangles each."""
        size = self.size
        wedge = [
            Corner(0.6 * size, 0.0, 0.04 * size, 60),
            Corner(0.08 * size, 1.5 * size, 0.05 * size, 120),
            Corner(-0.6 * size, 0.0, 0.04 * size, 60),
        ]
        bodies = {
            "ring": build_cylinder(size, 0.5 * size, 6200, 2),
            "prism": build_bar(wedge, size, 0.03 * size, 25),
            "ball": move_mesh(build_ball(size, 100, 126), (0.0, size, 0.0)),
        }
        return {kind: move_mesh(body, (0.0, self.gap, 0.0)) for kind, body in bodies.items()}

    def list_places(self) -> np.ndarray:
        """x, z and turn of every body, (rows · columns, 3)."""
        random = np.random.default_rng(self.seed)
        x, z = np.meshgrid(np.arange(self.columns), np.arange(self.rows), indexing="ij")
        grid = np.stack([x - 0.5 * (self.columns - 1), z - 0.5 * (self.rows - 1)], axis=2).reshape(-1, 2)
        shifted = self.spacing * grid + random.uniform(-self.jitter, self.jitter, grid.shape)
        return np.column_stack([shifted, random.uniform(0.0, 2.0 * math.pi, len(grid))])


CROWD = CrowdScene(
    name="crowd",
    rows=5,
    columns=8,
    spacing=0.62,
    jitter=0.06,
    seed=1,
    size=0.17,
    gap=0.001,
    ior=1.5,
    lamp_count=8,
    lamp_circle=2.4,
    lamp_height=2.2,
    intensity=40.0,
    floor_half=4.0,
    floor_reflectance=0.7,
    window_half=2.7,
)

TOP_CAMERA_HEIGHT = 20.0  # m


def build_crowd() -> GltfWriter:
    """Forty bodies and eight lamps: what the program does with many triangles and many emitters."""
    scene = CROWD
    writer = GltfWriter(scene.name)
    materials = {
        "ring": make_mirror("gold", (1.0, 0.78, 0.34)),
        "prism": make_glass("glass of prisms", scene.ior, 2.0 * scene.size),
        "ball": make_glass("glass of balls", scene.ior, 2.0 * scene.size),
    }
    bodies = scene.build_bodies()
    kinds = list(bodies)
    for number, (x, z, turn) in enumerate(scene.list_places()):
        kind = kinds[number % len(kinds)]
        place = (round(float(x), 6), 0.0, round(float(z), 6))
        if number < len(kinds):
            writer.add_mesh(f"{kind} {number}", bodies[kind], materials[kind])
            writer.move_last(place, round(float(turn), 6))
        else:
            writer.place_again(f"{kind} {number}", kinds.index(kind), place, round(float(turn), 6))
    writer.add_mesh("floor", build_quad(scene.floor_half), make_diffuse("plaster", scene.floor_reflectance))
    for number in range(scene.lamp_count):
        angle = 2.0 * math.pi * (number + 0.5) / scene.lamp_count
        place = (scene.lamp_circle * math.cos(angle), scene.lamp_height, scene.lamp_circle * math.sin(angle))
        # From 0.5 to 1.5 shares: emitters of unequal power.
        share = 0.5 + number / (scene.lamp_count - 1)
        writer.add_point_light(f"lamp {number}", place, scene.intensity * share / scene.lamp_count)
    yfov = 2.0 * math.atan(scene.window_half / TOP_CAMERA_HEIGHT)
    writer.add_camera("top", (0.0, TOP_CAMERA_HEIGHT, 0.0), (0.0, 0.0, 0.0), yfov, up=(0.0, 0.0, -1.0))
    writer.add_camera("view", (2.9, 2.6, 3.6), (0.1, 0.0, 0.15), 0.7)
    return writer
