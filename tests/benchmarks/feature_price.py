# SPDX-License-Identifier: Apache-2.0
"""What each kind of light and matter costs a trace of the ring: seconds over those of the ring as it is.

`./photonloupe python tests/benchmarks/feature_price.py` prints the table of docs/energy.md. Every variant is traced in
turn, ROUNDS times; the least counts.
"""

from __future__ import annotations

import io
import json
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

import photonloupe as pl

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "scenes")]

import gltf  # noqa: E402 - found beside the scenes

# Gets the writer, the ring's material and the floor's.
Change = Callable[[gltf.GltfWriter, dict[str, Any], dict[str, Any]], Any]

ROUNDS = 5
PHOTONS = 200_000


def encode(codes: np.ndarray) -> bytes:
    """PNG of 8-bit codes."""
    stream = io.BytesIO()
    Image.fromarray(codes).save(stream, "PNG")
    return stream.getvalue()


def build_ring(folder: Path, name: str, change: Change) -> Path:
    """Write a mirror ring on a floor under a lamp, with what `change` makes of it."""
    writer = gltf.GltfWriter(name)
    mirror, floor = gltf.make_mirror("gold", (0.9, 0.7, 0.4)), gltf.make_diffuse("floor", 0.5)
    change(writer, mirror, floor)
    quad = gltf.build_quad(3.0)
    coordinates = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])
    ring = gltf.build_cylinder(1.0, 0.5, 2000, 6)
    around = np.arctan2(ring.positions[:, 2], ring.positions[:, 0]) / (2.0 * np.pi)
    writer.add_mesh("ring", ring, mirror, coordinates=[np.stack([around, ring.positions[:, 1]], axis=1)])
    writer.add_mesh("floor", quad, floor, coordinates=[coordinates])
    if not writer.lights:
        writer.add_point_light("lamp", (0.0, 1.6, 2.0), 10.0)
    writer.write(folder)
    return folder / f"{name}.gltf"


def texture(writer: gltf.GltfWriter) -> dict[str, int]:
    """Reference to a noise image."""
    codes = np.random.default_rng(1).integers(128, 256, (256, 256, 3), dtype=np.uint8)
    return {"index": writer.add_texture(encode(codes))}


def paint_ring(writer: gltf.GltfWriter, mirror: dict[str, Any], _floor: dict[str, Any]) -> None:
    """Give the ring a base color texture."""
    mirror["pbrMetallicRoughness"]["baseColorTexture"] = texture(writer)


def mask_ring(_writer: gltf.GltfWriter, mirror: dict[str, Any], _floor: dict[str, Any]) -> None:
    """Let a tenth of the light pass the ring."""
    mirror.update(alphaMode="BLEND")
    mirror["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.9


VARIANTS: dict[str, Change] = {
    "as it is": lambda *_: None,
    "rough ring": lambda _writer, mirror, _floor: mirror["pbrMetallicRoughness"].update(roughnessFactor=0.2),
    "textured ring": paint_ring,
    "ring of alpha 0.9": mask_ring,
    "glossy floor": lambda _writer, _mirror, floor: floor.update(extensions={"KHR_materials_specular": {}}),
    "coated ring": lambda _writer, mirror, _floor: mirror.update(
        extensions={"KHR_materials_clearcoat": {"clearcoatFactor": 1.0}}
    ),
    "spot light": lambda writer, *_: writer.add_spot_light("spot", (0.0, 1.6, 2.0), (0.0, 0.0, 0.0), 10.0, 0.4, 0.8),
    "directional light": lambda writer, *_: writer.add_directional_light("sun", (0.2, -1.0, -0.6), 3.0),
}


def measure() -> dict[str, float]:
    """Time each variant, paths kept, s."""
    with tempfile.TemporaryDirectory() as folder:
        scenes = {
            name: pl.load_scene(build_ring(Path(folder), f"ring{i}", change))
            for i, (name, change) in enumerate(VARIANTS.items())
        }
        seconds: dict[str, float] = {}
        for scene in scenes.values():
            pl.trace_photons(scene, 20_000, columns=["path_vertices"])  # kernels
        for seed in range(1, ROUNDS + 1):
            for name, scene in scenes.items():
                pl.trace_photons(scene, 1000, seed=seed)  # where to aim
                start = time.perf_counter()
                pl.trace_photons(scene, PHOTONS, seed=seed, columns=["path_vertices"])
                taken = time.perf_counter() - start
                seconds[name] = min(seconds.get(name, np.inf), taken)
        return seconds


if __name__ == "__main__":
    measured = measure()
    plain = measured["as it is"]
    print("| ring, 200,000 photons with paths | seconds | over the ring as it is |\n|---|---|---|")
    for variant, taken in measured.items():
        print(f"| {variant} | {taken:.3f} | {taken / plain:.2f} |")
    print(json.dumps(measured), file=sys.stderr)
