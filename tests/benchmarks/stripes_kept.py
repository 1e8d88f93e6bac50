# SPDX-License-Identifier: Apache-2.0
"""Measures what relaxation keeps of the stripes of `prism` and `lightguide` in several parameter spaces: README tables.

Each number is a contrast over the reference's (METHODS section 7), the mean over the seeds and in parentheses the least
and the greatest. `--reference` measures the references instead.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from scene_data import SCENES, load_scene

import photonloupe as pl

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))

from stripes import REFERENCE_PHOTONS, RELAXATION, Stripe, load_stripe

NAMES = ("prism", "lightguide")
COUNTS = (25_000, 50_000, 100_000)
EMISSIONS = ("random", "sobol")
REFERENCE_SEEDS = (98, 99)


def set_primal(photons: pl.PhotonMap) -> None:
    """Give a map its primal trajectory."""
    photons.run_script(SCENES / "scripts" / "primal_trajectory.photon")


def set_ppca(photons: pl.PhotonMap) -> None:
    """Give a map the first principal component of its paths."""
    photons.run_script(SCENES / "scripts" / "ppca.photon")


def set_nothing(photons: pl.PhotonMap) -> None:
    """Leave a map without parameters."""


SETTERS: dict[str, Callable[[pl.PhotonMap], None]] = {
    "—": set_nothing,
    "primal": set_primal,
    "ppca": set_ppca,
}

Way = tuple[str, dict[str, Any]]  # a key of SETTERS, and what differs from RELAXATION
MAIN: dict[str, Way | None] = {
    "raw": None,
    "no constraint": ("—", {"constraint": "world", "descriptor": "none"}),
    "world": ("—", {"constraint": "world"}),
    "primal trajectory": ("primal", {}),
    "PPCA": ("ppca", {}),
}
OTHERS: dict[str, dict[str, Any]] = {
    "as above": {},
    "K = 6, λ 2 to 1.2": {"neighbors": 6, "over_relaxation": (2.0, 1.2)},
    "5 steps": {"steps": 5},
    "β = 10": {"beta": 10.0},
    "β = auto": {"beta": "auto"},
    "repel parameter": {"repel": "parameter"},
    "tensor, β = 10": {"descriptor": "tensor", "beta": 10.0},
}


def trace(name: str, count: int, emission: str, seed: int) -> pl.PhotonMap:
    """Trace a new map."""
    return pl.trace_photons(load_scene(name), count, seed=seed, emission=emission)


def measure_way(stripe: Stripe, way: Way | None, count: int, emission: str, seed: int) -> float:
    """Share of the reference's contrast after one way of relaxing, or none."""
    photons = trace(stripe.name, count, emission, seed)
    if way is None:
        return stripe.measure_share(photons)
    parameters, changed = way
    SETTERS[parameters](photons)
    return stripe.measure_share(photons.relax(**{**RELAXATION, **changed}))


def describe(values: list[float]) -> str:
    """Mean (least–greatest)."""
    return f"{np.mean(values):.2f} ({min(values):.2f}–{max(values):.2f})"


def print_main(stripe: Stripe, seeds: range) -> None:
    """Print the ways by emission and photon count."""
    print(f"\n| emission | photons | {' | '.join(MAIN)} |\n|{'---|' * (2 + len(MAIN))}")
    for emission in EMISSIONS:
        for count in COUNTS:
            cells = [
                describe([measure_way(stripe, way, count, emission, seed) for seed in seeds]) for way in MAIN.values()
            ]
            print(f"| {emission} | {count:,} | {' | '.join(cells)} |", flush=True)


def print_others(stripe: Stripe, seeds: range) -> None:
    """Print other settings at the stripe's photon count."""
    print(f"\n| settings | {' | '.join(f'{e}: primal | {e}: PPCA' for e in EMISSIONS)} |\n|{'---|' * 5}")
    for label, changed in OTHERS.items():
        cells = [
            describe([measure_way(stripe, (parameters, changed), stripe.photons, emission, seed) for seed in seeds])
            for emission in EMISSIONS
            for parameters in ("primal", "ppca")
        ]
        print(f"| {label} | {' | '.join(cells)} |", flush=True)


def print_beta(stripe: Stripe) -> None:
    """Print β after [SJL15] section 5.2 for both spaces, first seed."""
    for emission in EMISSIONS:
        for parameters in ("primal", "ppca"):
            photons = trace(stripe.name, stripe.photons, emission, 1)
            SETTERS[parameters](photons)
            beta = pl.optimal_beta(photons)
            print(f"{emission}, {parameters}: t_β {beta.t_beta:.4f}, β {float(beta):.2f}", flush=True)


def main() -> None:
    """Print the tables of the scenes named, of both by default."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="SCENE", help="prism, lightguide; default: both")
    parser.add_argument("--seeds", type=int, default=3, help="maps per number (3)")
    parser.add_argument("--reference", action="store_true", help="count very many photons in the line's intervals")
    arguments = parser.parse_args()
    for name in arguments.names or NAMES:
        stripe = load_stripe(name)
        print(f"\n{name}")
        if arguments.reference:
            for seed in REFERENCE_SEEDS:
                print(f"{stripe.count_contrast(trace(name, REFERENCE_PHOTONS, 'sobol', seed)):.4f}", flush=True)
            continue
        seeds = range(1, arguments.seeds + 1)
        print_main(stripe, seeds)
        print_others(stripe, seeds)
        print_beta(stripe)


if __name__ == "__main__":
    main()
