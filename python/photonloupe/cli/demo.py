# SPDX-License-Identifier: Apache-2.0
"""``photonloupe demo``: the ring case study from start to finish, pictures into out/demo/."""

from __future__ import annotations

import argparse
import os
from pathlib import Path
from typing import Any

import photonloupe as pl
from photonloupe.cli.common import (
    EXIT_OK,
    QUALITIES,
    Stopwatch,
    add_device_option,
    choose_progress,
    format_table,
    print_result,
)
from photonloupe.device import open_device

SUMMARY = "the ring case study, pictures into out/demo/"
DESCRIPTION = "Trace the gold ring, save its photon map, render its caustic, composite and photons."

_SCENE = Path("scenes", "ring", "ring.gltf")
_PHOTONS = QUALITIES["balanced"].photons
_SIDE = 512
# Four samples a pixel keep the demo under a minute on a software device.
_SAMPLES = 4
# Mode, camera, exposure. The floor under the lamp has radiance 0.87 and needs no brightening; the caustic alone does.
_PICTURES = (
    ("caustic", "top", 1.0),
    ("composite", "view", 0.0),
    ("composite", "top", 0.0),
    ("photons", "close", 1.0),
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("-o", "--output", metavar="FOLDER", help="default out/demo")
    add_device_option(parser)


def _find_root() -> Path:
    """Return the folder with the scenes: where the launcher lives, or where we are."""
    root = Path(os.environ.get("PHOTONLOUPE_ROOT", "."))
    if not (root / _SCENE).is_file():
        raise pl.SceneError(f"{root / _SCENE} is not there; run the demo from the repository's root")
    return root


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    root = _find_root()
    folder = Path(arguments.output) if arguments.output else root / "out" / "demo"
    folder.mkdir(parents=True, exist_ok=True)
    progress = choose_progress()
    device = open_device(arguments.device)
    made: list[dict[str, Any]] = []

    watch = Stopwatch()
    with watch.measure("all"):
        scene = pl.load_scene(root / _SCENE)
        photons = pl.trace_photons(scene, _PHOTONS, device=device, progress=progress)
        photons.save(folder / "ring.zarr")
    made.append(
        {
            "file": str(folder / "ring.zarr"),
            "what": f"photon map: {len(photons):,} of {photons.emitted:,} emitted",
            "seconds": watch.seconds["all"],
        }
    )
    for mode, camera, exposure in _PICTURES:
        watch = Stopwatch()
        with watch.measure("all"):
            image = pl.render(
                scene,
                photons,
                camera=camera,
                width=_SIDE,
                height=_SIDE,
                samples=_SAMPLES,
                mode=mode,
                device=device,
                progress=progress,
            )
            stem = folder / f"{mode}_{camera}"
            image.save(stem.with_suffix(".exr"))
            image.save(stem.with_suffix(".png"), exposure=exposure)
        what = f"{mode}, camera {camera}, {image.width} × {image.height}; beside it the EXR"
        made.append({"file": f"{stem}.png", "what": what, "seconds": watch.seconds["all"]})

    def write_table() -> list[str]:
        rows = [["file", "what", "seconds"]]
        rows += [[row["file"], row["what"], f"{row['seconds']:.2f}"] for row in made]
        return [f"device: {device.info.get('name')}", *format_table(rows)]

    print_result(arguments, {"made": made, "device": device.info}, write_table)
    return EXIT_OK
