# SPDX-License-Identifier: Apache-2.0
"""Measures what relaxation is worth on the ring's caustic: errors, and how many raw photons would do as well."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from measure import find_median
from photon_parameters import set_trajectory
from relax_methods import EMISSIONS, Method, list_methods
from ring_reference import CELL_SIDE, LINES, Errors, Reference, average_errors, estimate_cells, load_reference
from scene_data import load_scene

import photonloupe as pl

# METHODS section 7, figures of merit; one search answers all k of a part, and the next part may not be needed.
NEIGHBORS = ((6, 8, 11, 16, 23, 32, 45, 64), (91, 128, 181), (256, 362))
FIGURES = ("rmse", "mean_abs")
RAW_COUNTS = (50_000, 100_000, 200_000, 400_000, 800_000, 1_600_000)
# The first is relaxed in every way, the others in the main ones.
RELAXED_COUNTS = (50_000, 200_000)
SEEDS, FIRST_SEED = 2, 500

HEAD = (
    "| emission | photons | method | steps | RMSE (k) | mean abs (k) | smooth | edge | fold | band | "
    "raw photons for the same RMSE, mean abs | edge ≤ raw | relaxing |\n" + "|---" * 13 + "|"
)

# Makes the map of one seed, and says how long relaxing it took.
Build = Callable[[int], tuple[pl.PhotonMap, float]]


@dataclass
class Family:
    """Maps that differ in their seed only: their size, the errors by k (mean over seeds), seconds to relax (median)."""

    count: float
    errors: dict[int, Errors] = field(default_factory=dict)
    seconds: float = 0.0

    def find_best(self, figure: str) -> int:
        """Return the k at which a figure is least."""
        return min(self.errors, key=lambda k: getattr(self.errors[k], figure))

    def get_best(self, figure: str) -> float:
        """The figure at its best k."""
        return getattr(self.errors[self.find_best(figure)], figure)


def scan_neighbors(photons: pl.PhotonMap, reference: Reference) -> dict[int, Errors]:
    """Errors by k, until neither figure's least is at the largest k tried."""
    found: dict[int, Errors] = {}
    for ks in NEIGHBORS:
        cells = estimate_cells(photons, ks, reference)
        found.update({k: reference.measure(cells[k]) for k in ks})
        best = {min(found, key=lambda k: getattr(found[k], figure)) for figure in FIGURES}
        if max(best) < max(found):
            break
    return found


def measure_family(build: Build, reference: Reference, seeds: int) -> Family:
    """Build and estimate with every seed; what all of them tried counts."""
    scans: list[dict[int, Errors]] = []
    counts, seconds = [], []
    for number in range(seeds):
        photons, spent = build(FIRST_SEED + number)
        counts.append(len(photons))
        seconds.append(spent)
        scans.append(scan_neighbors(photons, reference))
    shared = [k for k in scans[0] if all(k in scan for scan in scans)]
    errors = {k: average_errors([scan[k] for scan in scans]) for k in shared}
    return Family(float(np.mean(counts)), errors, find_median(seconds))


def trace_once_reflected(count: int, emission: str, seed: int) -> tuple[pl.PhotonMap, float]:
    """Photons of signature 1, the order of light the reference holds: one bounce stores exactly those."""
    return pl.trace_photons(load_scene("ring"), count, seed=seed, emission=emission, max_bounces=1), 0.0


def trace_and_relax(method: Method, count: int, emission: str, seed: int) -> tuple[pl.PhotonMap, float]:
    """Trace, give parameters where they are asked for, relax."""
    photons, _ = trace_once_reflected(count, emission, seed)
    if method.keywords["constraint"] == "parameter":
        set_trajectory(photons)
    start = time.perf_counter()
    relaxed = photons.relax(steps=method.steps, **method.keywords)
    return relaxed, time.perf_counter() - start


def find_equal_count(raw: list[Family], figure: str, error: float) -> tuple[float, str]:
    """Raw photons for the same error, log-log between counts, and "<" or ">" where it lies outside of them."""
    counts = np.log([family.count for family in raw])
    errors = np.log(np.minimum.accumulate([family.get_best(figure) for family in raw]))
    sign = "> " if np.log(error) < errors[-1] else "< " if np.log(error) > errors[0] else ""
    return float(np.exp(np.interp(-np.log(error), -errors, counts))), sign


def format_ratios(raw: list[Family], relaxed: Family) -> str:
    """Equal-error photon ratios by either figure."""
    parts = []
    for figure in FIGURES:
        count, sign = find_equal_count(raw, figure, relaxed.get_best(figure))
        parts.append(f"{sign}{count / relaxed.count:.1f}×")
    return ", ".join(parts)


def format_family(family: Family) -> str:
    """Both errors at the best k of each; the rest at the first's."""
    by_square, by_size = (family.find_best(figure) for figure in FIGURES)
    at = family.errors[by_square]
    return (
        f"{at.rmse:.3f} ({by_square}) | {family.errors[by_size].mean_abs:.4f} ({by_size}) | {at.smooth:.3f} | "
        f"{at.edge:.3f} | {at.contrast:.2f} | {at.inner:.2f}"
    )


def print_row(emission: str, family: Family, method: Method | None, raw: list[Family]) -> None:
    """Show one line of the table as soon as it is known."""
    start = f"| {emission} | {family.count:,.0f} | "
    if method is None:
        print(f"{start}raw | — | {format_family(family)} | — | — | — |", flush=True)
        return
    beside = min(raw, key=lambda each: abs(each.count - family.count))
    edge, raw_edge = (each.errors[each.find_best("rmse")].edge for each in (family, beside))
    print(
        f"{start}{method.name} | {method.steps} | {format_family(family)} | {format_ratios(raw, family)} | "
        f"{'yes' if edge <= raw_edge else '**no**'} | {family.seconds:.1f} s |",
        flush=True,
    )


def describe(reference: Reference, seeds: int) -> str:
    """Say how the figures were taken."""
    return f"""\
The scene ring, light reflected once (signature 1), red channel, means over {seeds} seeds. Reference: the closed form
(METHODS section 8, 5) summed over {LINES:,} lines into 512² cells of {CELL_SIDE * 1e3:.1f} mm. Estimates: Epanechnikov
at the middles of the cells; a cell with more than k photons is counted, since the support is smaller than the cell.

- RMSE, mean abs: over all cells, in units of the reference's mean over the window ({reference.mean:.4f} W/m²), each at
  the k in parentheses where it is least. The next four at the first of these k:
- smooth: RMS of the relative error over lit cells more than 12 from every edge.
- edge: Σ|error| / Σ reference over cells within 3 of the caustic's curve or where the reference changes more than 3×
  in 5 cells.
- fold: contrast over the reference's on the line z = −0.48 m, |x| ≤ 0.08 m across the cusp.
- band: share of the inner band's contrast that survives: slope of the estimate against the reference, both less the
  mean of the 9² cells about, over the cells near the two arcs behind the fold where it steps by 1.2× to 1.8×.
- raw photons for the same RMSE, mean abs: how many times more raw photons of the same emission, at their best k,
  log-log between the raw rows; > and < beyond them.
- edge ≤ raw: against the raw row of the same size.
- relaxing: seconds, beside other work."""


def measure(seeds: int, counts: Sequence[int]) -> None:
    """Raw photons of every count, then every method, with both emissions."""
    reference = load_reference()
    print(f"{describe(reference, seeds)}\n\n{HEAD}", flush=True)
    raw: dict[str, list[Family]] = {emission: [] for emission in EMISSIONS}
    for emission, families in raw.items():
        for count in RAW_COUNTS:
            families.append(measure_family(partial(trace_once_reflected, count, emission), reference, seeds))
            print_row(emission, families[-1], None, families)
    for place, count in enumerate(counts):
        for emission, families in raw.items():
            for method in list_methods(emission):
                if place == 0 or method.is_main:
                    build = partial(trace_and_relax, method, count, emission)
                    print_row(emission, measure_family(build, reference, seeds), method, families)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS, help="maps to average over")
    parser.add_argument("--counts", type=int, nargs="+", default=RELAXED_COUNTS, help="photons to relax")
    given = parser.parse_args()
    measure(given.seeds, given.counts)
