# SPDX-License-Identifier: Apache-2.0
"""How much light Mitsuba lands on receivers: its emitters, materials and meshes, followed from the lights."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
from numpy.typing import NDArray

mi.set_variant("llvm_ad_rgb")

from mitsuba_scenes import read_scene  # noqa: E402 - Mitsuba's types exist once a variant is set

LONGEST_PATH = 64


def make_environment(radiance: float, image: Path | None) -> dict[str, Any]:
    """Light from all around, as ours lies: +x in the image's middle, +z to the right of it.

    Columns are moved instead of the emitter turned: Mitsuba 3.9.1 starts the rays of a turned one in wrong places.
    """
    if image is None:
        return {"type": "constant", "radiance": {"type": "rgb", "value": radiance}}
    pixels = np.array(mi.Bitmap(str(image)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
    moved = np.ascontiguousarray(np.roll(pixels, -pixels.shape[1] // 4, axis=1))
    return {"type": "envmap", "bitmap": mi.Bitmap(moved), "scale": radiance}


def follow_light(scene: Any, receivers: dict[str, Any], count: int, seed: int) -> dict[str, float]:
    """Flux of the middle channel on each receiver, W, from `count` photons; receivers must be black."""
    rng = mi.PCG32(size=count, initstate=seed)
    landed = dict.fromkeys(receivers, 0.0)
    context = mi.BSDFContext(mi.TransportMode.Importance)
    one, two, three = rng.next_float32(), draw_pair(rng), draw_pair(rng)
    ray, power, _ = scene.sample_emitter_ray(0.0, one, two, three, True)
    active = mi.Bool(True)
    for _ in range(LONGEST_PATH):
        hit = scene.ray_intersect(ray, active)
        active &= hit.is_valid()
        for name, shape in receivers.items():
            here = active & (hit.shape == mi.ShapePtr(shape))
            landed[name] += float(dr.sum(dr.select(here, mi.Float64(power.y), 0.0)).numpy()[0])
            active &= ~here
        sample, weight = hit.bsdf(ray).sample(context, hit, rng.next_float32(active), draw_pair(rng), active)
        power *= dr.select(active, weight, 1.0)
        active &= dr.max(power) > 0.0
        ray = hit.spawn_ray(hit.to_world(sample.wo))
        dr.eval(ray, power, active, rng)
        if not dr.any(active):
            break
    return {name: value / count for name, value in landed.items()}


def draw_pair(rng: Any) -> Any:
    """Two numbers in [0, 1)."""
    return mi.Point2f(rng.next_float32(), rng.next_float32())


def measure_flux(
    path: Path, names: list[str], passes: int, count: int, environment: dict[str, Any] | None
) -> dict[str, NDArray[np.float64]]:
    """The flux on the receivers `names` in each of so many passes."""
    with tempfile.TemporaryDirectory() as folder:
        told = read_scene(path, Path(folder))
        if environment is not None:
            told["environment"] = environment
        scene = mi.load_dict(told, optimize=False)  # else equal materials merge their shapes
    receivers = {name: next(s for s in scene.shapes() if s.id().rsplit("_", 1)[0] == name) for name in names}
    runs = [follow_light(scene, receivers, count, seed + 1) for seed in range(passes)]
    return {name: np.array([run[name] for run in runs]) for name in names}
