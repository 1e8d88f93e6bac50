# SPDX-License-Identifier: Apache-2.0
"""The scene `lamp`: a bulb in a pleated shade that glows, hung over a bowl of frosted glass on a table."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from extrusion import Corner
from gltf import GltfWriter, Mesh, Vector, build_box, build_quad, make_diffuse, make_glass, move_mesh
from png import encode_png, encode_srgb
from turning import build_ball, build_profile, turn_profile

# From so far up the shade, not in the way of it, is behind the camera.
TOP_CAMERA_HEIGHT = 0.2  # m


@dataclass(frozen=True)
class LampScene:
    """A cone without ends about the y axis, glowing on both sides; a bowl turned about the same axis under it."""

    name: str
    shade_low: float  # m, height of the lower rim above the table
    shade_high: float  # m
    shade_radius: float  # m, of the lower rim
    shade_neck: float  # m, of the upper rim
    radiance: float  # W/(m² sr), where the shade is brightest
    glow: Vector  # linear color of the paper
    pleats: int
    bulb_radius: float  # m
    bulb_height: float  # m, of its middle above the table
    bulb_radiance: float  # W/(m² sr)
    bowl_radius: float  # m, outer, of the rim
    bowl_foot: float  # m
    bowl_height: float  # m
    wall: float  # m
    gap: float  # m, between bowl and table: surfaces in one place would be met in no sure order
    ior: float
    roughness: float
    tint: Vector  # what is left of light after `tint_distance`
    tint_distance: float  # m
    table_half: float  # m
    table_reflectance: float
    wall_z: float  # m, of its front
    window_half: float  # m, what the camera `top` sees of the table
    shade_segments: int = 192
    bowl_segments: int = 150
    texture_width: int = 384
    texture_height: int = 64

    def list_corners(self) -> list[Corner]:
        """Profile of the bowl: from the middle of its foot up the outside, over the rim, down the inside."""
        inside = self.bowl_radius - self.wall
        floor = 0.006
        return [
            Corner(0.0, 0.0, 0.0, 0),
            Corner(self.bowl_foot, 0.0, 0.002, 6),
            Corner(self.bowl_foot + 0.004, 0.006, 0.003, 6),
            Corner(self.bowl_radius - 0.006, 0.016, 0.03, 26),
            Corner(self.bowl_radius, self.bowl_height, 0.45 * self.wall, 8),
            Corner(inside, self.bowl_height, 0.45 * self.wall, 8),
            Corner(inside - 0.006, 0.016 + 0.4 * self.wall, 0.027, 24),
            Corner(self.bowl_foot, floor + self.wall, 0.006, 8),
            Corner(0.0, floor + 0.8 * self.wall, 0.0, 0),
        ]


LAMP = LampScene(
    name="lamp",
    shade_low=0.2,
    shade_high=0.32,
    shade_radius=0.12,
    shade_neck=0.06,
    radiance=6.0,
    glow=(1.0, 0.72, 0.4),
    pleats=24,
    bulb_radius=0.016,
    bulb_height=0.235,
    bulb_radiance=300.0,
    bowl_radius=0.075,
    bowl_foot=0.03,
    bowl_height=0.06,
    wall=0.005,
    gap=0.0003,
    ior=1.5,
    roughness=0.18,
    tint=(0.5, 0.82, 0.86),
    tint_distance=0.012,
    table_half=1.5,
    wall_z=-0.6,
    table_reflectance=0.7,
    window_half=0.16,
)


def build_shade(scene: LampScene) -> tuple[Mesh, NDArray[np.float64]]:
    """The shade, facing outward, and its texture coordinates: around it and down from its upper rim."""
    turn = np.linspace(0.0, 2.0 * np.pi, scene.shade_segments + 1)
    rise, drop = scene.shade_high - scene.shade_low, scene.shade_radius - scene.shade_neck
    slant = math.hypot(rise, drop)
    around = np.stack([np.cos(turn), np.zeros_like(turn), np.sin(turn)], axis=1)
    rims = [
        radius * around + np.array([0.0, y, 0.0])
        for radius, y in ((scene.shade_radius, scene.shade_low), (scene.shade_neck, scene.shade_high))
    ]
    outward = (rise * around + np.array([0.0, drop, 0.0])) / slant
    here = np.arange(scene.shade_segments)
    above = here + len(turn)
    first, second = (np.stack(corners, axis=1) for corners in ((here, above, above + 1), (here, above + 1, here + 1)))
    indices = np.stack([first, second], axis=1).reshape(-1, 3)
    u = np.tile(turn / (2.0 * np.pi), 2)
    v = np.repeat([1.0, 0.0], len(turn))
    return Mesh(np.concatenate(rims), np.tile(outward, (2, 1)), indices), np.stack([u, v], axis=1)


def paint_shade(scene: LampScene) -> NDArray[np.uint8]:
    """What the paper shows of a bulb behind it: brightest at a third of the height, darker in every fold."""
    u = (np.arange(scene.texture_width) + 0.5)[None, :] / scene.texture_width
    v = (np.arange(scene.texture_height) + 0.5)[:, None] / scene.texture_height
    bulb = 0.25 + 0.75 * np.exp(-(((v - 0.62) / 0.33) ** 2))
    folds = 1.0 - 0.45 * np.cos(np.pi * scene.pleats * u) ** 8
    band = np.where((v < 0.05) | (v > 0.95), 0.12, 1.0)  # the trim along both rims
    return encode_srgb((bulb * folds * band)[..., None] * np.array(scene.glow))


def make_paper(radiance: float, texture: int) -> dict[str, Any]:
    """Paper that glows on both sides as its texture says."""
    strength = {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}}
    glow = {"emissiveFactor": [1.0, 1.0, 1.0], "emissiveTexture": {"index": texture}}
    return {**make_diffuse("paper", 0.5), **glow, "extensions": strength}


def make_bulb(scene: LampScene) -> dict[str, Any]:
    """What glows outward alone."""
    strength = {"KHR_materials_emissive_strength": {"emissiveStrength": scene.bulb_radiance}}
    glow = {"emissiveFactor": list(scene.glow), "doubleSided": False}
    return {**make_diffuse("bulb", 0.5), **glow, "extensions": strength}


def make_frosted(scene: LampScene) -> dict[str, Any]:
    """Rough glass that is tinted where it is thick."""
    material = make_glass("frosted", scene.ior, 2.0 * scene.wall, scene.roughness)
    tint = {"attenuationColor": list(scene.tint), "attenuationDistance": scene.tint_distance}
    material["extensions"]["KHR_materials_volume"] |= tint
    return material


def build_lamp() -> GltfWriter:
    """Glowing shade over a bowl of frosted glass: light of an area, through rough lobes."""
    scene = LAMP
    writer = GltfWriter(scene.name)
    bowl = turn_profile(build_profile(scene.list_corners()), scene.bowl_segments)
    writer.add_mesh("bowl", move_mesh(bowl, (0.0, scene.gap, 0.0)), make_frosted(scene))
    shade, coordinates = build_shade(scene)
    texture = writer.add_texture(encode_png(paint_shade(scene)))
    writer.add_mesh("shade", shade, make_paper(scene.radiance, texture), coordinates=[coordinates])
    bulb = move_mesh(build_ball(scene.bulb_radius, 24, 32), (0.0, scene.bulb_height, 0.0))
    writer.add_mesh("bulb", bulb, make_bulb(scene))
    writer.add_mesh("table", build_quad(scene.table_half), make_diffuse("table", scene.table_reflectance))
    half, z = scene.table_half, scene.wall_z
    wall = build_box((-half, -0.02, z - 0.02), (half, 0.7, z))
    writer.add_mesh("wall", wall, make_diffuse("wall", scene.table_reflectance))
    writer.add_camera("view", (0.3, 0.3, 0.52), (0.0, 0.13, 0.0), 0.62)
    yfov = 2.0 * math.atan(scene.window_half / TOP_CAMERA_HEIGHT)
    writer.add_camera("top", (0.0, TOP_CAMERA_HEIGHT, 0.0), (0.0, 0.0, 0.0), yfov, up=(0.0, 0.0, -1.0))
    return writer
