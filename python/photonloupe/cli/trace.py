# SPDX-License-Identifier: Apache-2.0
"""``photonloupe trace``: trace a scene and write the photon map."""

from __future__ import annotations

import argparse

import photonloupe as pl
from photonloupe.cli.common import (
    EXIT_OK,
    Stopwatch,
    add_device_option,
    add_scene_options,
    choose_progress,
    open_scene,
    print_result,
    warn_ignored,
)
from photonloupe.columns import PATH_NAMES
from photonloupe.device import open_device
from photonloupe.settings import add_setting_options, read_setting_options
from photonloupe.storage import check_map_path

SUMMARY = "trace a scene and write a photon map"
DESCRIPTION = "Trace photons through a glTF scene and write them with their columns as a Zarr v3 folder."


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("scene", metavar="SCENE", help=".gltf or .glb")
    parser.add_argument("-o", "--output", required=True, metavar="MAP", help="the .zarr folder to write")
    add_setting_options(parser, "trace")
    parser.add_argument(
        "--columns",
        default="",
        metavar="A,B",
        help=f"paths to record: 'paths' for all, or any of {', '.join(PATH_NAMES)}; default none",
    )
    add_scene_options(parser)
    add_device_option(parser)


def _parse_columns(text: str) -> list[str]:
    names = [name.strip() for name in text.split(",") if name.strip()]
    return [column for name in names for column in (PATH_NAMES if name == "paths" else (name,))]


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    check_map_path(arguments.output)
    watch = Stopwatch()
    with watch.measure("load"):
        scene = open_scene(arguments, arguments.scene)
    warn_ignored(scene)
    with watch.measure("device"):
        device = open_device(arguments.device)
    with watch.measure("trace"):
        photons = pl.trace_photons(
            scene,
            columns=_parse_columns(arguments.columns),
            device=device,
            progress=choose_progress(),
            **read_setting_options(arguments, "trace"),
        )
    with watch.measure("save"):
        photons.save(arguments.output)
    result = {
        "output": arguments.output,
        "photons": len(photons),
        "emitted": photons.emitted,
        "total_flux": photons.total_flux,
        "columns": photons.recorded,
        "report": photons.report,
        "seconds": watch.seconds,
        "provenance": photons.provenance,
    }
    flux = ", ".join(f"{value:.6g}" for value in photons.total_flux)
    lines = [
        f"{arguments.output}: {len(photons):,} photons of {photons.emitted:,} emitted, flux ({flux}) W",
        f"columns: {', '.join(photons.recorded)}",
        "seconds: " + ", ".join(f"{step} {seconds:.2f}" for step, seconds in watch.seconds.items()),
    ]
    print_result(arguments, result, lines)
    return EXIT_OK
