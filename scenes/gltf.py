# SPDX-License-Identifier: Apache-2.0
"""Writes meshes, materials, lights and cameras as glTF 2.0 text with one buffer beside it."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = tuple[float, float, float]

_FLOAT, _UINT16, _UINT32 = 5126, 5123, 5125  # glTF component types
_VERTEX_BUFFER, _INDEX_BUFFER = 34962, 34963  # glTF buffer view targets


@dataclass(frozen=True)
class Mesh:
    """Triangles with exact unit vertex normals: positions (n, 3), normals (n, 3), indices (t, 3)."""

    positions: NDArray[np.float64]
    normals: NDArray[np.float64]
    indices: NDArray[np.int64]


def build_cylinder(radius: float, height: float, segments: int, rows: int) -> Mesh:
    """Open cylinder about +y from y = 0 to `height`; normals point away from the axis."""
    angle = 2.0 * np.pi * np.arange(segments) / segments
    outward = np.stack([np.cos(angle), np.zeros(segments), np.sin(angle)], axis=1)
    levels = np.linspace(0.0, height, rows + 1)
    positions = np.concatenate([outward * radius + np.array([0.0, y, 0.0]) for y in levels])
    here = np.arange(segments)
    after = (here + 1) % segments
    strips = []
    for row in range(rows):
        low, high = row * segments, (row + 1) * segments
        strips.append(np.stack([low + here, high + here, high + after], axis=1))
        strips.append(np.stack([low + here, high + after, low + after], axis=1))
    # The two triangles of a facet stay neighbors in the file.
    indices = np.stack(strips, axis=1).reshape(-1, 3)
    return Mesh(positions, np.tile(outward, (rows + 1, 1)), indices)


def build_quad(half: float, y: float = 0.0) -> Mesh:
    """Square |x|, |z| <= `half` at height `y`, facing up."""
    corners = np.array([[-1, 0, -1], [-1, 0, 1], [1, 0, 1], [1, 0, -1]], dtype=np.float64)
    positions = corners * half + np.array([0.0, y, 0.0])
    return Mesh(positions, np.tile([0.0, 1.0, 0.0], (4, 1)), np.array([[0, 1, 2], [0, 2, 3]]))


def build_box(low: Vector, high: Vector) -> Mesh:
    """Closed axis-aligned box with flat outward normals."""
    positions, normals, indices = [], [], []
    corners = np.array([low, high], dtype=np.float64)
    for axis in range(3):
        for side in (0, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            if side == 0:
                u, v = v, u  # keeps the winding counter-clockwise seen from outside
            first = 4 * len(positions)
            face = np.empty((4, 3))
            face[:, axis] = corners[side, axis]
            face[:, u] = corners[[0, 1, 1, 0], u]
            face[:, v] = corners[[0, 0, 1, 1], v]
            positions.append(face)
            normal = np.zeros(3)
            normal[axis] = 2 * side - 1
            normals.append(np.tile(normal, (4, 1)))
            indices += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    return Mesh(np.concatenate(positions), np.concatenate(normals), np.array(indices))


def move_mesh(mesh: Mesh, offset: Vector) -> Mesh:
    """The same mesh somewhere else."""
    return Mesh(mesh.positions + np.array(offset), mesh.normals, mesh.indices)


def find_rotation(eye: Vector, target: Vector, up: Vector) -> list[float]:
    """Quaternion (x, y, z, w) that turns a glTF camera (looking along -z, y up) toward `target`."""
    backward = np.subtract(eye, target).astype(np.float64)
    backward /= np.linalg.norm(backward)
    right = np.cross(np.asarray(up, dtype=np.float64), backward)
    right /= np.linalg.norm(right)
    m = np.stack([right, np.cross(backward, right), backward], axis=1)
    # Each component from its own diagonal term: stable for half turns, signs from the off-diagonals.
    x, y, z, w = 0.5 * np.sqrt(
        np.maximum(
            0.0,
            1.0 + np.array([[1, -1, -1], [-1, 1, -1], [-1, -1, 1], [1, 1, 1]]) @ np.diagonal(m),
        )
    )
    x, y, z = np.copysign(x, m[2, 1] - m[1, 2]), np.copysign(y, m[0, 2] - m[2, 0]), np.copysign(z, m[1, 0] - m[0, 1])
    return [round(float(c), 12) + 0.0 for c in (x, y, z, w)]


def make_diffuse(name: str, reflectance: float) -> dict[str, Any]:
    """Lambert surface of gray `reflectance`."""
    return {
        "name": name,
        "doubleSided": True,
        "pbrMetallicRoughness": {
            "baseColorFactor": [reflectance] * 3 + [1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 1.0,
        },
    }


def make_mirror(name: str, color: Vector, roughness: float = 0.0) -> dict[str, Any]:
    """Metal on both sides, Schlick reflectance with F0 = `color`; a perfect mirror without `roughness`."""
    return {
        "name": name,
        "doubleSided": True,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*color, 1.0],
            "metallicFactor": 1.0,
            "roughnessFactor": roughness,
        },
    }


def make_glass(name: str, ior: float, thickness: float, roughness: float = 0.0) -> dict[str, Any]:
    """Clear dielectric that absorbs nothing; with a `thickness` it has a volume and refracts, without it is thin."""
    return {
        "name": name,
        "pbrMetallicRoughness": {"metallicFactor": 0.0, "roughnessFactor": roughness},
        "extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 1.0},
            "KHR_materials_ior": {"ior": ior},
            "KHR_materials_volume": {"thicknessFactor": thickness, "attenuationColor": [1.0, 1.0, 1.0]},
        },
    }


def add_dispersion(material: dict[str, Any], abbe: float) -> dict[str, Any]:
    """`material`, glass with a volume, of the Abbe number `abbe`."""
    dispersion = {"dispersion": 20.0 / abbe}
    return {**material, "extensions": {**material.get("extensions", {}), "KHR_materials_dispersion": dispersion}}


def add_coat(material: dict[str, Any], factor: float, roughness: float = 0.0) -> dict[str, Any]:
    """`material` under a clear coat of index 1.5 that covers `factor` of it."""
    coat = {"clearcoatFactor": factor, "clearcoatRoughnessFactor": roughness}
    return {**material, "extensions": {**material.get("extensions", {}), "KHR_materials_clearcoat": coat}}


def make_translucent(name: str, color: Vector, factor: float, passing: Vector) -> dict[str, Any]:
    """Thin surface that lets `factor` of the light through, by `passing`, and throws the rest back, by `color`."""
    transmission = {"diffuseTransmissionFactor": factor, "diffuseTransmissionColorFactor": list(passing)}
    material = make_diffuse(name, 1.0)
    material["pbrMetallicRoughness"]["baseColorFactor"] = [*color, 1.0]
    return {**material, "extensions": {"KHR_materials_diffuse_transmission": transmission}}


def _aim(eye: Vector, target: Vector) -> list[float]:
    """Rotation that turns -z from `eye` to `target`."""
    steep = abs(target[1] - eye[1]) > 0.9 * math.dist(eye, target)
    return find_rotation(eye, target, (1.0, 0.0, 0.0) if steep else (0.0, 1.0, 0.0))


@dataclass
class GltfWriter:
    """Collects a scene's parts in the order they are added, then writes them."""

    name: str
    nodes: list[dict[str, Any]] = field(default_factory=list)
    meshes: list[dict[str, Any]] = field(default_factory=list)
    materials: list[dict[str, Any]] = field(default_factory=list)
    cameras: list[dict[str, Any]] = field(default_factory=list)
    lights: list[dict[str, Any]] = field(default_factory=list)
    accessors: list[dict[str, Any]] = field(default_factory=list)
    views: list[dict[str, Any]] = field(default_factory=list)
    images: list[dict[str, Any]] = field(default_factory=list)
    samplers: list[dict[str, Any]] = field(default_factory=list)
    textures: list[dict[str, Any]] = field(default_factory=list)
    buffer: bytearray = field(default_factory=bytearray)

    def _add_accessor(self, values: NDArray[Any], component: int, kind: str, target: int) -> int:
        data = values.tobytes()
        view = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(data), "target": target}
        self.views.append(view)
        self.buffer += data + b"\0" * (-len(data) % 4)
        accessor: dict[str, Any] = {
            "bufferView": len(self.views) - 1,
            "componentType": component,
            "count": len(values) if kind != "SCALAR" else values.size,
            "type": kind,
        }
        if kind == "VEC3":
            accessor["min"] = [float(c) for c in values.min(axis=0)]
            accessor["max"] = [float(c) for c in values.max(axis=0)]
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def add_texture(self, image: bytes, **sampler: int) -> int:
        """Adds an encoded image with its glTF `sampler` members, such as wrapS; returns the texture's index."""
        view = {"buffer": 0, "byteOffset": len(self.buffer), "byteLength": len(image)}
        self.views.append(view)
        self.buffer += image + b"\0" * (-len(image) % 4)
        mime = "image/png" if image.startswith(b"\x89PNG") else "image/jpeg"
        self.images.append({"bufferView": len(self.views) - 1, "mimeType": mime})
        self.samplers.append(sampler)
        self.textures.append({"source": len(self.images) - 1, "sampler": len(self.samplers) - 1})
        return len(self.textures) - 1

    def add_mesh(
        self,
        name: str,
        mesh: Mesh,
        material: dict[str, Any],
        *,
        coordinates: list[NDArray[np.float64]] | None = None,
        colors: NDArray[np.float64] | None = None,
    ) -> None:
        """Adds `mesh` as a node of its own, drawn with `material`; texture coordinates (n, 2) by set, colors (n, 4)."""
        wide = len(mesh.positions) > 0xFFFF
        index_type: tuple[str, int] = ("<u4", _UINT32) if wide else ("<u2", _UINT16)
        attributes = {
            "POSITION": self._add_accessor(mesh.positions.astype("<f4"), _FLOAT, "VEC3", _VERTEX_BUFFER),
            "NORMAL": self._add_accessor(mesh.normals.astype("<f4"), _FLOAT, "VEC3", _VERTEX_BUFFER),
        }
        for i, values in enumerate(coordinates or []):
            attributes[f"TEXCOORD_{i}"] = self._add_accessor(values.astype("<f4"), _FLOAT, "VEC2", _VERTEX_BUFFER)
        if colors is not None:
            attributes["COLOR_0"] = self._add_accessor(colors.astype("<f4"), _FLOAT, "VEC4", _VERTEX_BUFFER)
        indices = self._add_accessor(mesh.indices.astype(index_type[0]).ravel(), index_type[1], "SCALAR", _INDEX_BUFFER)
        self.materials.append(material)
        primitive = {"attributes": attributes, "indices": indices, "material": len(self.materials) - 1}
        self.meshes.append({"name": name, "primitives": [primitive]})
        self.nodes.append({"name": name, "mesh": len(self.meshes) - 1})

    def place_again(self, name: str, mesh: int, position: Vector, turn: float = 0.0) -> None:
        """Adds a node that shows the mesh number `mesh` once more, turned about y by `turn` radians and moved."""
        self.nodes.append({"name": name, "mesh": mesh})
        self.move_last(position, turn)

    def move_last(self, position: Vector, turn: float) -> None:
        """Places the last node: turned about y by `turn` radians, then moved."""
        turned = [0.0, math.sin(0.5 * turn), 0.0, math.cos(0.5 * turn)]
        self.nodes[-1] |= {"translation": list(position), "rotation": turned}

    def add_point_light(self, name: str, position: Vector, intensity: float) -> None:
        """Adds an isotropic point light of `intensity` W/sr."""
        self._place_light(name, "point", intensity, {"translation": list(position)})

    def add_spot_light(
        self, name: str, position: Vector, target: Vector, intensity: float, inner: float, outer: float
    ) -> None:
        """Adds a spot of `intensity` W/sr on its axis; angles from the axis in radians."""
        cone = {"innerConeAngle": inner, "outerConeAngle": outer}
        node = {"translation": list(position), "rotation": _aim(position, target)}
        self._place_light(name, "spot", intensity, node, spot=cone)

    def add_directional_light(self, name: str, direction: Vector, irradiance: float) -> None:
        """Adds parallel light of `irradiance` W/m² on a plane across it."""
        self._place_light(name, "directional", irradiance, {"rotation": _aim((0.0, 0.0, 0.0), direction)})

    def _place_light(self, name: str, kind: str, intensity: float, node: dict[str, Any], **more: Any) -> None:
        self.lights.append({"name": name, "type": kind, "color": [1.0, 1.0, 1.0], "intensity": intensity, **more})
        extension = {"KHR_lights_punctual": {"light": len(self.lights) - 1}}
        self.nodes.append({"name": name, **node, "extensions": extension})

    def add_camera(self, name: str, eye: Vector, target: Vector, yfov: float, up: Vector = (0.0, 1.0, 0.0)) -> None:
        """Adds a square perspective camera at `eye` looking at `target`; `yfov` in radians."""
        lens = {"yfov": yfov, "aspectRatio": 1.0, "znear": 0.01, "zfar": 100.0}
        self.cameras.append({"name": name, "type": "perspective", "perspective": lens})
        self.nodes.append(
            {
                "name": name,
                "camera": len(self.cameras) - 1,
                "translation": list(eye),
                "rotation": find_rotation(eye, target, up),
            }
        )

    def build_document(self) -> dict[str, Any]:
        """The glTF document as plain values."""
        used = {"KHR_lights_punctual"} | {e for m in self.materials for e in m.get("extensions", {})}
        optional = {"images": self.images, "samplers": self.samplers, "textures": self.textures}
        return {
            "asset": {"version": "2.0", "generator": "Photon Loupe scenes/generate.py"},
            "extensionsUsed": sorted(used),
            "extensions": {"KHR_lights_punctual": {"lights": self.lights}},
            "scene": 0,
            "scenes": [{"name": self.name, "nodes": list(range(len(self.nodes)))}],
            "nodes": self.nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "cameras": self.cameras,
            **{name: entries for name, entries in optional.items() if entries},
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{"uri": f"{self.name}.bin", "byteLength": len(self.buffer)}],
        }

    def write(self, folder: Path) -> None:
        """Writes `<name>.gltf` and `<name>.bin` into `folder`."""
        folder.mkdir(parents=True, exist_ok=True)
        (folder / f"{self.name}.bin").write_bytes(bytes(self.buffer))
        text = json.dumps(self.build_document(), indent=1)
        (folder / f"{self.name}.gltf").write_text(text + "\n", encoding="utf-8")
