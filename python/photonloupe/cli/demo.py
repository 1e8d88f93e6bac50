# SPDX-License-Identifier: Apache-2.0
"""``photonloupe demo``: the ring case study from start to finish, pictures into out/demo/."""

from __future__ import annotations

import argparse
import os
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

import photonloupe as pl
from photonloupe.cli.common import (
    EXIT_OK,
    QUALITIES,
    add_device_option,
    choose_progress,
    format_table,
    print_result,
)
from photonloupe.cli.contact_sheet import build_contact_sheet
from photonloupe.device import open_device

SUMMARY = "the ring case study, pictures into out/demo/"
DESCRIPTION = (
    "Trace the gold ring, save its photon map, render its caustic, composite and photons; run scripts over it and show "
    "their parameters in false color; then relax a noisier map of it in three ways and show them side by side, and "
    "in the studio."
)

_SCENE = Path("scenes", "ring", "ring.gltf")
_PHOTONS = QUALITIES["balanced"].photons
_SIDE = 512
# Four samples a pixel keep the demo under a minute and a half on a software device.
_SAMPLES = 4
# Mode, camera, exposure; the quickest first, while the kernels of the others are compiled. The floor under the lamp
# has radiance 0.87 and needs no brightening; the caustic alone does.
_PICTURES = (
    ("photons", "close", 1.0),
    ("caustic", "top", 1.0),
    ("composite", "view", 0.0),
    ("composite", "top", 0.0),
)

# Scripts whose colors are shown, with what their exposed variables are set to: few enough turns of hue to tell apart.
_SCRIPTS = Path("scenes", "scripts")
_SHOWN_SCRIPTS: tuple[tuple[str, dict[str, float]], ...] = (
    ("tortuosity", {"turns": 6}),
    ("primal_trajectory", {"zoom": 4}),
    ("ppca", {"turns": 2}),
)
_LAYERS = "primal_trajectory"
_FALSE_COLOR_EXPOSURE = 1.0

# The comparison. Random emission leaves the most to relax; on Sobol's the differences are the same but smaller.
_COMPARED_PHOTONS = 100_000
_COMPARED_EMISSION = "random"
_COMPARED_K = 20
# Once per pixel is enough, the estimate itself is smooth.
_COMPARED_SAMPLES = 1
_COMPARED_EXPOSURE = 0.3
# Of the picture's height: from the wall's rim to below the cusp, with the band between where the light crosses itself.
_BAND = (0.06, 0.5)
_COLUMNS = 2
# Where the light of both halves of the wall crosses itself, m.
_CROSSING = (0.0, 0.0, -0.908)


@dataclass(frozen=True)
class _Way:
    """One way to relax: file name, label, keywords of `PhotonMap.relax`; None leaves the photons as they are."""

    name: str
    label: str
    settings: dict[str, Any] | None = field(default_factory=dict)


_WAYS = (
    _Way("raw", "not relaxed", None),
    _Way("unconstrained", "relaxed without constraint", {"constraint": "world", "descriptor": "none"}),
    _Way("world", "relaxed, constrained in world space", {"constraint": "world"}),
    _Way("parameter", "relaxed, parameter-aware", {"constraint": "parameter", "repel": "parameter"}),
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


class _Demo:
    """The scene, its scripts, the device, the folder, and the list of what was made so far."""

    def __init__(self, root: Path, folder: Path, device: pl.Device) -> None:
        self.scene, self.folder, self.device = pl.load_scene(root / _SCENE), folder, device
        self.scripts = root / _SCRIPTS
        self.progress = choose_progress()
        self.made: list[dict[str, Any]] = []

    def note(self, path: Path, what: str, start: float) -> None:
        """Add a file, made since `start`, to the list."""
        self.made.append({"file": str(path), "what": what, "seconds": time.perf_counter() - start})

    def trace(self, count: int, emission: str) -> pl.PhotonMap:
        """Trace a map."""
        return pl.trace_photons(self.scene, count, emission=emission, device=self.device, progress=self.progress)

    def run_script(self, photons: pl.PhotonMap, name: str, values: dict[str, float]) -> None:
        """Give the photons the parameters and colors of a script."""
        photons.run_script(self.scripts / f"{name}.photon", values=values, progress=self.progress)

    def render(self, photons: pl.PhotonMap, **settings: Any) -> pl.Image:
        """Render a square picture."""
        return pl.render(
            self.scene, photons, width=_SIDE, height=_SIDE, device=self.device, progress=self.progress, **settings
        )

    def save(self, image: pl.Image, stem: str, exposure: float) -> Path:
        """Write the EXR and the PNG, and return the path of the PNG."""
        image.save(self.folder / f"{stem}.exr")
        path = self.folder / f"{stem}.png"
        image.save(path, exposure=exposure)
        return path


def _show_ring(demo: _Demo) -> None:
    """Trace, save, and render the ring."""
    start = time.perf_counter()
    photons = demo.trace(_PHOTONS, "sobol")
    photons.save(demo.folder / "ring.zarr")
    demo.note(
        demo.folder / "ring.zarr", f"photon map: {len(photons):,} of {photons.emitted:,} emitted, Sobol emission", start
    )
    for mode, camera, exposure in _PICTURES:
        start = time.perf_counter()
        image = demo.render(photons, camera=camera, mode=mode, samples=_SAMPLES)
        path = demo.save(image, f"{mode}_{camera}", exposure)
        demo.note(path, f"{mode}, camera {camera}, {image.width} × {image.height}; beside it the EXR", start)


def _show_scripts(demo: _Demo) -> None:
    """Show the ring in the colors of scripts."""
    photons = demo.trace(_PHOTONS, "sobol")
    sheet: dict[str, pl.Image] = {}
    for name, values in _SHOWN_SCRIPTS:
        start = time.perf_counter()
        demo.run_script(photons, name, values)
        image = demo.render(photons, camera="top", mode="false-color", samples=_COMPARED_SAMPLES)
        path = demo.save(image, f"script_{name}", _FALSE_COLOR_EXPOSURE)
        sheet[f"{name}: {', '.join(photons.parameter_names)}"] = image
        demo.note(path, f"false color of {name}.photon, camera top; beside it the EXR", start)
    path = demo.folder / "scripts.png"
    start = time.perf_counter()
    build_contact_sheet(sheet, columns=len(sheet), exposure=_FALSE_COLOR_EXPOSURE).save(path)
    demo.note(path, "the scripts side by side: where sheets of light cross, colors tell them apart", start)


def _compare_relaxations(demo: _Demo) -> None:
    """Relax one map in every way, and render the band of each."""
    photons = demo.trace(_COMPARED_PHOTONS, _COMPARED_EMISSION)
    demo.run_script(photons, _LAYERS, {})
    sheet: dict[str, pl.Image] = {}
    for way in _WAYS:
        start = time.perf_counter()
        moved = photons if way.settings is None else photons.relax(**way.settings, progress=demo.progress)
        image = demo.render(moved, camera="close", mode="caustic", samples=_COMPARED_SAMPLES, k=_COMPARED_K)
        top, bottom = (round(share * image.height) for share in _BAND)
        image = pl.Image(np.asarray(image)[top : max(bottom, top + 1)], provenance=image.provenance)
        path = demo.save(image, f"relax_{way.name}", _COMPARED_EXPOSURE)
        sheet[way.label] = image
        demo.note(path, f"caustic, camera close, {_describe(way, moved)}; beside it the EXR", start)
    start = time.perf_counter()
    path = demo.folder / "relax.png"
    build_contact_sheet(sheet, columns=_COLUMNS, exposure=_COMPARED_EXPOSURE).save(path)
    what = (
        f"the four side by side: {len(photons):,} photons, {_COMPARED_EMISSION} emission; the last keeps the inner band"
    )
    demo.note(path, what, start)


def _show_studio(demo: _Demo) -> None:
    """Look at the crossing in the studio: three sheets of light that the primal trajectory tells apart."""
    start = time.perf_counter()
    path = demo.folder / "studio.png"
    with pl.Studio(
        scene=demo.scene,
        offscreen=True,
        photons=_COMPARED_PHOTONS,
        script=demo.scripts / f"{_LAYERS}.photon",
        device=demo.device,
    ) as studio:
        studio.frame()
        studio.command("view.straight")
        studio.command("view.colored_points")
        studio.look_at(_CROSSING)
        studio.command("relax.run")
        studio.save_image(path)
    demo.note(path, f"the studio, relaxed photons in the colors of {_LAYERS}, the loupe at the crossing", start)


def _describe(way: _Way, photons: pl.PhotonMap) -> str:
    settings = photons.relaxation.get("settings")
    return f"k = {_COMPARED_K}, {way.label}" + (f", {settings['steps']} steps" if settings else "")


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    root = _find_root()
    folder = Path(arguments.output) if arguments.output else root / "out" / "demo"
    folder.mkdir(parents=True, exist_ok=True)
    device = open_device(arguments.device)
    demo = _Demo(root, folder, device)
    _show_ring(demo)
    _show_scripts(demo)
    _compare_relaxations(demo)
    _show_studio(demo)

    def write_table() -> list[str]:
        rows = [["file", "what", "seconds"]]
        rows += [[row["file"], row["what"], f"{row['seconds']:.2f}"] for row in demo.made]
        return [f"device: {device.info.get('name')}", *format_table(rows)]

    print_result(arguments, {"made": demo.made, "device": device.info}, write_table)
    return EXIT_OK
