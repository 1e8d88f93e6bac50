# SPDX-License-Identifier: Apache-2.0
"""Measures what the carried search of relaxation costs in error and gains in time, beside the exact one."""

from __future__ import annotations

import argparse
import time
from dataclasses import dataclass
from typing import Any

import numpy as np
from measure import find_median
from photon_parameters import set_trajectory
from relax_error import FIRST_SEED, trace_once_reflected
from relax_methods import EMISSIONS, Method, list_methods
from ring_reference import Errors, Reference, average_errors, estimate_cells, load_reference

import photonloupe as pl

SEARCHES = ("exact", "carried")
COUNT, SEEDS = 50_000, 2
# Near the best k of every relaxed map of 50,000 photons.
NEIGHBORS = 11
# Compiles the kernels and builds the tree.
WARM_STEPS = 1
# METHODS section 3: random points in the periodic unit square.
SQUARE_COUNT, SQUARE_STEPS, SQUARE_NEIGHBORS, SQUARE_SEEDS = 4_096, 20, 20, 10
SQUARE = (("K = 6, λ 2 to 1.2", 6, (2.0, 1.2)), ("K = 20, λ = 1", 20, (1.0, 1.0)))


@dataclass(frozen=True)
class Timed:
    """Errors of one relaxed map, and seconds to relax it."""

    errors: Errors
    seconds: float


def relax_timed(photons: pl.PhotonMap, method: Method, search: str) -> tuple[pl.PhotonMap, float]:
    """Relax a map and say how long it took."""
    start = time.perf_counter()
    relaxed = photons.relax(steps=method.steps, search=search, **method.keywords)
    return relaxed, time.perf_counter() - start


def compare_errors(method: Method, emission: str, reference: Reference, count: int) -> str:
    """One line of the table: errors with either search on the same maps, and the ratio of their seconds."""
    timed: dict[str, list[Timed]] = {search: [] for search in SEARCHES}
    for number in range(SEEDS):
        photons, _ = trace_once_reflected(count, emission, FIRST_SEED + number)
        if method.keywords["constraint"] == "parameter":
            set_trajectory(photons)
        for search in SEARCHES:
            photons.relax(steps=WARM_STEPS, search=search, **method.keywords)
            relaxed, seconds = relax_timed(photons, method, search)
            cells = estimate_cells(relaxed, [NEIGHBORS], reference)[NEIGHBORS]
            timed[search].append(Timed(reference.measure(cells), seconds))
    exact, carried = (average_errors([each.errors for each in timed[search]]) for search in SEARCHES)
    ratios = [a.seconds / b.seconds for a, b in zip(*timed.values(), strict=True)]
    columns = [
        f"{getattr(exact, name):.3f}, {getattr(carried, name):.3f}"
        for name in ("rmse", "mean_abs", "smooth", "edge", "inner")
    ]
    spent = [find_median([each.seconds for each in timed[search]]) for search in SEARCHES]
    columns += [f"{spent[0]:.2f}, {spent[1]:.2f}", f"{find_median(ratios):.2f} ({min(ratios):.2f}–{max(ratios):.2f})"]
    return f"| {emission} | {method.name} | {method.steps} | {' | '.join(columns)} |"


def find_variation(points: pl.PhotonMap) -> float:
    """Coefficient of variation of the estimate at a grid of points away from the border."""
    steps = np.linspace(0.15, 0.85, 64)
    x, z = np.meshgrid(steps, steps, indexing="ij")
    places = np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)
    values = points.irradiance(places, (0.0, 1.0, 0.0), k=SQUARE_NEIGHBORS)[:, 0]
    return float(values.std() / values.mean())


def compare_square(name: str, neighbors: int, over_relaxation: tuple[float, float]) -> str:
    """One line: noise of random points in the periodic square, before and after either search."""
    found: dict[str, list[float]] = {"before": [], **{search: [] for search in SEARCHES}}
    keywords: dict[str, Any] = {"constraint": "world", "descriptor": "none", "period": (1.0, 0.0, 1.0)}
    for seed in range(SQUARE_SEEDS):
        spots = np.random.default_rng(seed).random((SQUARE_COUNT, 3)) * [1, 0, 1]
        points = pl.PhotonMap.from_arrays(
            positions=spots, normals=[[0, 1, 0]] * SQUARE_COUNT, power=np.ones((SQUARE_COUNT, 3))
        )
        found["before"].append(find_variation(points))
        for search in SEARCHES:
            moved = points.relax(
                steps=SQUARE_STEPS, neighbors=neighbors, over_relaxation=over_relaxation, search=search, **keywords
            )
            found[search].append(find_variation(moved))
    return f"| {name} | {' | '.join(f'{np.mean(values):.4f}' for values in found.values())} |"


def measure(count: int) -> None:
    """Both tables."""
    reference = load_reference()
    print(
        f"Each cell: exact, carried; means of {SEEDS} maps of {count:,} photons, errors at k = {NEIGHBORS}; seconds: "
        "medians of exact and carried in turn.\n\n"
        "| emission | method | steps | RMSE | mean abs | smooth | edge | band | seconds | exact/carried |\n"
        "|---|---|---|---|---|---|---|---|---|---|"
    )
    for emission in EMISSIONS:
        for method in list_methods(emission):
            if method.is_main:
                print(compare_errors(method, emission, reference, count), flush=True)
    print(
        f"\nCoefficient of variation of the k = {SQUARE_NEIGHBORS} estimate, {SQUARE_COUNT:,} random points in the "
        f"periodic unit square, {SQUARE_STEPS} steps, limiter on, mean of {SQUARE_SEEDS} seeds.\n\n"
        "| repulsion | before | exact | carried |\n|---|---|---|---|"
    )
    for name, neighbors, over_relaxation in SQUARE:
        print(compare_square(name, neighbors, over_relaxation), flush=True)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--count", type=int, default=COUNT, help="photons to trace")
    measure(parser.parse_args().count)
