# SPDX-License-Identifier: Apache-2.0
"""Writes the study scenes as glTF; the frozen values below are the only record of their dimensions.

Run ``python scenes/generate.py`` to write every scene, or name the ones wanted. NumPy is all it needs,
and the same version of this file writes the same bytes.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from crowded_floor import build_crowd
from extrusion import Corner, build_bar
from foggy_ball import build_fog
from glass_ball import build_ball_scene
from gltf import (
    GltfWriter,
    Vector,
    build_box,
    build_cylinder,
    build_quad,
    make_diffuse,
    make_glass,
    make_mirror,
)
from laid_table import build_table
from marble_leaf import build_leaf
from shaded_lamp import build_lamp
from thumb_tack import build_tack

# From so far up the rim hides only 2.6 % of a radius of floor behind it.
TOP_CAMERA_HEIGHT = 20.0


@dataclass(frozen=True)
class CylinderScene:
    """A vertical mirror cylinder about the y axis on a diffuse floor y = 0, lit by one point light."""

    name: str
    radius: float  # m
    wall_height: float  # m
    light: Vector  # m
    intensity: float  # W/sr
    mirror_color: Vector  # F0 of Schlick's reflectance
    floor_half: float  # m
    floor_reflectance: float
    window_half: float  # m, what the camera `top` sees of the floor
    # A facet's middle lies radius·(π/segments)²/2 inside the true circle: 1.4e-7 m at 6,000 — a float's spacing.
    segments: int = 6000
    rows: int = 2

    @property
    def light_distance(self) -> float:
        """Horizontal distance of the light from the axis, m."""
        return math.hypot(self.light[0], self.light[2])


@dataclass(frozen=True)
class SlabScene:
    """A plane-parallel glass slab above a diffuse floor y = 0, a point light on the y axis above it."""

    name: str
    light_height: float  # m
    slab_bottom: float  # m
    slab_top: float  # m
    slab_half: float  # m
    ior: float
    intensity: float  # W/sr
    floor_half: float  # m; so small that no light that met a side face of the slab reaches it
    floor_reflectance: float
    window_half: float  # m

    @property
    def thickness(self) -> float:
        """Thickness of the slab, m."""
        return self.slab_top - self.slab_bottom


@dataclass(frozen=True)
class PrismScene:
    """A glass wedge along z that stands on a diffuse floor y = 0, a point light beside it.

    Its face away from the light is broken: a foot, a rounded bevel, and the main face. Angles are those that a face
    leans inward from the vertical, in degrees.
    """

    name: str
    height: float  # m
    apex_width: float  # m, flat, before its edges are rounded
    face_angle: float  # of the face toward the light and the main face
    bevel_angles: tuple[float, float]  # of the bevel's lower and upper border
    foot_angle: float
    bevel_height: float  # m, where the tangents of the bevel's borders meet
    bevel_radius: float  # m
    join_radius: float  # m, of the edges between bevel and foot, bevel and main face
    base_radius: float  # m
    apex_radius: float  # m
    half_length: float  # m
    end_radius: float  # m
    gap: float  # m, between base and floor: surfaces in one place would be met in no sure order
    ior: float
    light: Vector  # m
    intensity: float  # W/sr
    floor_half: float  # m
    floor_reflectance: float
    window_half: float  # m
    segments: tuple[int, int, int] = (300, 24, 60)  # of the bevel, a join, a corner
    end_segments: int = 8

    def list_corners(self) -> list[Corner]:
        """Corners of the cross-section, counter-clockwise from the base's corner away from the light."""
        bevel, join, corner = self.segments
        low, high = self.bevel_angles
        middle = (0.0, self.bevel_height)
        below = _lean(middle, low, -self._cut(self.bevel_radius, high - low) - self._cut_join(low - self.foot_angle))
        above = _lean(middle, high, self._cut(self.bevel_radius, high - low) + self._cut_join(self.face_angle - high))
        foot = _lean(below, self.foot_angle, (self.gap - below[1]) / math.cos(math.radians(self.foot_angle)))
        top = _lean(above, self.face_angle, (self.height - above[1]) / math.cos(math.radians(self.face_angle)))
        right = 0.5 * self.apex_width - top[0]  # the apex lies over x = 0
        left = -0.5 * self.apex_width - math.tan(math.radians(self.face_angle)) * (self.height - self.gap)
        return [
            Corner(foot[0] + right, self.gap, self.base_radius, corner),
            Corner(below[0] + right, below[1], self.join_radius, join),
            Corner(middle[0] + right, middle[1], self.bevel_radius, bevel),
            Corner(above[0] + right, above[1], self.join_radius, join),
            Corner(0.5 * self.apex_width, self.height, self.apex_radius, corner),
            Corner(-0.5 * self.apex_width, self.height, self.apex_radius, corner),
            Corner(left, self.gap, self.base_radius, corner),
        ]

    @staticmethod
    def _cut(radius: float, turn: float) -> float:
        """What an arc takes off each of its sides."""
        return radius * math.tan(math.radians(0.5 * turn))

    def _cut_join(self, turn: float) -> float:
        """The same for a join, and a hundredth of it, so that bevel and join do not overlap by rounding."""
        return 1.01 * self._cut(self.join_radius, turn)


@dataclass(frozen=True)
class LightguideScene:
    """A glass strip along z above a diffuse floor y = 0, a point light so far above that its light is nearly parallel.

    Its upper side is a crown, on either side a bevel, then a flat shoulder down to the side wall: the normal turns
    steadily, but faster on the bevel. Angles are slopes of the upper side in degrees.
    """

    name: str
    half_width: float  # m
    crown_height: float  # m, of the middle of the upper side above the floor
    base_height: float  # m, of the flat lower side above the floor
    crown_radius: float  # m
    crown_angle: float  # where crown and bevel meet
    bevel_radius: float  # m
    shoulder_angle: float
    edge_radius: float  # m
    half_length: float  # m
    end_radius: float  # m
    ior: float
    light_height: float  # m
    intensity: float  # W/sr
    floor_half: float  # m
    floor_reflectance: float
    window_half: float  # m
    segments: tuple[int, int, int] = (240, 240, 40)  # of the crown, a bevel, an edge
    end_segments: int = 8

    def list_corners(self) -> list[Corner]:
        """Corners of the cross-section, counter-clockwise from the lower right one."""
        crown, bevel, edge = self.segments
        start, end = math.radians(self.crown_angle), math.radians(self.shoulder_angle)
        # Where the tangents at the ends of the crown meet, and from there how far along them those at the bevel's ends.
        peak = self.crown_height + self.crown_radius * (1.0 / math.cos(start) - 1.0)
        along = self.crown_radius * math.tan(start) + self.bevel_radius * math.tan(0.5 * (end - start))
        x, y = along * math.cos(start), peak - along * math.sin(start)
        right = [
            Corner(self.half_width, self.base_height, self.edge_radius, edge),
            Corner(self.half_width, y - (self.half_width - x) * math.tan(end), self.edge_radius, edge),
            Corner(x, y, self.bevel_radius, bevel),
        ]
        left = [Corner(-c.x, c.y, c.radius, c.segments) for c in reversed(right)]
        return [*right, Corner(0.0, peak, self.crown_radius, crown), *left]


def _lean(start: tuple[float, float], angle: float, length: float) -> tuple[float, float]:
    """The point `length` up a face that leans to the left of the vertical by `angle` degrees."""
    radians = math.radians(angle)
    return start[0] - length * math.sin(radians), start[1] + length * math.cos(radians)


RING = CylinderScene(
    name="ring",
    radius=1.0,
    wall_height=0.5,
    light=(0.0, 1.6, 2.0),
    intensity=10.0,
    mirror_color=(1.0, 0.78, 0.34),
    floor_half=4.0,
    floor_reflectance=0.7,
    window_half=2.0,
)

# The light hangs above the rim: then light meets the wall once at most, and none comes off the wall beside it.
BOWL = CylinderScene(
    name="bowl",
    radius=1.0,
    wall_height=0.4,
    light=(0.999, 1.2, 0.0),
    intensity=10.0,
    mirror_color=(1.0, 1.0, 1.0),
    floor_half=2.0,
    floor_reflectance=0.7,
    window_half=1.1,
)

SLAB = SlabScene(
    name="slab",
    light_height=1.5,
    slab_bottom=0.3,
    slab_top=0.5,
    slab_half=3.0,
    ior=1.5,
    intensity=10.0,
    floor_half=1.5,
    floor_reflectance=0.7,
    window_half=1.5,
)

# The bevel's light is a stripe upon that of the foot and the main face; scenes/prism/README.md says how it is used.
PRISM = PrismScene(
    name="prism",
    height=0.6,
    apex_width=0.02,
    face_angle=15.0,
    bevel_angles=(7.0, 12.0),
    foot_angle=4.0,
    bevel_height=0.178,
    bevel_radius=0.265,
    join_radius=0.004,
    base_radius=0.01,
    apex_radius=0.008,
    half_length=0.3,
    end_radius=0.003,
    gap=0.002,
    ior=1.5,
    light=(-2.4, 1.15, 0.0),
    intensity=10.0,
    floor_half=2.0,
    floor_reflectance=0.7,
    window_half=1.2,
)

LIGHTGUIDE = LightguideScene(
    name="lightguide",
    half_width=0.15,
    crown_height=0.15,
    base_height=0.08,
    crown_radius=1.2,
    crown_angle=3.0,
    bevel_radius=0.115,
    shoulder_angle=13.0,
    edge_radius=0.003,
    half_length=0.2,
    end_radius=0.002,
    ior=1.5,
    light_height=5.0,
    intensity=25.0,
    floor_half=1.0,
    floor_reflectance=0.7,
    window_half=0.25,
)


def add_top_camera(writer: GltfWriter, window_half: float) -> None:
    """Adds `top`: straight down, x to the right, z downward, |x|, |z| <= `window_half` of the floor in the frame."""
    yfov = 2.0 * math.atan(window_half / TOP_CAMERA_HEIGHT)
    writer.add_camera("top", (0.0, TOP_CAMERA_HEIGHT, 0.0), (0.0, 0.0, 0.0), yfov, up=(0.0, 0.0, -1.0))


def _build_cylinder_scene(scene: CylinderScene, mirror_name: str) -> GltfWriter:
    writer = GltfWriter(scene.name)
    wall = build_cylinder(scene.radius, scene.wall_height, scene.segments, scene.rows)
    writer.add_mesh("wall", wall, make_mirror(mirror_name, scene.mirror_color))
    writer.add_mesh("floor", build_quad(scene.floor_half), make_diffuse("plaster", scene.floor_reflectance))
    writer.add_point_light("lamp", scene.light, scene.intensity)
    add_top_camera(writer, scene.window_half)
    return writer


def build_ring() -> GltfWriter:
    """Gold ring on a plane, lit from outside and above."""
    writer = _build_cylinder_scene(RING, "gold")
    writer.add_camera("view", (2.6, 2.9, 2.9), (0.0, 0.1, -0.05), 0.62)
    writer.add_camera("close", (0.0, 2.2, 0.9), (0.0, 0.0, -0.35), 0.5)
    return writer


def build_slab() -> GltfWriter:
    """Glass slab between a light and a plane."""
    writer = GltfWriter(SLAB.name)
    half = SLAB.slab_half
    box = build_box((-half, SLAB.slab_bottom, -half), (half, SLAB.slab_top, half))
    writer.add_mesh("slab", box, make_glass("glass", SLAB.ior, SLAB.thickness))
    writer.add_mesh("floor", build_quad(SLAB.floor_half), make_diffuse("plaster", SLAB.floor_reflectance))
    writer.add_point_light("lamp", (0.0, SLAB.light_height, 0.0), SLAB.intensity)
    add_top_camera(writer, SLAB.window_half)
    writer.add_camera("view", (3.2, 2.6, 3.6), (0.0, 0.35, 0.0), 0.75)
    return writer


def build_bowl() -> GltfWriter:
    """Mirror wall with the light at its rim: the cardioid."""
    writer = _build_cylinder_scene(BOWL, "mirror")
    writer.add_camera("view", (-1.7, 2.7, 1.9), (0.1, 0.05, 0.0), 0.68)
    return writer


def build_lightguide() -> GltfWriter:
    """Glass strip with a curved, bevelled upper side under a distant lamp."""
    writer = GltfWriter(LIGHTGUIDE.name)
    strip = build_bar(LIGHTGUIDE.list_corners(), LIGHTGUIDE.half_length, LIGHTGUIDE.end_radius, LIGHTGUIDE.end_segments)
    writer.add_mesh("strip", strip, make_glass("glass", LIGHTGUIDE.ior, 2.0 * LIGHTGUIDE.half_length))
    writer.add_mesh("floor", build_quad(LIGHTGUIDE.floor_half), make_diffuse("plaster", LIGHTGUIDE.floor_reflectance))
    writer.add_point_light("lamp", (0.0, LIGHTGUIDE.light_height, 0.0), LIGHTGUIDE.intensity)
    add_top_camera(writer, LIGHTGUIDE.window_half)
    writer.add_camera("view", (0.42, 0.42, 0.62), (0.0, 0.04, 0.0), 0.68)
    return writer


def build_prism() -> GltfWriter:
    """Glass wedge with a bevel across its far face, lit from the side."""
    writer = GltfWriter(PRISM.name)
    bar = build_bar(PRISM.list_corners(), PRISM.half_length, PRISM.end_radius, PRISM.end_segments)
    writer.add_mesh("prism", bar, make_glass("glass", PRISM.ior, 2.0 * PRISM.half_length))
    writer.add_mesh("floor", build_quad(PRISM.floor_half), make_diffuse("plaster", PRISM.floor_reflectance))
    writer.add_point_light("lamp", PRISM.light, PRISM.intensity)
    add_top_camera(writer, PRISM.window_half)
    writer.add_camera("view", (1.35, 1.05, 1.55), (0.36, 0.14, 0.0), 0.66)
    writer.add_camera("close", (0.36, 1.1, 0.0), (0.36, 0.0, 0.0), 0.22, up=(0.0, 0.0, -1.0))
    return writer


SCENES: dict[str, Callable[[], GltfWriter]] = {
    "ring": build_ring,
    "slab": build_slab,
    "bowl": build_bowl,
    "prism": build_prism,
    "lightguide": build_lightguide,
    "table": build_table,
    "ball": build_ball_scene,
    "tack": build_tack,
    "leaf": build_leaf,
    "lamp": build_lamp,
    "fog": build_fog,
}

# Too large to be committed.
LARGE_SCENES: dict[str, Callable[[], GltfWriter]] = {"crowd": build_crowd}


def main() -> None:
    """Writes the scenes named on the command line; by default all that are committed."""
    known = {**SCENES, **LARGE_SCENES}
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(known)}; default: all but the last")
    parser.add_argument("-o", "--output", type=Path, help="parent folder; default: scenes, of large ones out")
    arguments = parser.parse_args()
    unknown = sorted(set(arguments.names) - set(known))
    if unknown:
        parser.error(f"no scene named {', '.join(unknown)}; there are {', '.join(known)}")
    here = Path(__file__).resolve().parent
    for name in arguments.names or SCENES:
        writer = known[name]()
        writer.write((arguments.output or (here.parent / "out" if name in LARGE_SCENES else here)) / name)
        print(f"{name}: {len(writer.buffer):,} bytes of geometry")


if __name__ == "__main__":
    main()
