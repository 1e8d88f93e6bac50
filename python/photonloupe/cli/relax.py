# SPDX-License-Identifier: Apache-2.0
"""``photonloupe relax``: move the photons of a saved map apart, and write the relaxed map."""

from __future__ import annotations

import argparse
import textwrap
from typing import Any

import photonloupe as pl
from photonloupe.cli.common import EXIT_OK, Stopwatch, add_device_option, choose_progress, format_table, print_result
from photonloupe.device import open_device
from photonloupe.settings import add_setting_options, list_settings, read_setting_options
from photonloupe.storage import check_map_path

WIDTH = 110  # of lines that say what was used

SUMMARY = "relax the photons of a saved map, as far as their constraints allow"
DESCRIPTION = (
    "Move photons apart until the noise is gone while edges stay (docs/relaxation.md). What nothing is said of is the "
    "best known for the map."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("map", metavar="MAP", help="the .zarr folder to read")
    parser.add_argument("-o", "--output", required=True, metavar="MAP2", help="the .zarr folder to write")
    add_setting_options(parser, "relax")
    add_device_option(parser)


def _describe_settings(settings: dict[str, Any], surface: str, photons: int) -> list[str]:
    """Say in words what was used."""
    told = [f"{name} {setting.write(settings[name])}" for name, setting in list_settings("relax").items()]
    return [f"{photons:,} photons, moved on: {surface}", *textwrap.wrap(", ".join(told), WIDTH)]


def _format_steps(rows: list[dict[str, Any]]) -> list[str]:
    table = [["step", "tau", "mean move", "largest move", "mean pressure", "seconds"]]
    for row in rows:
        moves = [f"{row[name]:.5f}" for name in ("mean_move", "largest_move", "mean_pressure")]
        table.append([str(row["step"]), f"{row['tau']:.3f}", *moves, f"{row['seconds']:.2f}"])
    return format_table(table)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    check_map_path(arguments.output)
    settings = read_setting_options(arguments, "relax")
    progress = choose_progress()
    watch = Stopwatch()
    with watch.measure("device"):
        device = open_device(arguments.device)
    with watch.measure("load"):
        photons = pl.load_photons(arguments.map, device=device)
    with watch.measure("constraint"):
        relaxation = pl.Relaxation(photons, progress=progress, **settings)
    rows: list[dict[str, Any]] = []
    for _ in range(relaxation.steps):
        step = Stopwatch()
        with watch.measure("steps"), step.measure("step"):
            row = relaxation.step(progress=progress)
        rows.append({**row, "seconds": step.seconds["step"]})
    with watch.measure("save"):
        relaxation.photons.save(arguments.output)
    report = relaxation.report
    result = {
        "output": arguments.output,
        "photons": len(photons),
        "settings": report["settings"],
        "steps": rows,
        "surface": report["surface"],
        "off_surface": report["off_surface"],
        "seconds": watch.seconds,
    }
    lines = [
        *_format_steps(rows),
        *_describe_settings(report["settings"], report["surface"], len(photons)),
        f"{arguments.output}: seconds: " + watch.format(),
    ]
    print_result(arguments, result, lines)
    return EXIT_OK
