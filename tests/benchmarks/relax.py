# SPDX-License-Identifier: Apache-2.0
"""Times relaxation against SciPy's tree with Numba, and the published setting of six neighbors alone."""

from __future__ import annotations

from functools import partial
from typing import Any

import numpy as np
from measure import (
    PAIRS,
    Round,
    Row,
    Subject,
    compare_speed,
    find_median,
    format_seconds,
    is_installed,
    print_subject,
    time_in_turn,
)
from numpy.typing import NDArray
from scene_data import trace_ring_map

import photonloupe as pl

# (photons, pairs): the peer takes a minute for a million, which is worth one pair and no warm-up.
WORK = ((100_000, PAIRS), (1_000_000, 1))
NEIGHBORS, STEPS = 50, 10
SEARCHES = ("exact", "carried")
OVER_RELAXATION = (2.0, 1.2)
GATE = 5.0  # times the peer, our gate
FREE: dict[str, Any] = {"constraint": "world", "descriptor": "none", "repel": "world"}

SMALL_COUNT, SMALL_NEIGHBORS, SMALL_STEPS, MOONSHOT = 200_000, 6, 20, 1.0  # s
SMALL_WORK = (("none", "exact"), ("none", "carried"), ("pca", "exact"), ("pca", "carried"))

# After one step, in units of a photon's radius: floats against doubles. Where the rim of the neighborhood ties for
# one of them and not for the other, a photon moves by a neighbor's share more or less: so few may.
AGREEMENT, FEW = 1e-3, 1e-4


def relax_ours(photons: pl.PhotonMap, *, neighbors: int, steps: int, **more: Any) -> NDArray[np.float32]:
    """From a map to positions in NumPy."""
    keywords = {**FREE, "over_relaxation": OVER_RELAXATION, **more}
    return np.asarray(photons.relax(steps=steps, neighbors=neighbors, **keywords).positions)


def relax_peer(photons: pl.PhotonMap, *, neighbors: int, steps: int) -> NDArray[np.float64]:
    """From a map to positions in NumPy; the peer works in doubles."""
    from peer_relaxation import relax_with_scipy  # noqa: PLC0415 - an optional peer

    positions, normals = (np.asarray(values, dtype=np.float64) for values in (photons.positions, photons.normals))
    return relax_with_scipy(positions, normals, neighbors=neighbors, steps=steps, over_relaxation=OVER_RELAXATION)


def check_step(photons: pl.PhotonMap) -> list[str]:
    """Compare where one step takes every photon."""
    before = np.asarray(photons.positions, dtype=np.float64)
    theirs = relax_peer(photons, neighbors=NEIGHBORS, steps=1)
    ours = relax_ours(photons, neighbors=NEIGHBORS, steps=1, limit=None)
    _, distances = photons.neighbors(np.arange(len(photons)), NEIGHBORS + 1)
    away = np.linalg.norm(ours - theirs, axis=1) / distances[:, -1]
    share = float(np.mean(away > AGREEMENT))
    moved = float(np.median(np.linalg.norm(theirs - before, axis=1) / distances[:, -1]))
    print(f"  one step of {moved:.2g} radii (median): median difference {np.median(away):.2g}, most {away.max():.2g}")
    if share <= FEW:
        return []
    return [f"{len(photons):,} photons: {share:.2%} of them end more than {AGREEMENT} radii from where the peer's do"]


def time_one(subject: Subject, count: int, pairs: int, *, with_peer: bool) -> None:
    """Row of one size; without a second pair the warm-up is left out as well."""
    photons = trace_ring_map(count)

    def run_ours(number: int, search: str) -> float | None:
        if pairs == 1 and number == 0:
            return 0.0
        relax_ours(photons, neighbors=NEIGHBORS, steps=STEPS, limit=None, search=search)
        return None

    def run_peer(number: int) -> float | None:
        if pairs == 1 and number == 0:
            return 0.0
        relax_peer(photons, neighbors=NEIGHBORS, steps=STEPS)
        return None

    rounds: dict[str, Round] = {"peer": run_peer} if with_peer else {}
    rounds.update({search: partial(run_ours, search=search) for search in SEARCHES})
    seconds = time_in_turn(rounds, pairs)
    for search in SEARCHES:
        figure = format_seconds(find_median(seconds[search]))
        work = f"{count:,} photons, K = {NEIGHBORS}, {STEPS} steps, search {search}"
        if not with_peer:
            subject.rows.append(Row(work, "—", "—", figure))
            continue
        ratio = compare_speed(seconds["peer"], seconds[search])
        theirs = format_seconds(find_median(seconds["peer"]))
        gate = f"{GATE:g}× faster"
        subject.rows.append(Row(work, "SciPy cKDTree + Numba", theirs, figure, str(ratio), gate, ratio.median >= GATE))


def time_small(subject: Subject) -> None:
    """Rows of the published setting, each of our ways to search, with and without the constraint."""
    photons = trace_ring_map(SMALL_COUNT)
    for descriptor, search in SMALL_WORK:

        def run(_: int, descriptor: str = descriptor, search: str = search) -> None:
            relax_ours(
                photons, neighbors=SMALL_NEIGHBORS, steps=SMALL_STEPS, limit=0.3, descriptor=descriptor, search=search
            )

        own = find_median(time_in_turn({"ours": run})["ours"])
        constraint = "no constraint" if descriptor == "none" else f"constraint {descriptor}, made in the time too"
        work = f"{SMALL_COUNT:,} photons, K = {SMALL_NEIGHBORS}, {SMALL_STEPS} steps, {constraint}, search {search}"
        met = True if own < MOONSHOT else None  # a moonshot that is not reached is no gate missed
        subject.rows.append(Row(work, "—", "—", format_seconds(own), "—", f"moonshot < {MOONSHOT:g} s", met))


def measure() -> Subject:
    """Every size of `WORK` beside the peer, then six neighbors."""
    subject = Subject("Relaxation, from a map to positions in NumPy")
    subject.notes += [
        "Photons of the ring caustic, random emission. Against the peer: push by all neighbors in the world, in the "
        "tangent plane, no limiter, no constraint, the trees of every step in the time. After one step positions must "
        f"agree within {AGREEMENT} of a photon's radius, but for {FEW:.2%} of the photons. A million: one pair, "
        "unwarmed but by the smaller size.",
        "`exact` finds every photon's radius anew in each step, `carried` takes that of the step before, corrected by "
        "the photons within (its error: docs/relaxation.md).",
        "Then the published setting (METHODS section 3) with its limiter.",
    ]
    missing = [name for name in ("scipy", "numba") if not is_installed(name)]
    if missing:
        subject.skipped.append(f"SciPy + Numba: not installed: {', '.join(missing)} (pip install '.[bench]')")
    for count, pairs in WORK:
        time_one(subject, count, pairs, with_peer=not missing)
    if not missing:
        subject.failed += check_step(trace_ring_map(WORK[0][0]))
    time_small(subject)
    return subject


if __name__ == "__main__":
    print_subject(measure())
