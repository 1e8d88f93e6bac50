# SPDX-License-Identifier: Apache-2.0
"""``photonloupe script``: check a photon script; with a map, run it."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

import photonloupe as pl
from photonloupe.cli.common import (
    EXIT_BAD_INPUT,
    EXIT_OK,
    Stopwatch,
    add_device_option,
    choose_progress,
    format_table,
    print_result,
)
from photonloupe.device import open_device
from photonloupe.errors import ArgumentError
from photonloupe.scripting import LIMITS
from photonloupe.storage import check_map_path

SUMMARY = "check a photon script; with a map, run it"
DESCRIPTION = (
    "Check a script (docs/script.md) and say what is wrong; with a map, run it over the photons and print the report. "
    "Without a map no device is needed."
)

# Limits of a run: how each is read, and what it limits.
_LIMITS: dict[str, tuple[Callable[[str], float], str]] = {
    "fuel": (int, "steps of loops without a known end a photon may take"),
    "exhausted": (int, "photons that may run out of them before a pass stops"),
    "seconds": (float, "seconds a pass may take"),
}
_BAR_WIDTH = 40  # characters of the fullest bin


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("file", metavar="FILE", help="the script, .photon")
    parser.add_argument("map", metavar="MAP", nargs="?", help="the .zarr folder to run it over")
    parser.add_argument("-o", "--output", metavar="MAP2", help="write the map with its parameters and colors")
    parser.add_argument("--glsl", action="store_true", help="print the generated compute passes")
    add_value_options(parser)
    parser.add_argument("--keep", action="store_true", help="keep parameters and colors the script does not set")
    parser.add_argument("--seed", type=int, default=1, metavar="N", help="of random(); default 1")
    for name, (convert, what) in _LIMITS.items():
        metavar = "N" if convert is int else "X"
        parser.add_argument(f"--{name}", type=convert, metavar=metavar, help=f"{what}; default {LIMITS[name]:,}")
    add_device_option(parser)


def add_value_options(parser: argparse.ArgumentParser) -> None:
    """Add ``--set``."""
    parser.add_argument(
        "--set", action="append", default=[], metavar="NAME=V", help="value of an exposed variable; may be repeated"
    )


def parse_values(given: list[str]) -> dict[str, float]:
    """Turn ``NAME=V`` into values by name.

    Raises
    ------
    ArgumentError
        If one is not a name and a number.
    """
    values: dict[str, float] = {}
    for text in given:
        name, equals, number = text.partition("=")
        try:
            values[name.strip()] = float(number)
        except ValueError:
            raise ArgumentError(f"--set takes NAME=V with a number, not {text!r}") from None
        if not equals or not name.strip():
            raise ArgumentError(f"--set takes NAME=V, not {text!r}")
    return values


def _describe(script: pl.Script) -> dict[str, Any]:
    return {
        "script": script.name,
        "hash": script.hash,
        "diagnostics": [asdict(diagnostic) for diagnostic in script.diagnostics],
        "exposed": [asdict(variable) for variable in script.exposed],
        "columns": script.columns,
        "passes": [] if script.has_errors else script.passes,
    }


def _format_passes(script: pl.Script) -> list[str]:
    lines = []
    for number, row in enumerate(script.passes, 1):
        what = f"pass {number}, line {row['line']}: {row['kind']}"
        lines.append("; ".join([what, *row["reasons"]]))
    return lines


def _format_histogram(name: str, histogram: pl.Histogram) -> list[str]:
    most = max(int(histogram.counts.max(initial=0)), 1)
    lines = [f"{name}: {int(histogram.counts.sum()):,} values"]
    for i, count in enumerate(histogram.counts):
        bar = "#" * round(_BAR_WIDTH * int(count) / most)
        lines.append(f"  {histogram.edges[i]:>10.4g} … {histogram.edges[i + 1]:<10.4g} {int(count):>9,} {bar}".rstrip())
    beyond = (("below", histogram.below), ("above", histogram.above), ("not finite", histogram.non_finite))
    lines += [f"  {what}: {count:,}" for what, count in beyond if count]
    return lines


def _format_parameters(run: pl.ScriptRun) -> list[str]:
    if not run.parameter_names:
        return []
    rows = [["parameter", "declared", "least", "greatest", "unset"]]
    for i, name in enumerate(run.parameter_names):
        values = run.parameters[:, i]
        is_set = ~np.isnan(values)
        low, high = run.parameter_bounds[i]
        span = [f"{values[is_set].min():.5g}", f"{values[is_set].max():.5g}"] if is_set.any() else ["—", "—"]
        rows.append([name, f"{low:g} to {high:g}", *span, f"{int((~is_set).sum()):,}"])
    return format_table(rows)


def format_report(report: dict[str, Any]) -> list[str]:
    """Say what a run met, pass by pass and place by place."""
    lines = []
    for number, row in enumerate(report["passes"], 1):
        lines.append(f"pass {number}, line {row['line']}: {row['kind']}, {row['milliseconds']:.1f} ms")
        if row["exhausted"]:
            lines.append(
                f"  {row['exhausted']:,} photons ran out of steps at line {row['exhausted_line']}, first photon "
                f"{row['first_exhausted']}"
            )
        if row["stopped"]:
            lines.append(f"  stopped: {row['stopped']}")
    for fault in report["faults"]:
        place = "" if fault["first_photon"] is None else f", first photon {fault['first_photon']}"
        lines.append(f"line {fault['line']}, column {fault['column']}: {fault['what']} ({fault['count']:,}×{place})")
    return lines


def _list_run(run: pl.ScriptRun) -> dict[str, Any]:
    return {
        "parameters": list(run.parameter_names),
        "bounds": run.parameter_bounds,
        "exposed_values": run.exposed,
        "histograms": {name: asdict(histogram) for name, histogram in run.histograms.items()},
        "prints": run.prints,
        "report": run.report,
    }


def _check(arguments: argparse.Namespace, script: pl.Script) -> int:
    result = _describe(script)
    if arguments.glsl and not script.has_errors:
        result["glsl"] = script.glsl()
    lines = [] if script.has_errors else [*result.get("glsl", [repr(script), *_format_passes(script)])]
    if lines or arguments.json:
        print_result(arguments, result, lines)
    return EXIT_BAD_INPUT if script.has_errors else EXIT_OK


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    values = parse_values(arguments.set)
    script = pl.compile_script(Path(arguments.file))
    if arguments.map is None and arguments.output:
        raise ArgumentError("-o writes a map, but no MAP was given to run the script over")
    if not arguments.json:
        for diagnostic in script.diagnostics:
            print(diagnostic, file=sys.stderr)
    if arguments.map is None or script.has_errors:
        return _check(arguments, script)
    if arguments.output:
        check_map_path(arguments.output)
    watch = Stopwatch()
    with watch.measure("device"):
        device = open_device(arguments.device)
    with watch.measure("load"):
        photons = pl.load_photons(arguments.map, device=device)
    limits = {name: getattr(arguments, name) for name in _LIMITS if getattr(arguments, name) is not None}
    with watch.measure("script"):
        ran = photons.run_script(
            script,
            values=values,
            keep=arguments.keep,
            seed=arguments.seed,
            limits=limits,
            progress=choose_progress(),
        )
    if arguments.output:
        with watch.measure("save"):
            photons.save(arguments.output)
    result = {**_describe(script), **_list_run(ran), "output": arguments.output, "seconds": watch.seconds}
    if arguments.glsl:
        result["glsl"] = script.glsl()
    lines = [*(script.glsl() if arguments.glsl else []), *ran.prints]
    lines += [line for name, histogram in ran.histograms.items() for line in _format_histogram(name, histogram)]
    lines += [*_format_parameters(ran), *format_report(ran.report)]
    lines.append(f"{script.name}: {len(photons):,} photons; seconds: {watch.format()}")
    print_result(arguments, result, lines)
    return EXIT_OK
