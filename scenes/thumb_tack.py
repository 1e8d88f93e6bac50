# SPDX-License-Identifier: Apache-2.0
"""The scene `tack`: a thumb tack of clear plastic on a steel pin, upright on a board, lit from above."""

from __future__ import annotations

import math
from dataclasses import dataclass

from extrusion import Corner
from gltf import GltfWriter, Vector, build_quad, make_diffuse, make_glass, make_mirror
from turning import build_profile, turn_profile

# From so far up the tack hides little more of the board than it covers.
TOP_CAMERA_HEIGHT = 1.0  # m


@dataclass(frozen=True)
class TackScene:
    """Plastic turned about the y axis: collar, neck, cap; a pin from inside it down to the board y = 0."""

    name: str
    pin_radius: float  # m
    pin_gap: float  # m, between its end and the board: surfaces in one place would be met in no sure order
    pin_top: float  # m, inside the plastic
    collar_bottom: float  # m
    collar_radius: float  # m
    collar_top: float  # m, of its straight side
    neck_bottom: float  # m, where the tangents of collar and neck meet
    neck_radius: float  # m
    neck_top: float  # m, where the tangents of neck and cap meet
    cap_radius: float  # m
    cap_bottom: float  # m, of its straight side
    cap_top: float  # m
    ior: float
    steel: Vector  # F0 of Schlick's reflectance
    light: Vector  # m
    intensity: float  # W/sr
    board_half: float  # m
    board_reflectance: float
    window_half: float  # m, what the camera `top` sees of the board
    close_half: float  # m, what the camera `close` sees of it
    close_center: Vector  # m
    segments: int = 440
    pin_segments: int = 48

    def list_corners(self) -> list[Corner]:
        """Profile of the plastic, from the middle of its underside up."""
        return [
            Corner(0.0, self.collar_bottom, 0.0, 0),
            Corner(self.collar_radius, self.collar_bottom, 0.0005, 7),
            Corner(self.collar_radius, self.collar_top, 0.0005, 7),
            Corner(self.neck_radius, self.neck_bottom, 0.0018, 11),
            Corner(self.neck_radius, self.neck_top, 0.0024, 11),
            Corner(self.cap_radius, self.cap_bottom, 0.0007, 7),
            Corner(self.cap_radius, self.cap_top, 0.0012, 11),
            Corner(0.0, self.cap_top, 0.0, 0),
        ]

    def list_pin_corners(self) -> list[Corner]:
        """Profile of the pin, its end cut off blunt."""
        point = 0.25 * self.pin_radius
        return [
            Corner(0.0, self.pin_gap, 0.0, 0),
            Corner(point, self.pin_gap, 0.3 * point, 4),
            Corner(self.pin_radius, self.pin_gap + 4.0 * self.pin_radius, 0.001, 4),
            Corner(self.pin_radius, self.pin_top, 0.3 * self.pin_radius, 6),
            Corner(0.0, self.pin_top, 0.0, 0),
        ]


TACK = TackScene(
    name="tack",
    pin_radius=0.0005,
    pin_gap=0.0001,
    pin_top=0.0135,
    collar_bottom=0.008,
    collar_radius=0.005,
    collar_top=0.0092,
    neck_bottom=0.0108,
    neck_radius=0.0023,
    neck_top=0.0172,
    cap_radius=0.0058,
    cap_bottom=0.0195,
    cap_top=0.0225,
    ior=1.49,
    steel=(0.56, 0.57, 0.58),
    light=(-0.05, 0.12, 0.03),
    intensity=0.05,
    board_half=0.06,
    board_reflectance=0.7,
    window_half=0.02,
    close_half=0.009,
    close_center=(0.011, 0.0, -0.0065),
)


def build_tack() -> GltfWriter:
    """Thumb tack of clear plastic, lit from above and from the side."""
    scene = TACK
    writer = GltfWriter(scene.name)
    plastic = turn_profile(build_profile(scene.list_corners()), scene.segments)
    writer.add_mesh("plastic", plastic, make_glass("plastic", scene.ior, 2.0 * scene.cap_radius))
    pin = turn_profile(build_profile(scene.list_pin_corners()), scene.pin_segments)
    writer.add_mesh("pin", pin, make_mirror("steel", scene.steel))
    writer.add_mesh("board", build_quad(scene.board_half), make_diffuse("board", scene.board_reflectance))
    writer.add_point_light("lamp", scene.light, scene.intensity)
    yfov = 2.0 * math.atan(scene.window_half / TOP_CAMERA_HEIGHT)
    writer.add_camera("top", (0.005, TOP_CAMERA_HEIGHT, -0.003), (0.005, 0.0, -0.003), yfov, up=(0.0, 0.0, -1.0))
    close = 2.0 * math.atan(scene.close_half / TOP_CAMERA_HEIGHT)
    x, y, z = scene.close_center
    writer.add_camera("close", (x, y + TOP_CAMERA_HEIGHT, z), scene.close_center, close, up=(0.0, 0.0, -1.0))
    writer.add_camera("view", (0.03, 0.048, 0.045), (0.004, 0.0085, -0.001), 0.5)
    return writer
