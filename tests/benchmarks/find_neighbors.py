# SPDX-License-Identifier: Apache-2.0
"""Times the k nearest of all photons against themselves, and one query, against nanoflann and SciPy."""

from __future__ import annotations

from dataclasses import dataclass, field
from time import perf_counter
from typing import Any

import numpy as np
from measure import (
    PAIRS,
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
from peer_nanoflann import Nanoflann
from scene_data import trace_ring_map

import photonloupe as pl

WORK = ((100_000, 50), (100_000, 250), (1_000_000, 50))
GATE = 0.5  # times nanoflann, our gate
SINGLE_K, SINGLE_GATE, SINGLE_QUERIES = 250, 1e-3, 200  # s, our gate
PEERS = {"nanoflann": "nanoflann", "scipy": "SciPy cKDTree"}
# Distances of float32 positions a few meters from the origin: SciPy computes in double, we in float32.
TIE = 5e-7  # m


@dataclass
class Answers:
    """What the last round of each found, for the check."""

    ids: dict[str, NDArray[Any]] = field(default_factory=dict)
    distances: dict[str, NDArray[Any]] = field(default_factory=dict)
    mean: float = 0.0  # nanoflann's


def list_rounds(photons: pl.PhotonMap, k: int, nanoflann: Nanoflann, answers: Answers) -> dict[str, Round]:
    """Ours and the peers that are here, trees built beforehand."""
    positions = np.ascontiguousarray(photons.positions)
    everyone = np.arange(len(photons))
    rounds: dict[str, Round] = {}
    if not nanoflann.reason:
        nanoflann.load(positions)
        nanoflann.build()

        def run_nanoflann(_: int) -> float:
            seconds, answers.mean = nanoflann.find(k)
            return seconds

        rounds["nanoflann"] = run_nanoflann
    if is_installed("scipy"):
        from scipy.spatial import cKDTree  # noqa: PLC0415 - an optional peer

        tree = cKDTree(positions)

        def run_scipy(_: int) -> None:
            answers.distances["scipy"], answers.ids["scipy"] = tree.query(positions, k + 1, workers=-1)

        rounds["scipy"] = run_scipy

    def run_ours(_: int) -> None:
        answers.ids["ours"], answers.distances["ours"] = photons.neighbors(everyone, k)

    return {**rounds, "ours": run_ours}


def check_answers(photons: pl.PhotonMap, k: int, answers: Answers) -> list[str]:
    """Compare ids and distances of every query: a row may differ from SciPy's only where distances tie."""
    failed = []
    positions = photons.positions.astype(np.float64)
    ours = answers.ids["ours"]
    if answers.mean:
        mean = float(answers.distances["ours"].mean(dtype=np.float64)) * k / (k + 1)
        if abs(mean / answers.mean - 1.0) > 1e-6:
            failed.append(f"mean distance {mean:.9g}, nanoflann's {answers.mean:.9g}")
    if "scipy" in answers.ids:
        # A photon's own place in SciPy's row is first unless another photon lies on it: drop it by id.
        theirs, kept = answers.ids["scipy"], np.empty(ours.shape, np.int64)
        is_self = theirs == np.arange(len(theirs))[:, None]
        is_self[~is_self.any(axis=1), -1] = True
        kept[:] = theirs[~is_self].reshape(ours.shape)
        rows, columns = np.nonzero(ours != kept)
        own = np.linalg.norm(positions[rows] - positions[ours[rows, columns]], axis=1)
        other = np.linalg.norm(positions[rows] - positions[kept[rows, columns]], axis=1)
        wrong = int((np.abs(own - other) > TIE).sum())
        if wrong:
            failed.append(f"{wrong:,} of {ours.size:,} ids differ from SciPy's where distances do not tie")
        print(f"  {len(rows):,} of {ours.size:,} ids differ from SciPy's, {wrong:,} beyond a tie", flush=True)
    return [f"{len(photons):,} photons, k = {k}: {line}" for line in failed]


def time_single_query(photons: pl.PhotonMap) -> list[float]:
    """Seconds of single warm queries, each of another photon."""
    seconds = []
    for number in range(SINGLE_QUERIES):
        photon = number * 7919 % len(photons)
        start = perf_counter()
        photons.neighbors([photon], SINGLE_K)
        seconds.append(perf_counter() - start)
    return seconds[SINGLE_QUERIES // 10 :]


def measure() -> Subject:
    """Every size of `WORK`, then single queries."""
    subject = Subject("k nearest neighbors, all photons against themselves, ids and distances")
    subject.notes += [
        "Photons of the ring caustic, random emission; trees built beforehand; queries per second on all cores, in the "
        "map's order. Peers ask for k + 1, since they find the photon itself. The answers are compared: mean distance "
        "with nanoflann's; with SciPy's every id, equal unless the distances tie within "
        f"{TIE} m (SciPy computes in double).",
    ]
    nanoflann = Nanoflann()
    if nanoflann.reason:
        subject.skipped.append(f"nanoflann: {nanoflann.reason}")
    if not is_installed("scipy"):
        subject.skipped.append("SciPy: the package scipy is not installed (pip install '.[bench]')")
    for count, k in WORK:
        photons, answers = trace_ring_map(count), Answers()
        seconds = time_in_turn(list_rounds(photons, k, nanoflann, answers), PAIRS)
        figure = format_rate(count / find_median(seconds["ours"]), "queries")
        for name in [name for name in seconds if name != "ours"] or [""]:
            peer = format_rate(count / find_median(seconds[name]), "queries") if name else "—"
            ratio = compare_speed(seconds[name], seconds["ours"]) if name else None
            gated = name == "nanoflann" and ratio is not None
            gate, met = (f"{GATE}× nanoflann", ratio.median >= GATE) if gated else ("—", None)
            work = f"{count:,} photons, k = {k}"
            subject.rows.append(Row(work, PEERS.get(name, "—"), peer, figure, str(ratio or "—"), gate, met))
        subject.failed += check_answers(photons, k, answers)
    nanoflann.close()
    single = time_single_query(trace_ring_map(WORK[0][0]))
    own = find_median(single)
    work = f"one query of {WORK[0][0]:,} photons, k = {SINGLE_K}"
    subject.rows.append(Row(work, "—", "—", format_seconds(own), "—", "< 1 ms", own < SINGLE_GATE))
    return subject


if __name__ == "__main__":
    print_subject(measure())
