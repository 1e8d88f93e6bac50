# SPDX-License-Identifier: Apache-2.0
"""The scene `leaf`: a glass marble on a translucent leaf above a plane, after figure 1 of [SJL15]."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from gltf import GltfWriter, Mesh, Vector, build_quad, make_diffuse, make_glass, make_translucent, move_mesh
from png import encode_png, encode_srgb
from turning import build_ball

Doubles = NDArray[np.float64]

# From so far up the marble hides little more of the leaf than it covers.
TOP_CAMERA_HEIGHT = 1.0  # m


@dataclass(frozen=True)
class LeafScene:
    """A leaf along x, its tip at +x: a height over the plane, cut out by an outline; a marble in its hollow."""

    name: str
    length: float  # m
    half_width: float  # m, where it is widest
    lowest: float  # m, of the leaf above the plane
    curl: float  # m, what its ends stand higher than its middle
    rise: float  # m, what its edges stand higher than its midrib where it is widest
    groove: float  # m, half the width of the rounding at the midrib
    ripple: float  # m, of its edges
    marble_radius: float  # m
    marble_place: Vector  # m; it touches the leaf but for a tenth of a millimeter
    ior: float
    passing_share: float  # of light between the veins
    vein_share: float  # the same on the veins
    blade: Vector  # linear color of what is thrown back, and of what passes
    vein: Vector
    light: Vector  # m
    intensity: float  # W/sr
    cone: tuple[float, float]  # radians from the lamp's axis: where it begins to fade, and where it is dark
    floor_half: float  # m
    floor_reflectance: float
    window_half: float  # m, what the camera `top` sees
    window_center: Vector  # m
    close_half: float  # m, what the camera `close` sees
    close_center: Vector  # m
    rows: int = 96  # along
    columns: int = 48  # across
    marble_rows: int = 104
    marble_segments: int = 112
    texture_width: int = 256
    texture_height: int = 128

    def find_half_width(self, s: Doubles) -> Doubles:
        """Of the outline, s from 0 at the stem to 1 at the tip."""
        return self.half_width * np.sin(np.pi * s**0.75) * (1.08 - 0.3 * s)

    def find_height(self, x: Doubles, z: Doubles) -> tuple[Doubles, Doubles, Doubles]:
        """Height over the plane, and its derivatives along x and z."""
        bend = self.curl * (2.0 / self.length) ** 2
        rounded = np.sqrt(z**2 + self.groove**2)
        slope = self.rise / self.half_width
        turns = 6.0 * np.pi / self.length
        wave, across = np.sin(turns * x), (z / self.half_width) ** 2
        height = self.lowest + bend * x**2 + slope * (rounded - self.groove) + self.ripple * wave * across
        along = 2.0 * bend * x + self.ripple * turns * np.cos(turns * x) * across
        sideways = slope * z / rounded + self.ripple * wave * 2.0 * z / self.half_width**2
        return height, along, sideways


LEAF = LeafScene(
    name="leaf",
    length=0.12,
    half_width=0.028,
    lowest=0.003,
    curl=0.016,
    rise=0.012,
    groove=0.01,
    ripple=0.0015,
    marble_radius=0.009,
    marble_place=(0.0, 0.0121, 0.0),
    ior=1.5,
    passing_share=0.45,
    vein_share=0.15,
    blade=(0.16, 0.36, 0.05),
    vein=(0.5, 0.6, 0.22),
    light=(-0.36, 0.4, -0.34),
    intensity=1.2,
    cone=(0.1, 0.24),
    floor_half=0.4,
    floor_reflectance=0.3,
    window_half=0.07,
    window_center=(0.0, 0.0, 0.0),
    close_half=0.02,
    close_center=(0.006, 0.0, 0.006),
)


def build_blade(scene: LeafScene) -> tuple[Mesh, Doubles]:
    """The leaf, facing up, and its texture coordinates: along and across it."""
    # The outline has no width at its ends: triangles without area are left out.
    s = np.linspace(0.002, 0.998, scene.rows + 1)
    t = np.linspace(-1.0, 1.0, scene.columns + 1)
    x = np.repeat((s - 0.5) * scene.length, len(t))
    z = (scene.find_half_width(s)[:, None] * t).ravel()
    height, along, sideways = scene.find_height(x, z)
    upward = np.stack([-along, np.ones_like(x), -sideways], axis=1)
    first = (np.arange(scene.rows)[:, None] * len(t) + np.arange(scene.columns)).ravel()
    after = first + len(t)
    halves = [np.stack(corners, axis=1) for corners in ((first, first + 1, after + 1), (first, after + 1, after))]
    indices = np.stack(halves, axis=1).reshape(-1, 3)
    mesh = Mesh(np.stack([x, height, z], axis=1), upward / np.linalg.norm(upward, axis=1, keepdims=True), indices)
    return mesh, np.stack([np.repeat(s, len(t)), np.tile(0.5 + 0.5 * t, len(s))], axis=1)


def paint_veins(scene: LeafScene) -> NDArray[np.uint8]:
    """Color, and in alpha the share of light that passes; the midrib in the middle, side veins toward the tip."""
    s = (np.arange(scene.texture_width) + 0.5)[None, :] / scene.texture_width
    t = (2.0 * np.arange(scene.texture_height) + 1.0)[:, None] / scene.texture_height - 1.0
    midrib = np.exp(-((t / (0.05 * (1.15 - s))) ** 2))
    # Side veins leave the midrib a length apart and bend toward the tip, those of one side between those of the other.
    place = 11.0 * (s - 0.2 * np.abs(t) + 0.05 * t**2) + 0.5 * (t > 0.0)
    thickness = 0.1 * (1.3 - np.abs(t))
    sides = np.exp(-(((place - np.round(place)) / thickness) ** 2)) * (np.abs(t) < 0.94)
    cross = 34.0 * (np.abs(t) + 0.04 * np.sin(19.0 * s + 3.0 * t))
    fine = 0.1 * np.exp(-(((cross - np.round(cross)) / 0.16) ** 2))
    vein = np.clip(np.maximum(np.maximum(midrib, 0.75 * sides), fine), 0.0, 1.0)[..., None]
    color = (1.0 - vein) * np.array(scene.blade) + vein * np.array(scene.vein)
    share = (1.0 - vein) * scene.passing_share + vein * scene.vein_share
    return np.concatenate([encode_srgb(color), np.round(255.0 * share).astype(np.uint8)], axis=2)


def make_blade(texture: int) -> dict[str, Any]:
    """Material of the leaf: one image says what is thrown back, what passes, and how much does."""
    material = make_translucent("blade", (1.0, 1.0, 1.0), 1.0, (1.0, 1.0, 1.0))
    material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
    passing = material["extensions"]["KHR_materials_diffuse_transmission"]
    passing["diffuseTransmissionTexture"] = {"index": texture}
    passing["diffuseTransmissionColorTexture"] = {"index": texture}
    return material


def build_leaf() -> GltfWriter:
    """Glass marble on a translucent leaf, lit from behind."""
    scene = LEAF
    writer = GltfWriter(scene.name)
    marble = move_mesh(build_ball(scene.marble_radius, scene.marble_rows, scene.marble_segments), scene.marble_place)
    writer.add_mesh("marble", marble, make_glass("glass", scene.ior, 2.0 * scene.marble_radius))
    blade, coordinates = build_blade(scene)
    texture = writer.add_texture(encode_png(paint_veins(scene)), wrapS=33071, wrapT=33071)  # clamped to the edge
    writer.add_mesh("leaf", blade, make_blade(texture), coordinates=[coordinates])
    writer.add_mesh("floor", build_quad(scene.floor_half), make_diffuse("floor", scene.floor_reflectance))
    # A cone, so that maps of all indirect light need not wait for the few photons of a whole sphere that meet the leaf.
    writer.add_spot_light("lamp", scene.light, scene.window_center, scene.intensity, *scene.cone)
    writer.add_camera("view", (0.075, 0.115, 0.14), (0.004, 0.008, 0.004), 0.6)
    views = {"top": (scene.window_half, scene.window_center), "close": (scene.close_half, scene.close_center)}
    for name, (half, center) in views.items():
        x, y, z = center
        yfov = 2.0 * math.atan(half / TOP_CAMERA_HEIGHT)
        writer.add_camera(name, (x, y + TOP_CAMERA_HEIGHT, z), center, yfov, up=(0.0, 0.0, -1.0))
    return writer
