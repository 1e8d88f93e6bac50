# SPDX-License-Identifier: Apache-2.0
"""``photonloupe render``: trace a scene, render it, write the picture."""

from __future__ import annotations

import argparse
import logging
from pathlib import Path
from typing import Any

import photonloupe as pl
from photonloupe.checks import check_count, check_number
from photonloupe.cli.common import (
    EXIT_OK,
    QUALITIES,
    Stopwatch,
    add_device_option,
    add_scene_options,
    choose_progress,
    open_scene,
    print_result,
    warn_ignored,
)
from photonloupe.cli.script import add_value_options, parse_values
from photonloupe.device import open_device
from photonloupe.errors import ArgumentError
from photonloupe.image import MAX_EXPOSURE, check_image_path
from photonloupe.progress import ProgressLike
from photonloupe.provenance import list_additions
from photonloupe.scripting import check_values
from photonloupe.settings import add_setting_options, list_settings, read_setting_options

LOG = logging.getLogger("photonloupe")

_MANY_CLIPPED = 0.2

SUMMARY = "trace a scene and render it"
DESCRIPTION = "Trace photons through a glTF scene, gather them, and write an .exr (linear radiance) or a .png."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("scene", metavar="SCENE", help=".gltf or .glb")
    parser.add_argument("-o", "--output", required=True, metavar="FILE", help=".exr or .png")
    photons = list_settings("trace")["count"]
    parser.add_argument(photons.option, type=photons.parse, metavar="N", help=photons.doc)
    parser.add_argument(
        "--map", metavar="MAP", help="a .zarr of the scene, instead of tracing; traced, scripted or relaxed"
    )
    parser.add_argument("--script", metavar="FILE", help="run this .photon script over the photons first")
    add_value_options(parser)
    parser.add_argument(
        "--relax",
        type=int,
        nargs="?",
        const=True,
        metavar="STEPS",
        help="relax the photons, constrained by the script's parameters, else in world space; default STEPS: the best",
    )
    add_setting_options(parser, "render")
    add_scene_options(parser)
    parser.add_argument("--camera", metavar="NAME", help="default: the scene's first")
    parser.add_argument(
        "--quality",
        choices=tuple(QUALITIES),
        default="balanced",
        help="sets --photons, --samples and --k where they are not given; default balanced",
    )
    parser.add_argument("--exposure", default="0", metavar="STOPS", help="of a .png, or 'auto'; default 0")
    add_device_option(parser)


def _read_script(arguments: argparse.Namespace) -> tuple[pl.Script | None, dict[str, float]]:
    """Check the script before any photon is traced."""
    values = parse_values(arguments.set)
    if arguments.script is None:
        if values:
            raise ArgumentError("--set gives a value to a script; name it with --script")
        if read_setting_options(arguments, "render").get("mode") == "false-color" and arguments.map is None:
            raise ArgumentError("--mode false-color shows the colors a script gives; name it with --script")
        return None, {}
    script = pl.compile_script(Path(arguments.script))
    script.require()
    return script, check_values(script, values)


def _find_photons(
    arguments: argparse.Namespace, scene: pl.Scene, device: pl.Device, progress: ProgressLike
) -> pl.PhotonMap:
    """Load the map that was named, or trace one."""
    if arguments.map is None:
        count = QUALITIES[arguments.quality].photons if arguments.photons is None else arguments.photons
        return pl.trace_photons(scene, count, seed=getattr(arguments, "seed", None), device=device, progress=progress)
    photons = pl.load_photons(arguments.map, device=device)
    if not scene.additions:
        scene.restore(list_additions(photons.provenance))
    if photons.provenance.get("scene_hash", scene.hash) != scene.hash:
        LOG.warning(f"{arguments.map} was not traced in {arguments.scene} as it is now; its light may not fit")
    return photons


def _has_no_caustic(arguments: argparse.Namespace, scene: pl.Scene, settings: dict[str, Any]) -> bool:
    """Tell whether the default picture would be refused, for no light goes by way of anything specular."""
    asked = (arguments.map, arguments.script, arguments.relax)
    specular = {"mirrors", "dielectrics", "thin glass", "gloss and coats"} & set(scene.report["requires"])
    is_asked = settings.get("mode", "composite") == "composite" and asked == (None, None, None)
    return is_asked and bool(scene.lights) and not specular


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    output = check_image_path(arguments.output)
    exposure: float | str = "auto"
    if arguments.exposure != "auto":
        exposure = check_number("--exposure", arguments.exposure, -MAX_EXPOSURE, MAX_EXPOSURE)
    # Given without a number it is True.
    steps = None if arguments.relax is True else arguments.relax
    if steps is not None:
        check_count("--relax", steps, *list_settings("relax")["steps"].limits)
    quality = QUALITIES[arguments.quality]
    settings = {"samples": quality.samples, "k": quality.k, **read_setting_options(arguments, "render")}
    is_direct = settings.get("mode") == "direct"
    for option in ("relax", "script", "map"):
        if getattr(arguments, option) is not None and is_direct:
            raise ArgumentError(f"--mode direct uses no photons; leave --{option} out, or choose another mode")
    if arguments.map is not None and arguments.photons is not None:
        raise ArgumentError("--map brings its photons; leave --photons out, or the map")
    script, values = _read_script(arguments)
    watch = Stopwatch()
    progress = choose_progress()
    with watch.measure("load"):
        scene = open_scene(arguments, arguments.scene)
    warn_ignored(scene)
    if _has_no_caustic(arguments, scene, settings):
        LOG.warning(f"{arguments.scene} has nothing specular, so no caustic: the picture is direct light alone")
        settings["mode"], is_direct = "direct", True
    with watch.measure("device"):
        device = open_device(arguments.device)
    photons = None
    if not is_direct:
        with watch.measure("trace" if arguments.map is None else "load"):
            photons = _find_photons(arguments, scene, device, progress)
    if photons is not None and script is not None:
        with watch.measure("script"):
            photons.run_script(script, values=values, progress=progress)
    if photons is not None and arguments.relax is not None:
        with watch.measure("relax"):
            photons = photons.relax(steps, progress=progress)
    with watch.measure("render"):
        image = pl.render(
            scene,
            photons,
            camera=arguments.camera,
            device=device,
            progress=progress,
            **settings,
        )
    with watch.measure("save"):
        image.save(output, exposure=exposure)
    if output.suffix.lower() == ".png" and not isinstance(exposure, str):
        clipped = image.find_clipped_share(exposure)
        if clipped > _MANY_CLIPPED:
            LOG.warning(
                f"{clipped:.0%} of the pixels are brighter than a .png can show; --exposure auto would be "
                f"{image.find_exposure():g}, an .exr holds everything"
            )
    result = {
        "output": str(output),
        "width": image.width,
        "height": image.height,
        "photons": 0 if photons is None else len(photons),
        "relaxation": None if photons is None else photons.relaxation.get("settings"),
        "seconds": watch.seconds,
        "provenance": image.provenance,
    }
    relaxed = f", {result['relaxation']['steps']} steps of relaxation" if result["relaxation"] else ""
    spent = ", ".join(f"{step} {seconds:.2f}" for step, seconds in watch.seconds.items())
    print_result(
        arguments,
        result,
        [f"{output}: {image.width} × {image.height}, {result['photons']:,} photons{relaxed}; seconds: {spent}"],
    )
    return EXIT_OK
