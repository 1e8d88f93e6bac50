# SPDX-License-Identifier: Apache-2.0
"""Renders the scene `lamp` here and with Mitsuba's volpath, side by side, and prints how far regions are apart."""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
import scene_data
from find_llvm import find_llvm
from PIL import Image

import photonloupe as pl

WIDTH = 128
BOUNCES = 40
EXPOSURE = 0.23
# Rows and columns of the picture.
REGIONS = {"shade": (10, 40, 40, 90), "table": (100, 125, 5, 30), "wall": (20, 45, 100, 125), "bowl": (82, 100, 45, 85)}


def main() -> None:
    """Write the picture named on the command line."""
    if reason := find_llvm():
        raise SystemExit(f"no comparison: {reason}")
    import mitsuba as mi  # noqa: PLC0415 - an optional peer

    mi.set_variant("llvm_ad_rgb")
    from mitsuba_scenes import GltfReader, read_scene  # noqa: PLC0415 - needs the variant

    path = scene_data.SCENES / "lamp" / "lamp.gltf"
    with tempfile.TemporaryDirectory() as folder:
        told = read_scene(path, Path(folder))
        told["sensor"] = GltfReader(path, Path(folder)).make_sensor("view", WIDTH, 1024)
        scene = mi.load_dict(told, optimize=False)
    integrator = mi.load_dict({"type": "volpath", "max_depth": BOUNCES, "rr_depth": 30})
    theirs = np.array(mi.render(scene, integrator=integrator))
    ours_scene = pl.load_scene(path)
    photons = pl.trace_photons(ours_scene, 400_000, store="indirect", max_bounces=BOUNCES)
    size = {"width": WIDTH, "height": WIDTH, "samples": 48, "max_bounces": BOUNCES}
    ours = np.asarray(pl.render(ours_scene, photons, camera="view", **size))
    for name, (top, bottom, left, right) in REGIONS.items():
        here, there = (each[top:bottom, left:right].mean(axis=(0, 1)) for each in (ours, theirs))
        print(f"{name}: ours over theirs {np.round(here / there, 4)}")
    both = np.clip(EXPOSURE * np.concatenate([ours, theirs], axis=1), 0.0, 1.0)
    codes = np.round(255.0 * both ** (1.0 / 2.2)).astype(np.uint8)
    Image.fromarray(codes).resize((6 * WIDTH, 3 * WIDTH)).save(sys.argv[1])


if __name__ == "__main__":
    main()
