# SPDX-License-Identifier: Apache-2.0
"""The scene `fog`: a glass ball in thin fog, and a lamp whose beam it gathers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from gltf import GltfWriter, Vector, build_box, build_quad, make_diffuse, make_glass, move_mesh
from turning import build_ball


@dataclass(frozen=True)
class FogScene:
    """Lamp and ball stand in a box of fog above a diffuse floor y = 0."""

    name: str
    radius: float  # m
    middle: Vector  # m, of the ball
    ior: float
    lamp: Vector  # m
    inner: float  # radians from the lamp's axis, which meets the ball's middle
    outer: float
    intensity: float  # W/sr
    scattering: Vector  # 1/m
    attenuation: Vector  # what absorption leaves after 1 m
    anisotropy: float
    low: Vector  # m, of the fog
    high: Vector
    floor_half: float  # m
    floor_reflectance: float
    rows: int
    segments: int


FOG = FogScene(
    name="fog",
    radius=0.2,
    middle=(0.0, 0.65, 0.0),
    ior=1.5,
    lamp=(-1.1, 1.2, 0.0),
    inner=0.19,
    outer=0.2,
    intensity=30.0,
    scattering=(0.22, 0.24, 0.27),
    attenuation=(0.99, 0.99, 0.99),
    anisotropy=0.4,
    low=(-1.4, 0.002, -0.8),
    high=(1.6, 1.5, 0.8),
    floor_half=3.0,
    floor_reflectance=0.5,
    rows=96,
    segments=128,
)


def make_fog(scene: FogScene) -> dict[str, Any]:
    """Index 1: its border does nothing to light."""
    fog = make_glass("fog", 1.0, 1.0)
    fog["extensions"]["KHR_materials_volume"] |= {
        "attenuationColor": list(scene.attenuation),
        "attenuationDistance": 1.0,
    }
    fog["extras"] = {"photonloupe": {"scattering": list(scene.scattering), "anisotropy": scene.anisotropy}}
    return fog


def build_fog() -> GltfWriter:
    """Glass ball in fog: a wide beam in front of it, a cone and its tip behind."""
    scene = FOG
    writer = GltfWriter(scene.name)
    writer.add_mesh("floor", build_quad(scene.floor_half), make_diffuse("plaster", scene.floor_reflectance))
    writer.add_mesh("fog", build_box(scene.low, scene.high), make_fog(scene))
    ball = move_mesh(build_ball(scene.radius, scene.rows, scene.segments), scene.middle)
    writer.add_mesh("ball", ball, make_glass("glass", scene.ior, 2.0 * scene.radius))
    writer.add_spot_light("lamp", scene.lamp, scene.middle, scene.intensity, scene.inner, scene.outer)
    writer.add_camera("view", (0.35, 1.0, 3.2), (0.05, 0.6, 0.0), 0.55)
    return writer
