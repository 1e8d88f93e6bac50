# SPDX-License-Identifier: Apache-2.0
"""``photonloupe relax``: move the photons of a saved map apart, and write the relaxed map."""

from __future__ import annotations

import argparse
from typing import Any

import photonloupe as pl
from photonloupe.cli.common import (
    EXIT_OK,
    Stopwatch,
    add_device_option,
    choose_progress,
    format_table,
    print_result,
)
from photonloupe.device import open_device
from photonloupe.errors import ArgumentError
from photonloupe.relaxing import DESCRIPTORS, SEARCHES, SPACES, SURFACES
from photonloupe.storage import check_map_path

SUMMARY = "relax the photons of a saved map, as far as their constraints allow"
DESCRIPTION = (
    "Move photons apart until the noise is gone while edges stay (docs/relaxation.md). What nothing is said of is the "
    "best known for the map's emission and constraint."
)

_BEST = "default the best known"


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("map", metavar="MAP", help="the .zarr folder to read")
    parser.add_argument("-o", "--output", required=True, metavar="MAP2", help="the .zarr folder to write")
    parser.add_argument("--steps", type=int, metavar="S", help=f"{_BEST}; 0 measures the constraint only")
    parser.add_argument("--neighbors", type=int, metavar="K", help=f"that push a photon, 1 to 998; {_BEST}")
    parser.add_argument(
        "--constraint",
        choices=("auto", *SPACES),
        default="auto",
        help="which photons say where one may go; default auto: parameter where the map has parameters, else world",
    )
    parser.add_argument("--descriptor", choices=DESCRIPTORS, help=f"what finds edges; {_BEST}")
    parser.add_argument("--beta", metavar="X", help=f"reach of layers in parameter space, a number or auto; {_BEST}")
    parser.add_argument("--repel", choices=SPACES, default="world", help="all photons, or those alike; default world")
    parser.add_argument("--over-relaxation", metavar="FIRST[,LAST]", help=f"step length; {_BEST}")
    parser.add_argument("--limit", default="0.3", metavar="X", help="move per step over radius, or none; default 0.3")
    parser.add_argument(
        "--constraint-neighbors", type=int, metavar="K", help="of the descriptor, 12 to 998; default 50, split 150"
    )
    parser.add_argument(
        "--thresholds",
        metavar="A,B",
        help="values of the descriptor that leave a photon free and that fix it across; write --thresholds=A,B",
    )
    parser.add_argument("--diffuse-flux", action="store_true", help="let fluxes even out too; the total is kept")
    parser.add_argument(
        "--search", choices=SEARCHES, default="exact", help="of radii; default exact, carried is faster"
    )
    parser.add_argument(
        "--surface",
        choices=SURFACES,
        default="auto",
        help="default auto: photons return to the scene's surface; tangent: they stay in their tangent planes",
    )
    add_device_option(parser)


def _parse_number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ArgumentError(f"{name} must be a number, not {text!r}") from None


def _parse_numbers(name: str, text: str) -> tuple[float, ...]:
    return tuple(_parse_number(name, part) for part in text.split(","))


def _read_settings(arguments: argparse.Namespace) -> dict[str, Any]:
    """Turn the options into keywords of `PhotonMap.relax`; what was not given stays None."""
    beta, pace, thresholds = arguments.beta, arguments.over_relaxation, arguments.thresholds
    if pace is not None:
        pace = _parse_numbers("--over-relaxation", pace)
        pace = pace[0] if len(pace) == 1 else pace
    return {
        "steps": arguments.steps,
        "neighbors": arguments.neighbors,
        "constraint": arguments.constraint,
        "descriptor": arguments.descriptor,
        "beta": beta if beta in {None, "auto"} else _parse_number("--beta", beta),
        "repel": arguments.repel,
        "over_relaxation": pace,
        "limit": None if arguments.limit == "none" else _parse_number("--limit", arguments.limit),
        "constraint_neighbors": arguments.constraint_neighbors,
        "thresholds": None if thresholds is None else _parse_numbers("--thresholds", thresholds),
        "diffuse_flux": arguments.diffuse_flux,
        "search": arguments.search,
        "surface": arguments.surface,
    }


def _describe_settings(settings: dict[str, Any], surface: str, photons: int) -> list[str]:
    """Say in words what was used."""
    first, last = settings["over_relaxation"]
    free_at, fixed_at = settings["thresholds"]
    constraint = "none"
    if settings["descriptor"] != "none":
        constraint = (
            f"{settings['constraint']}, {settings['descriptor']} of {settings['constraint_neighbors']} neighbors, "
            f"free at {free_at:.3g}, fixed at {fixed_at:.3g}"
        )
    beta = f"β {settings['beta']:.4g}; " if settings["beta"] else ""
    limit = f"limit {settings['limit']:g}" if settings["limit"] else "no limit"
    flux = "; fluxes diffuse" if settings["diffuse_flux"] else ""
    return [
        f"{photons:,} photons, {settings['steps']} steps; pushed by {settings['neighbors']} neighbors "
        f"({settings['repel']}), over-relaxation {first:g} to {last:g}, {limit}, {settings['search']} search{flux}",
        f"constraint: {constraint}",
        f"{beta}moved on: {surface}",
    ]


def _format_steps(rows: list[dict[str, Any]]) -> list[str]:
    table = [["step", "tau", "mean move", "largest move", "mean pressure", "seconds"]]
    for row in rows:
        table.append(
            [
                str(row["step"]),
                f"{row['tau']:.3f}",
                *(f"{row[name]:.5f}" for name in ("mean_move", "largest_move", "mean_pressure")),
                f"{row['seconds']:.2f}",
            ]
        )
    return format_table(table)


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    check_map_path(arguments.output)
    settings = _read_settings(arguments)
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

    def write_lines() -> list[str]:
        return [
            *_format_steps(rows),
            *_describe_settings(report["settings"], report["surface"], len(photons)),
            f"{arguments.output}: seconds: "
            + ", ".join(f"{name} {spent:.2f}" for name, spent in watch.seconds.items()),
        ]

    print_result(arguments, result, write_lines)
    return EXIT_OK
