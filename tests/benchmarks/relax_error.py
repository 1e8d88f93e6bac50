# SPDX-License-Identifier: Apache-2.0
"""Measures what relaxation is worth on the ring's caustic: errors, and how many raw photons would do as well."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np
from measure import Row, Subject, find_median, format_seconds, print_subject
from photon_parameters import set_trajectory
from relax_methods import METHODS, VARIANTS, Method
from ring_reference import CELL_SIDE, LINES, Errors, Reference, average_errors, estimate_cells, load_reference
from scene_data import load_scene

import photonloupe as pl

NEIGHBORS = (6, 8, 11, 16, 23, 32, 45, 64, 91, 128, 181, 256, 362)  # METHODS section 7, figures of merit
EMISSIONS = ("random", "sobol")
RAW_COUNTS = (50_000, 100_000, 200_000, 400_000, 800_000, 1_600_000)
RELAXED_COUNT = 100_000
SEEDS, FIRST_SEED = 5, 500
# Once both errors stand so far above their least, a larger k need not be tried.
PAST_LEAST = 1.25

# Makes the map of one seed.
Build = Callable[[int], pl.PhotonMap]


@dataclass
class Family:
    """Maps that differ in their seed only: their size, and by k the errors (mean) and whole seconds (median)."""

    count: float
    errors: dict[int, Errors] = field(default_factory=dict)
    seconds: dict[int, float] = field(default_factory=dict)

    def find_best(self, figure: str) -> int:
        """Return the k at which a figure is least."""
        return min(self.errors, key=lambda k: getattr(self.errors[k], figure))

    def get_best(self, figure: str) -> float:
        """The figure at its best k."""
        return getattr(self.errors[self.find_best(figure)], figure)

    def __str__(self) -> str:
        """Both errors at the best k of each; the rest at the first's."""
        by_square, by_size = self.find_best("rmse"), self.find_best("mean_abs")
        at = self.errors[by_square]
        return (
            f"{at.rmse:.3f}, {self.errors[by_size].mean_abs:.4f} (k = {by_square}, {by_size}); "
            f"smooth {at.smooth:.3f}, edge {at.edge:.3f}, band {at.contrast:.2f}; {format_seconds(self.get_seconds())}"
        )

    def get_seconds(self) -> float:
        """From the scene to irradiance, at the best k."""
        return self.seconds[self.find_best("rmse")]


@dataclass(frozen=True)
class Study:
    """What all families are held against, how they are estimated, over how many seeds."""

    reference: Reference
    seeds: int = SEEDS
    bare: bool = False


def scan_neighbors(photons: pl.PhotonMap, study: Study, ks: Sequence[int]) -> dict[int, tuple[Errors, float]]:
    """Errors and seconds of the estimate for ascending k, until both errors only grow."""
    found: dict[int, tuple[Errors, float]] = {}
    for k in ks:
        start = time.perf_counter()
        cells = estimate_cells(photons, k, study.reference, bare=study.bare)
        found[k] = (study.reference.measure(cells), time.perf_counter() - start)
        figures = np.array([(errors.rmse, errors.mean_abs) for errors, _ in found.values()])
        if np.all(figures[-1] > PAST_LEAST * figures.min(axis=0)):
            break
    return found


def list_candidates(found: dict[int, tuple[Errors, float]]) -> list[int]:
    """The best k of either error on the first seed and its neighbors: the mean's best is among them."""
    ks = list(found)
    figures = np.array([(errors.rmse, errors.mean_abs) for errors, _ in found.values()])
    best = figures.argmin(axis=0)
    return [k for place, k in enumerate(ks) if np.abs(best - place).min() <= 1]


def measure_family(build: Build, study: Study) -> Family:
    """Build and estimate with every seed: all k on the first, then those that can be best."""
    scans, builds, counts = [], [], []
    for number in range(study.seeds):
        start = time.perf_counter()
        photons = build(FIRST_SEED + number)
        photons.neighbors([0], 1)  # the tree belongs to the map's cost, not to the first k's
        builds.append(time.perf_counter() - start)
        counts.append(len(photons))
        scans.append(scan_neighbors(photons, study, list_candidates(scans[0]) if scans else NEIGHBORS))
    shared = [k for k in scans[0] if all(k in scan for scan in scans)]
    return Family(
        float(np.mean(counts)),
        {k: average_errors([scan[k][0] for scan in scans]) for k in shared},
        {k: find_median(builds) + find_median([scan[k][1] for scan in scans]) for k in shared},
    )


def trace_once_reflected(count: int, emission: str, seed: int) -> pl.PhotonMap:
    """Photons of signature 1, the order of light the reference holds: one bounce stores exactly those."""
    return pl.trace_photons(load_scene("ring"), count, seed=seed, emission=emission, max_bounces=1)


def trace_and_relax(method: Method, emission: str, seed: int) -> pl.PhotonMap:
    """Trace, give parameters where they are asked for, relax."""
    photons = trace_once_reflected(RELAXED_COUNT, emission, seed)
    if method.keywords["constraint"] == "parameter":
        set_trajectory(photons)
    return photons.relax(steps=method.steps[emission], **method.keywords)


def find_equal_count(raw: list[Family], figure: str, error: float) -> tuple[float, str]:
    """Raw photons for the same error, log-log between counts, and "<" or ">" where it lies outside of them."""
    counts = np.log([family.count for family in raw])
    errors = np.log(np.minimum.accumulate([family.get_best(figure) for family in raw]))
    sign = ">" if np.log(error) < errors[-1] else "<" if np.log(error) > errors[0] else ""
    return float(np.exp(np.interp(-np.log(error), -errors, counts))), sign


def format_ratios(raw: list[Family], relaxed: Family) -> str:
    """Equal-error photon ratios by either error, and the equal-error time ratio by the first."""
    parts = []
    for figure in ("rmse", "mean_abs"):
        count, sign = find_equal_count(raw, figure, relaxed.get_best(figure))
        parts.append(f"{sign}{count / relaxed.count:.1f}")
    count, sign = find_equal_count(raw, "rmse", relaxed.get_best("rmse"))
    seconds = np.exp(
        np.interp(
            np.log(count), np.log([family.count for family in raw]), np.log([family.get_seconds() for family in raw])
        )
    )
    return f"{', '.join(parts)}; time {sign}{seconds / relaxed.get_seconds():.1f}"


def add_relaxed(subject: Subject, study: Study, raw: list[Family], method: Method, emission: str) -> None:
    """Row of one method, beside raw photons of the same number."""
    family = measure_family(partial(trace_and_relax, method, emission), study)
    beside = min(raw, key=lambda each: abs(each.count - family.count))
    edge, raw_edge = (each.errors[each.find_best("rmse")].edge for each in (family, beside))
    is_constrained = method.keywords["descriptor"] != "none"
    subject.rows.append(
        Row(
            f"{method.name}; {emission}, {method.steps[emission]} steps",
            f"raw, {beside.count:,.0f} photons",
            str(beside),
            str(family),
            format_ratios(raw, family),
            "edge no worse than raw" if is_constrained else "—",
            edge <= raw_edge if is_constrained else None,
        )
    )
    print(f"  {subject.rows[-1].work}: {family}", flush=True)


def describe(study: Study) -> list[str]:
    """Say how the figures were taken."""
    counting = (
        "no cell is counted"
        if study.bare
        else "a cell with more than k photons is counted, since the support is smaller than the cell; with 2² points a "
        "cell the figures at the best k differ by less than a tenth"
    )
    return [
        f"The scene ring, light reflected once (signature 1), red channel, {study.seeds} seeds. Reference: the closed "
        f"form (METHODS §8.5) summed over {LINES:,} lines into 512² cells of {CELL_SIDE * 1e3:.1f} mm; 10⁸ binned "
        "Sobol paths differ from it by their own noise. Estimates: Epanechnikov at the middles of the cells; "
        f"{counting}.",
        f"Figures: RMSE, mean absolute error over all cells in units of the window's mean ({study.reference.mean:.4f} "
        "W/m²), each at its best k (METHODS section 7 states them in units of its densities, whose means are 0.25 and "
        "0.11: divide its figures by those). Then, at the first's k: smooth, RMS of the relative error over lit cells "
        "more than 12 from every edge; edge, Σ|error| / Σ reference over cells within 3 of the caustic's curve or "
        "where the reference changes more than 3× in 5 cells; band, contrast over the reference's on the line "
        "z = −0.48 m, |x| ≤ 0.08 m across the cusp, whose two folds enclose the light that has crossed itself; seconds "
        "from the scene to irradiance.",
        "Ratio: how many times more raw photons, same emission, at their best k, have the same RMSE, mean absolute "
        "error, log-log between the raw counts; then how much longer raw photons take to the same RMSE.",
    ]


def measure(*, seeds: int = SEEDS, variants: bool = False, relaxed: bool = True, bare: bool = False) -> Subject:
    """Raw photons of every count, then every method, with both emissions."""
    study = Study(load_reference(), seeds, bare)
    subject = Subject("Relaxation on the ring, errors", notes=describe(study))
    for emission in EMISSIONS:
        raw = []
        for count in RAW_COUNTS:
            family = measure_family(partial(trace_once_reflected, count, emission), study)
            raw.append(family)
            subject.rows.append(Row(f"raw; {emission}, {family.count:,.0f} photons", "—", "—", str(family)))
            print(f"  {subject.rows[-1].work}: {family}", flush=True)
        for method in (*METHODS, *(VARIANTS if variants else ())) if relaxed else ():
            if emission in method.steps:
                add_relaxed(subject, study, raw, method, emission)
    return subject


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=SEEDS, help="maps to average over")
    parser.add_argument("--variants", action="store_true", help="more settings than METHODS section 7 tabulates")
    parser.add_argument("--raw", action="store_true", help="raw photons only")
    parser.add_argument("--bare", action="store_true", help="count no crowded cells")
    given = parser.parse_args()
    print_subject(measure(seeds=given.seeds, variants=given.variants, relaxed=not given.raw, bare=given.bare))
