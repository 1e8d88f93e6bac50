# SPDX-License-Identifier: Apache-2.0
"""Times irradiance at 512² points of the ring's floor, against SciPy's tree and a NumPy Epanechnikov estimate."""

from __future__ import annotations

import numpy as np
from measure import (
    Round,
    Row,
    Subject,
    compare_speed,
    find_median,
    format_rate,
    format_seconds,
    is_installed,
    print_subject,
    time_in_turn,
)
from numpy.typing import NDArray
from scene_data import UP, build_cell_centers, trace_ring_map
from scipy_map import build_scipy_tree, estimate_with_scipy

WORK = ((200_000, 20), (1_000_000, 50))
# Both estimate from the same photons; where the (k + 1)-th distances tie, rounding decides.
AGREEMENT = 1e-4  # RMS difference in units of the mean


def measure_one(subject: Subject, count: int, k: int) -> None:
    """One map and k."""
    photons, points = trace_ring_map(count), build_cell_centers()
    found: dict[str, NDArray[np.float32]] = {}

    def run_ours(_: int) -> None:
        found["ours"] = photons.irradiance(points, UP, k=k)

    rounds: dict[str, Round] = {"ours": run_ours}
    photons.neighbors([0], 1)  # builds the tree
    if is_installed("scipy"):
        tree = build_scipy_tree(np.ascontiguousarray(photons.positions))
        power = np.ascontiguousarray(photons.power)

        def run_scipy(_: int) -> None:
            found["peer"] = estimate_with_scipy(tree, power, points, k)

        rounds = {"peer": run_scipy, **rounds}
    seconds = time_in_turn(rounds)
    own = find_median(seconds["ours"])
    figure = f"{format_seconds(own)} ({format_rate(len(points) / own, 'points')})"
    work = f"{len(points):,} points, {count:,} photons, k = {k}"
    if "peer" not in found:
        subject.rows.append(Row(work, "—", "—", figure))
        return
    peer = find_median(seconds["peer"])
    difference = float(np.sqrt(np.mean((found["ours"] - found["peer"]) ** 2)) / found["peer"].mean())
    if difference > AGREEMENT:
        subject.failed.append(f"{work}: RMS difference from SciPy's estimate {difference:.2g} of the mean")
    theirs = f"{format_seconds(peer)} ({format_rate(len(points) / peer, 'points')})"
    ratio = compare_speed(seconds["peer"], seconds["ours"])
    subject.rows.append(Row(work, "SciPy cKDTree + NumPy", theirs, figure, str(ratio)))


def measure() -> Subject:
    """Every size of `WORK`."""
    subject = Subject("Irradiance at points")
    subject.notes.append(
        "Middles of the 512² cells of the ring's window, random emission, Epanechnikov, trees built beforehand. Ours "
        "also applies the test for the same surface; the peer takes every photon. No gate is set. Results must "
        f"agree within {AGREEMENT} of the mean (RMS)."
    )
    if not is_installed("scipy"):
        subject.skipped.append("SciPy: the package scipy is not installed (pip install '.[bench]')")
    for count, k in WORK:
        measure_one(subject, count, k)
    return subject


if __name__ == "__main__":
    print_subject(measure())
