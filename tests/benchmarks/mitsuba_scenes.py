# SPDX-License-Identifier: Apache-2.0
"""Our glTF scenes as Mitsuba's: what `scenes/gltf.py` writes, as far as Mitsuba has a model for it."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]
_COMPONENTS = {5126: "<f4", 5123: "<u2", 5125: "<u4"}
_WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
_WRAPS = {10497: "repeat", 33071: "clamp", 33648: "mirror"}
_NEAREST = 9728
# Between the two sheets that stand for one that glows on both sides, of the scene's size.
_SHEET_GAP = 1e-5


class ModelError(Exception):
    """Mitsuba has no model for a material of ours; the message names it."""


def turn_to(quaternion: Any) -> Doubles:
    """Rotation matrix of a quaternion (x, y, z, w)."""
    x, y, z, w = quaternion
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
        ]
    )


class GltfReader:
    """One of our scene files, its meshes written as PLY into `folder`."""

    def __init__(self, path: Path, folder: Path) -> None:
        self.document = json.loads(path.read_text(encoding="utf-8"))
        self.buffer = (path.parent / self.document["buffers"][0]["uri"]).read_bytes()
        self.folder = folder

    def read_accessor(self, index: int) -> NDArray[Any]:
        """Values of an accessor, (count, width)."""
        accessor = self.document["accessors"][index]
        width = _WIDTHS[accessor["type"]]
        start = self.document["bufferViews"][accessor["bufferView"]]["byteOffset"]
        kind = _COMPONENTS[accessor["componentType"]]
        return np.frombuffer(self.buffer, kind, accessor["count"] * width, start).reshape(-1, width)

    def make_texture(self, index: int, scale: Any) -> dict[str, Any]:
        """An image's colors times `scale`, bilinear or nearest as its sampler says."""
        texture = self.document["textures"][index]
        sampler = self.document["samplers"][texture["sampler"]]
        view = self.document["bufferViews"][self.document["images"][texture["source"]]["bufferView"]]
        data = self.buffer[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        file = self.folder / f"image_{index}"
        file.write_bytes(data)
        bitmap = mi.Bitmap(str(file)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
        pixels = np.array(bitmap) * np.asarray(scale, dtype=np.float32)
        return {
            "type": "bitmap",
            "bitmap": mi.Bitmap(pixels.astype(np.float32)),
            "raw": True,  # the codes are decoded above
            "wrap_mode": _WRAPS[sampler.get("wrapS", 10497)],
            "filter_type": "nearest" if sampler.get("magFilter") == _NEAREST else "bilinear",
        }

    def make_material(self, material: dict[str, Any]) -> dict[str, Any]:
        """The BSDF of a material."""
        rough = material["pbrMetallicRoughness"]
        extensions = material.get("extensions", {})
        alpha = rough.get("roughnessFactor", 1.0) ** 2
        color = list(rough.get("baseColorFactor", [1.0] * 4)[:3])
        facets = {"distribution": "ggx", "alpha": alpha}
        for name in ("diffuse_transmission", "clearcoat", "specular", "dispersion"):
            if f"KHR_materials_{name}" in extensions:
                raise ModelError(f"{material['name']}: KHR_materials_{name}")
        if extensions.get("KHR_materials_transmission", {}).get("transmissionFactor", 0.0) > 0.0:
            ior = extensions.get("KHR_materials_ior", {}).get("ior", 1.5)
            inside = {"int_ior": ior, "ext_ior": 1.0}
            if extensions.get("KHR_materials_volume", {}).get("thicknessFactor", 0.0) == 0.0:
                return {"type": "thindielectric", **inside}
            return {"type": "roughdielectric", **facets, **inside} if alpha > 0.0 else {"type": "dielectric", **inside}
        if rough.get("metallicFactor", 1.0) > 0.0:
            metal = {"material": "none", "specular_reflectance": {"type": "rgb", "value": color}}
            bare = {"type": "roughconductor", **facets, **metal} if alpha > 0.0 else {"type": "conductor", **metal}
        elif "baseColorTexture" in rough:
            bare = {"type": "diffuse", "reflectance": self.make_texture(rough["baseColorTexture"]["index"], color)}
        else:
            bare = {"type": "diffuse", "reflectance": {"type": "rgb", "value": color}}
        return {"type": "twosided", "bsdf": bare}

    def make_interior(self, material: dict[str, Any]) -> dict[str, Any]:
        """The medium inside tinted glass, or nothing."""
        volume = material.get("extensions", {}).get("KHR_materials_volume", {})
        if "attenuationDistance" not in volume:
            return {}
        extinction = -np.log(volume["attenuationColor"]) / volume["attenuationDistance"]
        largest = float(extinction.max())  # colors of Mitsuba's media end at 1
        return {
            "interior": {
                "type": "homogeneous",
                "sigma_t": {"type": "rgb", "value": (extinction / max(largest, 1e-30)).tolist()},
                "scale": largest,
                "albedo": {"type": "rgb", "value": 0.0},
            }
        }

    def make_glow(self, material: dict[str, Any]) -> dict[str, Any]:
        """The emitter of a glowing surface, or nothing."""
        factor = np.array(material.get("emissiveFactor", [0.0] * 3))
        strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {})
        radiance = factor * strength.get("emissiveStrength", 1.0)
        if not radiance.any():
            return {}
        if "emissiveTexture" in material:
            return {"type": "area", "radiance": self.make_texture(material["emissiveTexture"]["index"], radiance)}
        return {"type": "area", "radiance": {"type": "rgb", "value": radiance.tolist()}}

    def write_mesh(
        self, name: str, attributes: dict[str, int], faces: NDArray[Any], place: Doubles, side: float = 1.0
    ) -> str:
        """PLY of a primitive, moved to its place in the world; `side` -1: facing the other way."""
        faces = faces if side > 0.0 else faces[:, ::-1]
        points = self.read_accessor(attributes["POSITION"]) @ place[:3, :3].T + place[:3, 3]
        normals = side * self.read_accessor(attributes["NORMAL"]) @ place[:3, :3].T
        has_texture = "TEXCOORD_0" in attributes
        mesh = mi.Mesh(name, len(points), len(faces), has_vertex_normals=True, has_vertex_texcoords=has_texture)
        parameters = mi.traverse(mesh)
        parameters["vertex_positions"] = points.astype(np.float32).ravel()
        parameters["vertex_normals"] = normals.astype(np.float32).ravel()
        if has_texture:
            parameters["vertex_texcoords"] = self.read_accessor(attributes["TEXCOORD_0"]).astype(np.float32).ravel()
        parameters["faces"] = faces.astype(np.uint32).ravel()
        parameters.update()
        path = str(self.folder / f"{name}.ply")
        mesh.write_ply(path)
        return path

    def add_shapes(self, scene: dict[str, Any], node: dict[str, Any], place: Doubles) -> None:
        """A node's mesh; what glows on both sides is two sheets, back to back."""
        for primitive in self.document["meshes"][node["mesh"]]["primitives"]:
            material = self.document["materials"][primitive["material"]]
            faces = self.read_accessor(primitive["indices"]).reshape(-1, 3)
            name = f"{node['name']}_{len(scene)}"
            glow = self.make_glow(material)
            looks = {"bsdf": self.make_material(material), **self.make_interior(material)}
            looks |= {"emitter": glow} if glow else {}
            scene[name] = {
                "type": "ply",
                "filename": self.write_mesh(name, primitive["attributes"], faces, place),
                **looks,
            }
            if glow and material.get("doubleSided"):
                path = self.write_mesh(f"{name}_back", primitive["attributes"], faces, place, side=-1.0)
                smaller = mi.ScalarTransform4f().scale(1.0 - _SHEET_GAP)
                scene[f"{name}_back"] = {
                    "type": "ply",
                    "filename": path,
                    "to_world": smaller,
                    **looks,
                }

    def add_light(self, scene: dict[str, Any], node: dict[str, Any], place: Doubles) -> None:
        """A punctual light. Spots must have hard edges: the two programs' fall-offs differ."""
        number = node["extensions"]["KHR_lights_punctual"]["light"]
        light = self.document["extensions"]["KHR_lights_punctual"]["lights"][number]
        value = {"type": "rgb", "value": (np.array(light["color"]) * light["intensity"]).tolist()}
        position, direction = place[:3, 3], -place[:3, 2]
        if light["type"] == "point":
            entry = {"type": "point", "position": position.tolist(), "intensity": value}
        elif light["type"] == "directional":
            entry = {"type": "directional", "direction": direction.tolist(), "irradiance": value}
        else:
            degrees = math.degrees(light["spot"]["outerConeAngle"])
            aim = mi.ScalarTransform4f().look_at(
                position.tolist(), (position + direction).tolist(), place[:3, 1].tolist()
            )
            edge = {"cutoff_angle": degrees, "beam_width": degrees * (1.0 - 1e-6)}
            entry = {"type": "spot", "to_world": aim, "intensity": value, **edge}
        scene[f"{node['name']}_{len(scene)}"] = entry

    def make_sensor(self, name: str, width: int, samples: int) -> dict[str, Any]:
        """The camera of that name."""
        node = next(n for n in self.document["nodes"] if n["name"] == name and "camera" in n)
        lens = self.document["cameras"][node["camera"]]["perspective"]
        eye, turned = np.array(node["translation"]), turn_to(node["rotation"])
        aim = mi.ScalarTransform4f().look_at(eye.tolist(), (eye - turned[:, 2]).tolist(), turned[:, 1].tolist())
        film = {"type": "hdrfilm", "width": width, "height": width, "rfilter": {"type": "box"}}
        return {
            "type": "perspective",
            "fov": math.degrees(lens["yfov"]),
            "to_world": aim,
            "film": film,
            "sampler": {"type": "independent", "sample_count": samples},
        }


def read_scene(path: Path, folder: Path) -> dict[str, Any]:
    """Shapes and lights of a file of ours as a dictionary for `mi.load_dict`; ModelError where one has no model."""
    reader = GltfReader(path, folder)
    scene: dict[str, Any] = {"type": "scene"}
    for node in reader.document["nodes"]:
        place = np.eye(4)
        place[:3, :3] = turn_to(node.get("rotation", [0.0, 0.0, 0.0, 1.0]))
        place[:3, 3] = node.get("translation", [0.0, 0.0, 0.0])
        if "mesh" in node:
            reader.add_shapes(scene, node, place)
        elif "KHR_lights_punctual" in node.get("extensions", {}):
            reader.add_light(scene, node, place)
    return scene
