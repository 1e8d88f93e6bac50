# SPDX-License-Identifier: Apache-2.0
"""Times scripts over photon paths against NumPy, Numba, Taichi on the same device, and k-means against scikit-learn."""

from __future__ import annotations

import time
from collections.abc import Callable
from functools import partial

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
from peer_scripts import (
    PPCA,
    TORTUOSITY,
    VERTICES,
    build_numba,
    build_taichi,
    find_colors,
    find_ppca,
    find_tortuosity,
    make_paths,
)

import photonloupe as pl

COUNT = 1_000_000
SIZES = (100_000, 1_000_000, 10_000_000)
TAICHI_GATE = 1 / 1.5  # our speed over Taichi's
CLUSTERS, KMEANS_GATE = 8, 1 / 5  # our speed over scikit-learn's, an iteration
SPIRV_GATE, EDIT_GATE, SLIDER_GATE = 0.05, 1.0, 0.15  # s
AGREEMENT = 1e-4  # median difference of results

KMEANS = """
float cx[8]; float cy[8]; float cz[8];
for (k = 0; k < 8; k++) {
    cx[k] = getPathNormal(k, 1, X); cy[k] = getPathNormal(k, 1, Y); cz[k] = getPathNormal(k, 1, Z);
}
iterations = 1;
expose iterations range 1, 100 step 1
for (round = 0; round < iterations; round++) {
    float sx[8]; float sy[8]; float sz[8]; int members[8];
    for (i = 0; i < getNumPhotons(); i++) {
        x = getPathNormal(i, 1, X); y = getPathNormal(i, 1, Y); z = getPathNormal(i, 1, Z);
        nearest = 0; least = 100.0;
        for (k = 0; k < 8; k++) {
            away = (x - cx[k]) * (x - cx[k]) + (y - cy[k]) * (y - cy[k]) + (z - cz[k]) * (z - cz[k]);
            if (away < least) { least = away; nearest = k; }
        }
        sx[nearest] += x; sy[nearest] += y; sz[nearest] += z; members[nearest]++;
    }
    for (k = 0; k < 8; k++)
        if (members[k] > 0) { cx[k] = sx[k] / members[k]; cy[k] = sy[k] / members[k]; cz[k] = sz[k] / members[k]; }
}
"""


def make_map(count: int) -> pl.PhotonMap:
    """Make a map of `count` random paths."""
    vertices, normals = make_paths(count)
    return pl.PhotonMap.from_arrays(
        positions=vertices[:, -1].copy(),
        normals=np.tile(np.float32([0, 1, 0]), (count, 1)),
        power=np.ones((count, 3), np.float32),
        path_offsets=np.arange(count + 1) * VERTICES,
        path_vertices=vertices.reshape(-1, 3),
        path_normals=normals.reshape(-1, 3),
    )


def time_passes(photons: pl.PhotonMap, script: pl.Script) -> float:
    """Seconds of the passes of a run: results are left on the device, as the peers leave them."""
    return sum(row["milliseconds"] for row in photons.run_script(script).report["passes"]) * 1e-3


def run_passes(_: int, photons: pl.PhotonMap, script: pl.Script) -> float:
    """One round of `time_passes`."""
    return time_passes(photons, script)


def run_work(_: int, work: Callable[[], object]) -> None:
    """One round of a peer."""
    work()


def time_algorithms(subject: Subject) -> None:
    """Rows of both algorithms beside every peer that is here."""
    photons = make_map(COUNT)
    vertices, normals = make_paths(COUNT)
    peers: dict[str, tuple[Callable[[], object], Callable[[], object]]] = {
        "NumPy": (lambda: find_colors(find_tortuosity(vertices)), lambda: find_ppca(vertices, normals))
    }
    if is_installed("numba"):
        tortuosity, ppca = build_numba()
        gamma, axes = np.empty(COUNT, np.float32), np.empty((COUNT, 2), np.float32)
        colors = np.empty((COUNT, 3), np.float32)
        peers["Numba"] = (lambda: tortuosity(vertices, gamma, colors), lambda: ppca(vertices, normals, axes))
    if is_installed("taichi"):
        first, second, _ = build_taichi(vertices, normals)
        peers["Taichi (Vulkan)"] = (first, second)
    for missing in {"Numba", "Taichi (Vulkan)"} - set(peers):
        subject.skipped.append(f"{missing}: not installed (pip install '.[bench]')")
    for number, (name, text) in enumerate((("tortuosity with colors", TORTUOSITY), ("PPCA", PPCA))):
        script = pl.compile_script(text)
        rounds: dict[str, Round] = {peer: partial(run_work, work=runs[number]) for peer, runs in peers.items()}
        rounds["ours"] = partial(run_passes, photons=photons, script=script)
        seconds = time_in_turn(rounds)
        for peer in peers:
            ratio = compare_speed(seconds[peer], seconds["ours"])
            gate = f"{TAICHI_GATE:.2f}" if peer.startswith("Taichi") else "—"
            subject.rows.append(
                Row(
                    f"{name}, {COUNT:,} paths of {VERTICES} vertices",
                    peer,
                    format_seconds(find_median(seconds[peer])),
                    format_seconds(find_median(seconds["ours"])),
                    str(ratio),
                    gate,
                    ratio.median >= TAICHI_GATE if gate != "—" else None,
                )
            )
        expected = find_tortuosity(vertices)[:, None] if number == 0 else find_ppca(vertices, normals)
        difference = float(np.median(np.abs(photons.parameters - expected)))
        if not difference < AGREEMENT:
            subject.failed.append(f"{name}: median difference to NumPy {difference:.2g}")


def time_kmeans(subject: Subject) -> None:
    """Row of one iteration over directions."""
    photons = make_map(COUNT)
    script = pl.compile_script(KMEANS)
    iterations = 10

    def run_ours(_: int) -> float:
        report = photons.run_script(script, iterations=iterations).report
        return float(sum(row["milliseconds"] for row in report["passes"])) * 1e-3 / iterations

    if not is_installed("sklearn"):
        subject.skipped.append("scikit-learn: not installed (pip install '.[bench]')")
        return
    from sklearn.cluster import KMeans  # noqa: PLC0415 - an optional peer

    directions = make_paths(COUNT)[1][:, 1].copy()

    def run_peer(_: int) -> float:
        start = time.perf_counter()
        fitted = KMeans(CLUSTERS, init=directions[:CLUSTERS], n_init=1, max_iter=iterations, tol=0.0).fit(directions)
        return (time.perf_counter() - start) / fitted.n_iter_

    seconds = time_in_turn({"peer": run_peer, "ours": run_ours})
    ratio = compare_speed(seconds["peer"], seconds["ours"])
    subject.rows.append(
        Row(
            f"k-means, k = {CLUSTERS}, {COUNT:,} directions, an iteration",
            "scikit-learn",
            format_seconds(find_median(seconds["peer"])),
            format_seconds(find_median(seconds["ours"])),
            str(ratio),
            f"{KMEANS_GATE:g}",
            ratio.median >= KMEANS_GATE,
        )
    )


def time_edits(subject: Subject) -> None:
    """Rows of what a user waits for: an edited text, a moved slider, and how both grow with the map."""
    text = TORTUOSITY
    unseen = time.time_ns()
    spirv, edits = [], []
    photons = make_map(COUNT)
    for number in range(PAIRS + 1):
        # A constant no cache has met: nothing of the edited pass is known.
        edited = text.replace("2 * Pi * sum", f"2 * Pi * sum + {(unseen + number) % 16_777_213}e-20")
        start = time.perf_counter()
        pl.compile_script(edited).spirv()
        spirv.append(time.perf_counter() - start)
        edited = edited.replace("e-20", "e-21")
        start = time.perf_counter()
        photons.run_script(edited)
        edits.append(time.perf_counter() - start)
    script = pl.compile_script(text)
    slider = script.exposed[0]
    moves = time_in_turn({"ours": lambda n: photons.run_script(script, values={slider.name: slider.low + n % 2})})
    figures = (
        ("script to SPIR-V, nothing cached", find_median(spirv[1:]), SPIRV_GATE),
        (f"edit to colors, {COUNT:,} paths, the driver's compiler included", find_median(edits[1:]), EDIT_GATE),
        (f"slider to colors, {COUNT:,} paths", find_median(moves["ours"]), SLIDER_GATE),
    )
    for work, seconds, gate in figures:
        subject.rows.append(Row(work, "—", "—", format_seconds(seconds), "—", f"< {gate:g} s", seconds < gate))
    for size in SIZES:
        grown = make_map(size)
        seconds = find_median(time_in_turn({"ours": partial(run_passes, photons=grown, script=script)})["ours"])
        subject.rows.append(Row(f"tortuosity, {size:,} paths", "—", "—", format_seconds(seconds)))


def measure() -> Subject:
    """All rows."""
    subject = Subject("Scripts over photon paths")
    subject.notes += [
        "Random paths of 4 vertices. Passes alone, warm: paths on the device, results left there, as Taichi's kernels "
        "do; NumPy and Numba have both in memory. Medians of results agree with NumPy's within 1e-4.",
        "Colors: the whole of `run_script`, with the columns copied to NumPy.",
    ]
    time_algorithms(subject)
    time_kmeans(subject)
    time_edits(subject)
    return subject


if __name__ == "__main__":
    print_subject(measure())
