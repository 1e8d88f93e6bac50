# SPDX-License-Identifier: Apache-2.0
"""``photonloupe relax``: move the photons of a saved map apart, and write the relaxed map."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Sequence
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
from photonloupe.relax_settings import (
    DEFAULT_CONSTRAINT_NEIGHBORS,
    DEFAULT_STEPS,
    DEFAULTS,
    DESCRIPTORS,
    FEWEST_CONSTRAINT_NEIGHBORS,
    MAX_NEIGHBORS,
    SEARCHES,
    SPACES,
    SURFACES,
    AllRelaxKeywords,
)
from photonloupe.storage import check_map_path

SUMMARY = "relax the photons of a saved map, as far as their constraints allow"
DESCRIPTION = (
    "Move photons apart until the noise is gone while edges stay (docs/relaxation.md). What nothing is said of is the "
    "best known for the map."
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("map", metavar="MAP", help="the .zarr folder to read")
    parser.add_argument("-o", "--output", required=True, metavar="MAP2", help="the .zarr folder to write")
    _add_relax_options(parser)
    add_device_option(parser)


def _add_relax_options(parser: argparse.ArgumentParser) -> None:
    """Add an option for each keyword of `PhotonMap.relax`; one that is not given leaves the keyword out."""

    def add(name: str, what: str, **how: Any) -> None:
        default = f"; default {_describe_default(name)}" if name in DEFAULTS and "action" not in how else ""
        parser.add_argument("--" + name.replace("_", "-"), default=argparse.SUPPRESS, help=what + default, **how)

    steps = ", ".join(f"{count} for {emission} emission" for emission, count in DEFAULT_STEPS.items())
    add("steps", f"0 measures the constraint only; default {steps}", type=int, metavar="S")
    add("neighbors", f"that push a photon, 1 to {MAX_NEIGHBORS}", type=int, metavar="K")
    add(
        "constraint",
        "which photons say where one may go; auto: parameter where the map has parameters, else world",
        choices=("auto", *SPACES),
    )
    add("descriptor", "what finds edges", choices=DESCRIPTORS)
    add("beta", "reach of layers in parameter space, a number or auto", metavar="X")
    add("repel", "all photons, or those alike", choices=SPACES)
    add("over_relaxation", "step length", metavar="FIRST[,LAST]")
    add("limit", "move per step over radius, or none", metavar="X")
    counts = ", ".join(f"{name} {count}" for name, count in DEFAULT_CONSTRAINT_NEIGHBORS.items() if name != "none")
    add(
        "constraint_neighbors",
        f"of the descriptor, {FEWEST_CONSTRAINT_NEIGHBORS} to {MAX_NEIGHBORS}; default {counts}",
        type=int,
        metavar="K",
    )
    add(
        "thresholds",
        "values of the descriptor that leave a photon free and that fix it across; write --thresholds=A,B; "
        "default the descriptor's own",
        metavar="A,B",
    )
    add("diffuse_flux", "let fluxes even out too; the total is kept", action="store_true")
    add("search", "of radii; carried is faster", choices=SEARCHES)
    add(
        "surface",
        "auto: photons return to the scene's surface; tangent: they stay in their tangent planes",
        choices=SURFACES,
    )
    add("period", "after how many m space repeats along x, y and z, 0 where it does not", metavar="X,Y,Z")


def _describe_default(name: str) -> str:
    value = DEFAULTS[name]
    if isinstance(value, tuple):
        return _join(value)
    return f"{value:g}" if isinstance(value, float) else str(value)


def _join(numbers: Sequence[float]) -> str:
    return ",".join(f"{number:g}" for number in numbers)


def _parse_number(name: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ArgumentError(f"{name} must be a number, not {text!r}") from None


def _parse_numbers(name: str, text: str) -> tuple[float, ...]:
    return tuple(_parse_number(name, part) for part in text.split(","))


def _parse_one_or_more(name: str, text: str) -> float | tuple[float, ...]:
    numbers = _parse_numbers(name, text)
    return numbers[0] if len(numbers) == 1 else numbers


# How the text of an option becomes its keyword, where argparse does not say.
_PARSERS: dict[str, Callable[[str, str], Any]] = {
    "beta": lambda name, text: text if text == "auto" else _parse_number(name, text),
    "over_relaxation": _parse_one_or_more,
    "limit": lambda name, text: None if text == "none" else _parse_number(name, text),
    "thresholds": _parse_numbers,
    "period": _parse_numbers,
}


def _read_settings(arguments: argparse.Namespace) -> dict[str, Any]:
    """Turn the options that were given into keywords of `PhotonMap.relax`."""
    given = {name: value for name, value in vars(arguments).items() if name in AllRelaxKeywords.__annotations__}
    for name, parse in _PARSERS.items():
        if name in given:
            given[name] = parse("--" + name.replace("_", "-"), given[name])
    return given


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
    period = f"; space repeats after {_join(settings['period'])} m" if any(settings["period"]) else ""
    limit = f"limit {settings['limit']:g}" if settings["limit"] else "no limit"
    flux = "; fluxes diffuse" if settings["diffuse_flux"] else ""
    return [
        f"{photons:,} photons, {settings['steps']} steps; pushed by {settings['neighbors']} neighbors "
        f"({settings['repel']}), over-relaxation {first:g} to {last:g}, {limit}, {settings['search']} search{flux}",
        f"constraint: {constraint}",
        f"{beta}moved on: {surface}{period}",
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
