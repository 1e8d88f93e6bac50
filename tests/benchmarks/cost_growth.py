# SPDX-License-Identifier: Apache-2.0
"""Measures how seconds and memory grow with the number of photons of the ring, stage by stage: table and plot.

Every figure is taken in a process of its own, so that its peak is its own.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np
from measure import find_median, format_seconds
from scene_data import RING, SCENES, UP, trace_ring_map

import photonloupe as pl
from photonloupe.device import open_device

COUNTS, LARGE = (10_000, 100_000, 1_000_000), 10_000_000
WARM_COUNT = 2_000  # compiles the kernels
QUERIES, K = 100_000, 50
ROUNDS = 3
MINUTES = 60  # for one figure

# Prepares a map and returns the work to time; what it returns is its seconds, None: all of it counts.
Stage = Callable[[pl.PhotonMap], Callable[[], float | None]]


@dataclass(frozen=True)
class Figure:
    """Seconds of the work, and resident memory in MiB: before it, with the map there, and at its peak."""

    seconds: float
    before: float
    peak: float


def copy_map(photons: pl.PhotonMap) -> pl.PhotonMap:
    """The same photons without a tree."""
    return pl.PhotonMap.from_arrays(positions=photons.positions, normals=photons.normals, power=photons.power)


def time_first_query(photons: pl.PhotonMap) -> float:
    """Seconds of a fresh map and its first query less those of the next query: upload and tree."""
    start = time.perf_counter()
    fresh = copy_map(photons)
    fresh.neighbors([0], 1)
    begin = time.perf_counter()
    fresh.neighbors([0], 1)
    return begin - start - (time.perf_counter() - begin)


def prepare_tree(photons: pl.PhotonMap) -> Callable[[], float | None]:
    """Upload the columns and build the kd-tree."""
    return partial(time_first_query, photons)


def prepare_neighbors(photons: pl.PhotonMap) -> Callable[[], float | None]:
    """Nearest neighbors of random photons."""
    photons.neighbors([0], 1)
    ids = np.random.default_rng(1).integers(0, len(photons), QUERIES)

    def run() -> None:
        photons.neighbors(ids, K)

    return run


def prepare_script(photons: pl.PhotonMap) -> Callable[[], float | None]:
    """Tortuosity of every photon, its paths recorded beforehand."""
    script = SCENES / "scripts" / "tortuosity.photon"
    photons.run_script(script)

    def run() -> None:
        photons.run_script(script)

    return run


def prepare_relaxation(photons: pl.PhotonMap) -> Callable[[], float | None]:
    """One free step of all photons."""
    relaxation = pl.Relaxation(photons, steps=2 * ROUNDS, neighbors=K, constraint="world", descriptor="none")
    relaxation.step()

    def run() -> None:
        relaxation.step()

    return run


def prepare_irradiance(photons: pl.PhotonMap) -> Callable[[], float | None]:
    """Irradiance at random points of the ring's window."""
    photons.neighbors([0], 1)
    half = RING.window_half
    points = np.random.default_rng(2).uniform(-half, half, (QUERIES, 3)) * [1.0, 0.0, 1.0]

    def run() -> None:
        photons.irradiance(points, UP, k=K)

    return run


STAGES: dict[str, tuple[str, Stage]] = {
    "tree": ("tree, build and upload", prepare_tree),
    "neighbors": (f"{QUERIES:,} neighbor queries, k = {K}", prepare_neighbors),
    "script": ("script `tortuosity`", prepare_script),
    "relax": (f"relaxation step, K = {K}", prepare_relaxation),
    "irradiance": (f"irradiance at {QUERIES:,} points, k = {K}", prepare_irradiance),
}


def read_resident() -> float:
    """Resident memory of this process now, MiB."""
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 2**20


def clear_peak() -> bool:
    """Forget the greatest memory so far, that of tracing; False where the system does not offer that."""
    try:
        Path("/proc/self/clear_refs").write_text("5")
    except OSError:
        return False
    return True


def read_peak() -> float:
    """Greatest resident memory since the peak was cleared, MiB."""
    for line in Path("/proc/self/status").read_text().splitlines():
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) / 2**10
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**10


def measure_here(stage: str, count: int) -> Figure:
    """One figure in this process: the median of the rounds."""
    prepare = STAGES[stage][1]
    prepare(trace_ring_map(WARM_COUNT))()
    work = prepare(trace_ring_map(count))
    before = read_resident()
    clear_peak()
    seconds = []
    for _ in range(ROUNDS):
        open_device().forget_results()
        start = time.perf_counter()
        told = work()
        seconds.append(time.perf_counter() - start if told is None else told)
    return Figure(find_median(seconds), before, read_peak())


def measure(stage: str, count: int) -> Figure | str:
    """One figure in a process of its own, or why there is none."""
    command = [sys.executable, __file__, "--child", stage, str(count)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=60 * MINUTES, check=False)
    except subprocess.TimeoutExpired:
        return f"not done after {MINUTES} minutes"
    if done.returncode != 0:
        lines = done.stderr.strip().splitlines()
        return lines[-1] if lines else f"ended with {done.returncode}"
    return Figure(**json.loads(done.stdout.splitlines()[-1]))


def format_row(stage: str, count: int, figure: Figure | str, before: Figure | str | None) -> str:
    """One line of the table."""
    work = STAGES[stage][0]
    if isinstance(figure, str):
        return f"| {work} | {count:,} | {figure} | — | — | — | — |"
    grown = ("—", "—")
    if isinstance(before, Figure):
        grown = (f"× {figure.seconds / before.seconds:.1f}", f"× {figure.peak / before.peak:.1f}")
    return (
        f"| {work} | {count:,} | {format_seconds(figure.seconds)} | {grown[0]} | {figure.before:,.0f} MiB | "
        f"{figure.peak:,.0f} MiB | {grown[1]} |"
    )


def draw_plot(path: Path, figures: dict[str, dict[int, Figure]]) -> None:
    """Seconds and peaks over the number of photons, both axes logarithmic; the dashed lines grow as the photons do."""
    import matplotlib as mpl  # noqa: PLC0415 - the extra `bench`

    mpl.use("Agg")
    from matplotlib import pyplot as plt  # noqa: PLC0415

    figure, axes = plt.subplots(1, 2, figsize=(11, 4.5), constrained_layout=True)
    for axis, name, label in zip(axes, ("seconds", "peak"), ("seconds", "peak resident memory, MiB"), strict=True):
        for stage, row in figures.items():
            values = [getattr(each, name) for each in row.values()]
            axis.loglog(list(row), values, "o-", label=STAGES[stage][0])
            if name == "seconds" and row:
                first = next(iter(row))
                axis.loglog(list(row), [values[0] * count / first for count in row], "k--", linewidth=0.5)
        axis.set_xlabel("photons")
        axis.set_ylabel(label)
        axis.grid(visible=True, which="both", alpha=0.25)
    axes[0].legend(fontsize="small")
    figure.savefig(path, dpi=110)


def main() -> None:
    """Print the table as it grows, then draw it."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--large", action="store_true", help=f"also {LARGE:,} photons")
    parser.add_argument("--only", choices=STAGES, nargs="+", metavar="STAGE", help=f"of {', '.join(STAGES)}")
    parser.add_argument("--plot", type=Path, metavar="FILE", help="a PNG to draw; needs matplotlib, extra `bench`")
    parser.add_argument("--child", nargs=2, metavar=("STAGE", "COUNT"), help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child:
        figure = measure_here(arguments.child[0], int(arguments.child[1]))
        print(json.dumps(figure.__dict__))
        return
    print(
        f"Photons of the ring, random emission; median of {ROUNDS} rounds, kernels compiled beforehand. Memory is that "
        "of the whole process, with the map there and at its peak during the work.\n\n"
        "| work | photons | seconds | per 10 × | before | peak | per 10 × |\n|---|---|---|---|---|---|---|",
        flush=True,
    )
    figures: dict[str, dict[int, Figure]] = {}
    for stage in arguments.only or STAGES:
        figures[stage] = {}
        last: Figure | str | None = None
        for count in (*COUNTS, LARGE) if arguments.large else COUNTS:
            figure = measure(stage, count)
            print(format_row(stage, count, figure, last), flush=True)
            if isinstance(figure, Figure):
                figures[stage][count] = figure
            last = figure
    if arguments.plot:
        draw_plot(arguments.plot, figures)


if __name__ == "__main__":
    main()
