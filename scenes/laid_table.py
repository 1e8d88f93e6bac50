# SPDX-License-Identifier: Apache-2.0
"""The scene `table`: a gold ring and a wine glass on a table top, below it a floor, behind it a wall with a shelf."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from extrusion import Corner
from gltf import (
    GltfWriter,
    Mesh,
    Vector,
    build_box,
    build_cylinder,
    build_quad,
    make_diffuse,
    make_glass,
    make_mirror,
    move_mesh,
)
from turning import build_profile, turn_profile

# From so far up the table's edge hides little of the floor.
TOP_CAMERA_HEIGHT = 20.0  # m


@dataclass(frozen=True)
class Board:
    """A solid board with edges along the axes, from corner `low` to corner `high`."""

    low: Vector  # m
    high: Vector  # m

    def build_mesh(self) -> Mesh:
        """Top, underside and edges."""
        return build_box(self.low, self.high)


@dataclass(frozen=True)
class WineGlass:
    """A glass turned about the vertical through `place`; heights count from its foot's underside."""

    place: Vector  # m, of the middle of the foot's underside
    foot_radius: float  # m
    stem_radius: float  # m
    bowl_radius: float  # m, where the tangents of the belly meet
    rim_radius: float  # m
    bowl_bottom: float  # m, where the tangents of stem and bowl meet
    belly_height: float  # m
    height: float  # m
    wall: float  # m, of the rim
    floor_height: float  # m, of the inside's lowest point
    ior: float
    segments: int = 160

    def list_corners(self) -> list[Corner]:
        """The profile: up the outside, over the rim, down the inside."""
        inner_belly = self.bowl_radius - 1.8 * self.wall
        return [
            Corner(0.0, 0.0, 0.0, 0),
            Corner(self.foot_radius, 0.0, 0.0012, 6),
            Corner(self.foot_radius, 0.0035, 0.0015, 6),
            Corner(self.stem_radius, 0.0085, 0.018, 14),
            Corner(self.stem_radius, self.bowl_bottom, 0.014, 12),
            Corner(self.bowl_radius, self.belly_height, 0.029, 24),
            Corner(self.rim_radius, self.height, 0.45 * self.wall, 8),
            Corner(self.rim_radius - self.wall, self.height, 0.45 * self.wall, 8),
            Corner(inner_belly, self.floor_height, 0.031, 26),
            Corner(0.0, self.floor_height, 0.0, 0),
        ]

    def build_mesh(self) -> Mesh:
        """The glass where it stands."""
        return move_mesh(turn_profile(build_profile(self.list_corners()), self.segments), self.place)


@dataclass(frozen=True)
class TableScene:
    """Boards, a floor y = 0 and a wall in the plane z = `wall_z`, all diffuse, and what stands on the table top."""

    name: str
    table: Board
    shelf: Board
    wall_z: float  # m
    wall_height: float  # m
    floor_half: float  # m; of the wall's width too
    reflectance: float
    ring_place: Vector  # m
    ring_radius: float  # m
    ring_height: float  # m
    ring_color: Vector  # F0 of Schlick's reflectance
    ring_segments: int
    glass: WineGlass
    light: Vector  # m
    intensity: float  # W/sr
    window_half: float  # m, what the camera `top` sees of the floor
    window_center: Vector  # m


# Boards stop 2 mm before the wall, and ring and glass stand 1 mm above the table: surfaces in one place would be met
# in no sure order.
TABLE = TableScene(
    name="table",
    table=Board((-0.4, 0.22, -0.298), (0.4, 0.25, 0.22)),
    shelf=Board((0.0, 0.31, -0.298), (0.52, 0.325, -0.115)),
    wall_z=-0.3,
    wall_height=0.7,
    floor_half=1.2,
    reflectance=0.7,
    ring_place=(-0.12, 0.251, 0.06),
    ring_radius=0.09,
    ring_height=0.05,
    ring_color=(1.0, 0.78, 0.34),
    ring_segments=2400,
    glass=WineGlass(
        place=(0.28, 0.251, -0.05),
        foot_radius=0.034,
        stem_radius=0.004,
        bowl_radius=0.042,
        rim_radius=0.036,
        bowl_bottom=0.085,
        belly_height=0.1,
        height=0.165,
        wall=0.0018,
        floor_height=0.099,
        ior=1.5,
    ),
    light=(-0.9, 1.45, 0.1),
    intensity=5.0,
    window_half=0.65,
    window_center=(0.2, 0.0, 0.0),
)


def build_wall(scene: TableScene) -> Mesh:
    """The wall, facing the table."""
    half, height, z = scene.floor_half, scene.wall_height, scene.wall_z
    corners = np.array([[-half, 0.0, z], [half, 0.0, z], [half, height, z], [-half, height, z]])
    return Mesh(corners, np.tile([0.0, 0.0, 1.0], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def build_table() -> GltfWriter:
    """Ring and wine glass on a table, their light on the table, over its edge, on the floor, the wall and a shelf."""
    scene = TABLE
    writer = GltfWriter(scene.name)
    ring = build_cylinder(scene.ring_radius, scene.ring_height, scene.ring_segments, 1)
    writer.add_mesh("ring", move_mesh(ring, scene.ring_place), make_mirror("gold", scene.ring_color))
    glass = scene.glass
    writer.add_mesh("glass", glass.build_mesh(), make_glass("glass", glass.ior, 2.0 * glass.bowl_radius))
    for name, mesh in (
        ("table", scene.table.build_mesh()),
        ("floor", build_quad(scene.floor_half)),
        ("wall", build_wall(scene)),
        ("shelf", scene.shelf.build_mesh()),
    ):
        writer.add_mesh(name, mesh, make_diffuse(name, scene.reflectance))
    writer.add_point_light("lamp", scene.light, scene.intensity)
    x, y, z = scene.window_center
    yfov = 2.0 * math.atan(scene.window_half / TOP_CAMERA_HEIGHT)
    writer.add_camera("top", (x, y + TOP_CAMERA_HEIGHT, z), scene.window_center, yfov, up=(0.0, 0.0, -1.0))
    writer.add_camera("view", (1.15, 0.95, 1.05), (0.31, 0.15, -0.02), 0.62)
    return writer
