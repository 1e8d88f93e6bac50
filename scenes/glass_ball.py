# SPDX-License-Identifier: Apache-2.0
"""The scene `ball`: a glass ball above a floor, nearer than its focus, under parallel light."""

from __future__ import annotations

import math
from dataclasses import dataclass

from gltf import GltfWriter, build_quad, make_diffuse, make_glass, move_mesh
from turning import build_ball

# From so far up the ball hides little more of the floor than it covers.
TOP_CAMERA_HEIGHT = 20.0  # m


@dataclass(frozen=True)
class BallScene:
    """A ball about (0, `distance`, 0) above a diffuse floor y = 0; light comes straight from above."""

    name: str
    radius: float  # m
    distance: float  # m, of the middle from the floor
    ior: float
    irradiance: float  # W/m² on a plane across the light
    floor_half: float  # m
    floor_reflectance: float
    window_half: float  # m, what the camera `top` sees of the floor
    rows: int
    segments: int


# The paraxial focus lies nR/(2(n - 1)) = 1.5 R behind the middle, below the floor: light is still drawing together.
BALL = BallScene(
    name="ball",
    radius=0.25,
    distance=0.275,
    ior=1.5,
    irradiance=3.0,
    floor_half=3.0,
    floor_reflectance=0.7,
    window_half=0.4,
    rows=150,
    segments=160,
)


def build_ball_scene() -> GltfWriter:
    """Glass ball under parallel light: a disc with a bright rim and a bright middle."""
    scene = BALL
    writer = GltfWriter(scene.name)
    ball = move_mesh(build_ball(scene.radius, scene.rows, scene.segments), (0.0, scene.distance, 0.0))
    writer.add_mesh("ball", ball, make_glass("glass", scene.ior, 2.0 * scene.radius))
    writer.add_mesh("floor", build_quad(scene.floor_half), make_diffuse("plaster", scene.floor_reflectance))
    writer.add_directional_light("sun", (0.0, -1.0, 0.0), scene.irradiance)
    yfov = 2.0 * math.atan(scene.window_half / TOP_CAMERA_HEIGHT)
    writer.add_camera("top", (0.0, TOP_CAMERA_HEIGHT, 0.0), (0.0, 0.0, 0.0), yfov, up=(0.0, 0.0, -1.0))
    writer.add_camera("view", (0.95, 0.42, 0.95), (0.0, 0.2, 0.0), 0.52)
    writer.add_camera("close", (0.3, 0.05, 0.3), (0.0, 0.004, 0.0), 0.3)
    return writer
