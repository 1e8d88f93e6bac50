# SPDX-License-Identifier: Apache-2.0
"""Lights and materials between two black receivers, one for each kind: what `compare_energy.py` measures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import scene_data  # noqa: F401 - puts scenes/ on the path

from gltf import GltfWriter, Mesh, build_quad, make_diffuse, make_glass, make_mirror, move_mesh
from png import encode_png
from turning import build_ball

CEILING = 3.0  # m
WALL = 3.0  # m, half its side, and how far it stands from the middle
WHITE = (1.0, 1.0, 1.0)
COORDINATES = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])
Change = Callable[[GltfWriter], Any]


@dataclass(frozen=True)
class EnergyCase:
    """What stands between the receivers, what lights it, and the radiance of an environment."""

    name: str
    build: Change
    receivers: tuple[str, ...] = ("floor",)
    environment: float = 0.0
    has_image: bool = False


def flip(mesh: Mesh) -> Mesh:
    """The same, facing the other way."""
    return Mesh(mesh.positions, -mesh.normals, mesh.indices[:, ::-1])


def make_lamp(radiance: float) -> dict[str, Any]:
    """A panel that glows on its front."""
    strength = {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}}
    return {**make_diffuse("lamp", 0.0), "doubleSided": False, "emissiveFactor": [1.0] * 3, "extensions": strength}


def add_ball(writer: GltfWriter) -> None:
    """Adds a ball of glass above the floor."""
    ball = move_mesh(build_ball(0.4, 128, 128), (0.1, 0.7, 0.0))
    writer.add_mesh("ball", ball, make_glass("glass", 1.5, 0.8))


def build_wall(axis: int, place: float) -> Mesh:
    """Square across x (`axis` 0) or z (2) at `place`, facing along the axis."""
    quad = build_quad(WALL)
    order = {0: [1, 0, 2], 2: [0, 2, 1]}[axis]
    positions = quad.positions[:, order]
    positions[:, axis] = place
    return flip(Mesh(positions, -quad.normals[:, order], quad.indices))


def block_backs(writer: GltfWriter) -> None:
    """A ball, and behind the walls others, so that each wall takes light on its front alone."""
    add_ball(writer)
    for axis in (0, 2):
        writer.add_mesh("behind", build_wall(axis, -WALL - 0.05), make_diffuse("black", 0.0))


def light_ball(add_light: Change) -> Change:
    """A ball of glass under a light."""

    def build(writer: GltfWriter) -> None:
        add_ball(writer)
        add_light(writer)

    return build


def light_plate(material: dict[str, Any], degrees: float = 40.0) -> Change:
    """A plate under a spot with a hard edge, which lights nothing but the plate."""

    def build(writer: GltfWriter) -> None:
        writer.add_mesh("plate", move_mesh(build_quad(0.6), (0.0, 1.0, 0.0)), material)
        add_spot(writer, degrees)

    return build


def add_spot(writer: GltfWriter, degrees: float) -> None:
    """Adds a spot aimed at the plate, so far from the plate's normal."""
    angle = np.radians(degrees)
    place = (1.5 * np.sin(angle), 1.0 + 1.5 * np.cos(angle), 0.0)
    writer.add_spot_light("spot", place, (0.0, 1.0, 0.0), 10.0, 0.15, 0.15)


def add_picture(writer: GltfWriter, seed: int) -> int:
    """A texture of 16² unlike texels."""
    codes = np.random.default_rng(seed).integers(0, 256, (16, 16, 3), dtype=np.uint8)
    return writer.add_texture(encode_png(codes), wrapS=33071, wrapT=33071)


def add_painted_lamp(writer: GltfWriter) -> None:
    """Adds a panel whose glow is a picture."""
    lamp = make_lamp(4.0)
    lamp["emissiveTexture"] = {"index": add_picture(writer, seed=5)}
    panel = flip(move_mesh(build_quad(0.4), (0.2, 2.0, 0.1)))
    writer.add_mesh("lamp", panel, lamp, coordinates=[COORDINATES])


def paint_plate(writer: GltfWriter) -> None:
    """A plate whose color is a picture, under the spot."""
    material = make_diffuse("painted", 1.0)
    material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": add_picture(writer, seed=4)}
    plate = move_mesh(build_quad(0.6), (0.0, 1.0, 0.0))
    writer.add_mesh("plate", plate, material, coordinates=[COORDINATES])
    add_spot(writer, 40.0)


def list_cases() -> list[EnergyCase]:
    """Lights over a glass ball, then materials under a spot."""
    both = ("floor", "ceiling")
    lights: dict[str, Change] = {
        "point": lambda w: w.add_point_light("lamp", (0.2, 2.0, 0.1), 5.0),
        "spot": lambda w: w.add_spot_light("lamp", (0.6, 2.2, 0.1), (0.1, 0.7, 0.0), 5.0, 0.4, 0.4),
        "directional": lambda w: w.add_directional_light("sun", (0.3, -1.0, 0.2), 3.0),
        "area": lambda w: w.add_mesh("lamp", flip(move_mesh(build_quad(0.4), (0.2, 2.0, 0.1))), make_lamp(4.0)),
    }
    lights["painted area"] = add_painted_lamp
    cases = [EnergyCase(f"light: {name}, over a glass ball", light_ball(add)) for name, add in lights.items()]
    cases += [
        EnergyCase("light: constant environment, over a glass ball", add_ball, environment=1.0),
        EnergyCase(
            "light: image environment, over a glass ball",
            block_backs,
            ("floor", "left wall", "back wall"),
            environment=1.0,
            has_image=True,
        ),
    ]
    materials: dict[str, tuple[dict[str, Any], float, tuple[str, ...]]] = {
        "diffuse, 0.7": (make_diffuse("gray", 0.7), 40.0, ("ceiling",)),
        "mirror": (make_mirror("mirror", (0.6, 0.6, 0.6)), 5.0, ("ceiling",)),
        "smooth glass": (make_glass("glass", 1.5, 1.0), 40.0, both),
        "smooth glass, 70°": (make_glass("glass", 1.5, 1.0), 70.0, both),
        "thin glass, 60°": (make_glass("thin", 1.5, 0.0), 60.0, both),
        "rough metal, 0.1": (make_mirror("metal", WHITE, 0.1), 40.0, ("ceiling",)),
        "rough metal, 0.3": (make_mirror("metal", WHITE, 0.3), 40.0, ("ceiling",)),
        "rough glass, 0.1": (make_glass("glass", 1.5, 1.0, 0.1), 40.0, both),
        "rough glass, 0.3": (make_glass("glass", 1.5, 1.0, 0.3), 40.0, both),
        "rough glass, 0.5": (make_glass("glass", 1.5, 1.0, 0.5), 40.0, both),
    }
    for name, (material, degrees, receivers) in materials.items():
        cases.append(EnergyCase(f"material: {name}", light_plate(material, degrees), receivers))
    cases.append(EnergyCase("material: painted, 16² texels", paint_plate, ("ceiling",)))
    return cases


def add_receivers(writer: GltfWriter, names: tuple[str, ...]) -> None:
    """Black squares that take whatever arrives, facing the middle."""
    black = make_diffuse("black", 0.0)
    meshes = {
        "floor": build_quad(WALL),
        "ceiling": flip(build_quad(6.0, CEILING)),
        "left wall": build_wall(0, -WALL),
        "back wall": build_wall(2, -WALL),
    }
    for name in names:
        writer.add_mesh(name, meshes[name], black)
