# SPDX-License-Identifier: Apache-2.0
"""``photonloupe studio``: the interactive tool, in a window or as a picture."""

from __future__ import annotations

import argparse
import re
from pathlib import Path

import photonloupe as pl
from photonloupe.checks import check_count, check_number
from photonloupe.cli.common import EXIT_OK, add_device_option, add_scene_options, open_scene, print_result
from photonloupe.errors import ArgumentError
from photonloupe.photons import MAX_EMITTED

SUMMARY = "look at photons, write scripts, relax, compare"
DESCRIPTION = (
    "Open the studio on a scene (.gltf, .glb), a photon map (.zarr) or a session (.loupe); with --screenshot draw it "
    "without a window."
)
_SIZE = re.compile(r"(\d+)x(\d+)")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("file", metavar="FILE", nargs="?", help="scene, photon map or session; default: begin empty")
    parser.add_argument("--screenshot", metavar="OUT.png", help="draw the interface into a picture, without a window")
    parser.add_argument("--size", default="1600x900", metavar="WxH", help="pixels; default 1600x900")
    parser.add_argument("--scale", type=float, default=1.0, metavar="X", help="of fonts and widgets, 0.5 to 4")
    parser.add_argument("--photons", type=int, metavar="N", help="photons to trace; default 50,000")
    parser.add_argument("--script", metavar="FILE", help="a .photon script to open and run")
    parser.add_argument("--panel", metavar="NAME", help="with --screenshot: this panel alone")
    parser.add_argument(
        "--frames", type=int, metavar="N", help="close the window after so many frames and tell their times"
    )
    add_scene_options(parser)
    add_device_option(parser)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    size = _parse_size(arguments.size)
    is_scene = arguments.file is not None and Path(arguments.file).suffix.lower() in {".gltf", ".glb"}
    if arguments.panel is not None and arguments.screenshot is None:
        raise ArgumentError("--panel draws a picture; say where with --screenshot")
    if not is_scene and (arguments.light or arguments.floor):
        raise ArgumentError("--light and --floor add to a scene; name its .gltf or .glb")
    if arguments.frames is not None:
        check_count("--frames", arguments.frames, 1, 1_000_000)
    if arguments.photons is not None:
        check_count("--photons", arguments.photons, 1, MAX_EMITTED)
    with pl.Studio(
        scene=open_scene(arguments, str(arguments.file)) if is_scene else None,
        offscreen=arguments.screenshot is not None,
        size=size,
        photons=arguments.photons,
        script=None if arguments.script is None else Path(arguments.script),
        scale=check_number("--scale", arguments.scale, 0.5, 4.0),
        device=arguments.device,
    ) as studio:
        if arguments.file is not None and not is_scene:
            studio.open(arguments.file)
        if arguments.screenshot is not None:
            return _draw(arguments, studio, size)
        return _show(arguments, studio)


def _draw(arguments: argparse.Namespace, studio: pl.Studio, size: tuple[int, int]) -> int:
    studio.frame()
    if studio.has_failed:
        raise ArgumentError(studio.message)
    if arguments.panel is None:
        studio.save_image(arguments.screenshot)
    else:
        studio.export_panel(arguments.panel, arguments.screenshot, size, arguments.scale)
    result = {"screenshot": arguments.screenshot, "width": size[0], "height": size[1]}
    print_result(arguments, result, [f"{arguments.screenshot}: {size[0]} × {size[1]}"])
    return EXIT_OK


def _show(arguments: argparse.Namespace, studio: pl.Studio) -> int:
    studio.run(arguments.frames)
    times = studio.statistics()["frames"]
    within = float((times < 100.0).mean()) if len(times) else 1.0
    result = {"frames": len(times), "milliseconds": times.tolist(), "within_100_ms": within}
    told = [f"{len(times)} frames, {100 * within:.0f} % of them within 100 ms"] if arguments.frames else []
    print_result(arguments, result, told)
    return EXIT_OK


def _parse_size(text: str) -> tuple[int, int]:
    match = _SIZE.fullmatch(text)
    if match is None:
        raise ArgumentError(f"--size {text!r} is not a size; write for example 1600x900")
    return int(match[1]), int(match[2])
