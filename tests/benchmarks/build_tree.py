# SPDX-License-Identifier: Apache-2.0
"""Times building the kd-tree over the photons of the ring caustic, against SciPy, pykdtree and nanoflann."""

from __future__ import annotations

import time
from functools import partial

import numpy as np
from measure import (
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
from peer_nanoflann import Nanoflann
from scene_data import trace_ring_map

import photonloupe as pl

COUNTS = (100_000, 1_000_000)
GATE_COUNT, GATE = 1_000_000, 0.8  # s, our gate
WARM_QUERIES = 5
PEERS = {"scipy": "SciPy cKDTree", "pykdtree": "pykdtree", "nanoflann": "nanoflann"}


class OurBuild:
    """Builds our tree anew each round; keeps the device's own time of the build."""

    def __init__(self, photons: pl.PhotonMap) -> None:
        self.photons = photons
        self.device = pl.Device("auto")
        self.device_milliseconds: list[float] = []

    def run(self, number: int) -> float:
        """Seconds of a fresh map's first query less those of a warm one: the build, and what the host adds."""
        columns = {name: getattr(self.photons, name) for name in ("positions", "normals", "power")}
        fresh = pl.PhotonMap.from_arrays(**columns, device=self.device)
        self.device.timings()
        first = time_query(fresh)
        stages = {row["stage"]: row["milliseconds"] for row in self.device.timings()}
        if number > 0:
            self.device_milliseconds.append(stages.get("build tree", 0.0))
        return first - min(time_query(fresh) for _ in range(WARM_QUERIES))


def time_query(photons: pl.PhotonMap) -> float:
    """Wall time of the smallest query there is."""
    start = time.perf_counter()
    photons.neighbors([0], 1)
    return time.perf_counter() - start


def list_rounds(photons: pl.PhotonMap, nanoflann: Nanoflann) -> dict[str, Round]:
    """The peers that are here, by the keys of `PEERS`."""
    positions = np.ascontiguousarray(photons.positions)
    rounds: dict[str, Round] = {}
    if is_installed("scipy"):
        from scipy.spatial import cKDTree  # noqa: PLC0415 - an optional peer

        rounds["scipy"] = partial(lambda build, _: build(positions), cKDTree)
    if is_installed("pykdtree"):
        from pykdtree.kdtree import KDTree  # noqa: PLC0415

        rounds["pykdtree"] = partial(lambda build, _: build(positions), KDTree)
    if not nanoflann.reason:
        nanoflann.load(positions)
        rounds["nanoflann"] = lambda _: nanoflann.build()
    return rounds


def measure() -> Subject:
    """100,000 and 1,000,000 photons."""
    subject = Subject("kd-tree, build")
    subject.notes += [
        "Photons of the ring caustic, random emission. Ours: the first `neighbors([0], 1)` of a map fresh from arrays "
        "less the fastest of five warm ones, so the host's share counts; in brackets the device's own time for the "
        "stage. SciPy: defaults, float64 copy included. nanoflann: leaves of 16, one thread.",
    ]
    nanoflann = Nanoflann()
    subject.skipped += [
        f"{PEERS[name]}: the package {name} is not installed (pip install '.[bench]')"
        for name in ("scipy", "pykdtree")
        if not is_installed(name)
    ]
    if nanoflann.reason:
        subject.skipped.append(f"nanoflann: {nanoflann.reason}")
    for count in COUNTS:
        photons = trace_ring_map(count)
        ours = OurBuild(photons)
        seconds = time_in_turn({**list_rounds(photons, nanoflann), "ours": ours.run})
        own = find_median(seconds["ours"])
        figure = f"{format_seconds(own)} (device {format_seconds(find_median(ours.device_milliseconds) * 1e-3)})"
        gated = count == GATE_COUNT
        gate, met = (f"< {GATE} s", own < GATE) if gated else ("—", None)
        for name in [name for name in seconds if name != "ours"] or [""]:
            peer = format_seconds(find_median(seconds[name])) if name else "—"
            ratio = str(compare_speed(seconds[name], seconds["ours"])) if name else "—"
            subject.rows.append(Row(f"{count:,} photons", PEERS.get(name, "—"), peer, figure, ratio, gate, met))
    nanoflann.close()
    return subject


if __name__ == "__main__":
    print_subject(measure())
