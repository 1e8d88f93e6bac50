# SPDX-License-Identifier: Apache-2.0
"""Measures what every script's parameter space, and every odd one, costs beside primal trajectory: a table.

Each figure: seconds, and their ratio to those of primal trajectory on the same map. What fails says why in its row.
"""

from __future__ import annotations

import argparse
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
from measure import format_seconds
from scene_data import SCENES, load_scene

import photonloupe as pl

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))

from odd_parameters import MAKERS, make_parameters

NAMES = ("ring", "prism")
COUNTS = (50_000, 200_000)
SCRIPTS = tuple(sorted(path.stem for path in (SCENES / "scripts").glob("*.photon")))
BASE = "primal_trajectory"
# Looks at the parameters that are there already, and leaves them.
READS_PARAMETERS = "isotropy"
QUERIES, K, BETA, STEPS = 2_000, 50, 3.0, 5
SECONDS = 600.0  # longest work
COMPILE_SECONDS = 20.0  # what takes longer is not waiting for a compiler

Work = Callable[[pl.PhotonMap, "Deadline"], object]


class Deadline:
    """A progress callback that stops the work when its time is over."""

    def __init__(self, seconds: float) -> None:
        self.seconds = seconds
        self.end = time.perf_counter() + seconds

    def __call__(self, _stage: str, _fraction: float) -> bool:
        """Whether to go on."""
        return time.perf_counter() < self.end

    @property
    def is_over(self) -> bool:
        """Whether the work was stopped."""
        return time.perf_counter() >= self.end


def find_beta(photons: pl.PhotonMap, deadline: Deadline) -> object:
    """β of [SJL15] section 5.2."""
    return pl.optimal_beta(photons, progress=deadline)


def find_layers(photons: pl.PhotonMap, deadline: Deadline) -> object:
    """Neighbors of some photons within their layers."""
    ids = np.random.default_rng(1).integers(0, len(photons), QUERIES)
    return photons.neighbors(ids, K, space="constrained", beta=BETA, progress=deadline)


def find_in_parameters(photons: pl.PhotonMap, deadline: Deadline) -> object:
    """Neighbors of the same photons in parameter space itself."""
    ids = np.random.default_rng(1).integers(0, len(photons), QUERIES)
    return photons.neighbors(ids, K, space="parameter", progress=deadline)


def relax(photons: pl.PhotonMap, deadline: Deadline) -> object:
    """Some held steps."""
    return photons.relax(steps=STEPS, constraint="parameter", descriptor="pca", beta=BETA, progress=deadline)


WORKS: dict[str, Work] = {
    "β": find_beta,
    f"{QUERIES:,} neighbors in layers": find_layers,
    f"{QUERIES:,} neighbors in parameter space": find_in_parameters,
    f"relax, {STEPS} steps": relax,
}


def set_space(photons: pl.PhotonMap, space: str) -> None:
    """Give a map the parameters of a script or of an odd space."""
    if space in MAKERS:
        make_parameters(space, photons).set_on(photons)
        return
    if space == READS_PARAMETERS:
        photons.run_script(SCENES / "scripts" / f"{BASE}.photon")
    photons.run_script(SCENES / "scripts" / f"{space}.photon", keep=space == READS_PARAMETERS)


def time_work(photons: pl.PhotonMap, work: Work, seconds: float) -> float | str:
    """Seconds of one work, or why it did not end well."""
    deadline = Deadline(seconds)
    photons.device.forget_results()
    start = time.perf_counter()
    try:
        work(photons, deadline)
    except Exception as error:
        spent = time.perf_counter() - start
        if deadline.is_over:
            return f"> {seconds:.0f} s"
        reason = str(error).splitlines()[0].replace("|", "/") if str(error) else type(error).__name__
        return f"{type(error).__name__} after {format_seconds(spent)}: {reason}"
    return time.perf_counter() - start


def time_warm(photons: pl.PhotonMap, work: Work, seconds: float) -> float | str:
    """Seconds of the second run where the first may have waited for the driver's compiler."""
    first = time_work(photons, work, seconds)
    if isinstance(first, str) or first > COMPILE_SECONDS:
        return first
    again = time_work(photons, work, seconds)
    return min(first, again) if isinstance(again, float) else again


def format_cell(found: float | str, base: float | str | None) -> str:
    """Seconds and their ratio to the base's."""
    if isinstance(found, str):
        return found
    ratio = f" (× {found / base:.1f})" if isinstance(base, float) else ""
    return format_seconds(found) + ratio


def measure_space(
    photons: pl.PhotonMap, space: str, label: str, base: dict[str, float | str], seconds: float
) -> dict[str, float | str]:
    """Print one row, cell by cell; return what was found."""
    print(f"| {label} | {space} | ", end="", flush=True)
    try:
        set_space(photons, space)
    except Exception as error:
        print(f"{type(error).__name__}: {str(error).splitlines()[0]} | — |" + " — |" * len(WORKS), flush=True)
        return {}
    columns = photons.parameters.shape[1] if "parameters" in photons.recorded else 0
    print(f"{columns} |", end="", flush=True)
    found: dict[str, float | str] = {}
    for name, work in WORKS.items():
        found[name] = time_warm(photons, work, seconds)
        print(f" {format_cell(found[name], base.get(name))} |", end="", flush=True)
    print(flush=True)
    return found


def measure(name: str, count: int, spaces: list[str], seconds: float) -> None:
    """All spaces on one map; primal trajectory, to compare with, comes first."""
    photons = pl.trace_photons(load_scene(name), count, seed=1)
    label = f"{name} | {len(photons):,}"
    set_space(photons, BASE)
    base = measure_space(photons, BASE, label, {}, seconds)
    for space in spaces:
        if space != BASE:
            measure_space(photons, space, label, base, seconds)


def main() -> None:
    """Print the table."""
    spaces = [*SCRIPTS, *MAKERS]
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, nargs="+", default=COUNTS, help="photons to trace; default: 50000 200000")
    parser.add_argument("--scene", choices=NAMES, nargs="+", default=NAMES, help="default: both")
    parser.add_argument("--only", choices=spaces, nargs="+", metavar="SPACE", help=f"of {', '.join(spaces)}")
    parser.add_argument("--limit", type=float, default=SECONDS, help=f"seconds for one figure ({SECONDS:.0f})")
    arguments = parser.parse_args()
    print(
        f"`optimal_beta`; neighbors k = {K} of {QUERIES:,} photons in layers, β = {BETA:g}; relaxation with descriptor "
        f"`pca`, constraint `parameter`, β = {BETA:g}. In parentheses the ratio to primal trajectory.\n\n"
        f"| scene | photons | space | columns | {' | '.join(WORKS)} |\n|{'---|' * (4 + len(WORKS))}",
        flush=True,
    )
    for name in arguments.scene:
        for count in arguments.count:
            measure(name, count, arguments.only or spaces, arguments.limit)


if __name__ == "__main__":
    main()
