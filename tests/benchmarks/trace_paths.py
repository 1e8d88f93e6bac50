# SPDX-License-Identifier: Apache-2.0
"""Times photon tracing with paths stored: paths emitted per second, against a Dr.Jit tracer on the same meshes."""

from __future__ import annotations

from find_llvm import find_llvm
from measure import (
    Round,
    Row,
    Subject,
    compare_speed,
    find_median,
    format_rate,
    format_seconds,
    print_subject,
    time_in_turn,
)
from scene_data import load_scene

import photonloupe as pl

PATHS = 1_000_000
GATE = 0.25  # times Dr.Jit, our gate
MAX_BOUNCES = 16
SCENES = {"ring": "mirror ring, 24,002 triangles", "slab": "glass slab, 14 triangles"}


def trace_ours(name: str, seed: int, emission: str, *, paths: bool) -> pl.PhotonMap:
    """Trace with a seed that was not used before, so that no result is handed out again."""
    columns = ["path_vertices", "path_normals"] if paths else None
    return pl.trace_photons(
        load_scene(name), emitted=PATHS, seed=seed, emission=emission, max_bounces=MAX_BOUNCES, columns=columns
    )


def describe_work(name: str, emission: str, photons: pl.PhotonMap) -> str:
    """What a round is, with what our tracer stored of it."""
    vertices = len(photons.path_vertices) / len(photons)
    share = len(photons) / photons.emitted
    return f"{SCENES[name]}, {emission} emission; {share:.1%} of the paths stored, {vertices:.2f} vertices each"


def measure_scene(subject: Subject, name: str, emission: str) -> None:
    """One scene and emission: Dr.Jit, ours with paths, ours without."""
    kept: list[pl.PhotonMap] = []

    def run_ours(number: int) -> None:
        kept[:] = [trace_ours(name, 100 + number, emission, paths=True)]

    rounds: dict[str, Round] = {
        "ours": run_ours,
        "bare": lambda number: trace_ours(name, 200 + number, emission, paths=False),
    }
    tracer = None
    if not find_llvm():
        import peer_tracer  # noqa: PLC0415 - an optional peer

        tracer = peer_tracer.DrjitTracer(name)
        rounds = {"peer": lambda number: tracer.trace(PATHS, number + 1, emission), **rounds}
    seconds = time_in_turn(rounds)
    ours = find_median(seconds["ours"])
    bare = find_median(seconds["bare"])
    figure = f"{format_rate(PATHS / ours, 'paths')} (photons without paths: {format_rate(PATHS / bare, 'paths')})"
    work = describe_work(name, emission, kept[0])
    if tracer is None:
        subject.rows.append(Row(work, "—", "—", figure, gate=f"{GATE}× Dr.Jit"))
        return
    ratio = compare_speed(seconds["peer"], seconds["ours"])
    peer = find_median(seconds["peer"])
    stored = float((tracer.trace(PATHS, 1, emission)["lengths"].numpy() > 0).mean())
    subject.rows.append(
        Row(
            work,
            f"Dr.Jit ({stored:.1%} of its paths meet a receiver)",
            format_rate(PATHS / peer, "paths"),
            figure,
            str(ratio),
            f"{GATE}× Dr.Jit",
            ratio.median >= GATE,
        )
    )
    print(f"  {name} {emission}: Dr.Jit {format_seconds(peer)}, ours {format_seconds(ours)}", flush=True)


def measure() -> Subject:
    """Ring and slab, random and Sobol emission."""
    subject = Subject("Tracing, paths stored with vertices and normals")
    subject.notes += [
        f"Counted: paths emitted, {PATHS:,} a round, whether stored or not, at most {MAX_BOUNCES} interactions.",
        "Both aim the emission at a grid of cells of equal solid angle that hold the mirror or the glass; "
        "both store the emitter, every hit and the end point with its normal. Ours ends with ragged NumPy columns "
        "of the stored paths alone, objects and interactions among them; Dr.Jit ends with "
        f"{MAX_BOUNCES + 2} slots a path in memory, not copied to NumPy. Dr.Jit's Sobol points are scrambled by a "
        "digital shift, ours by Owen's scrambling.",
        "The slab is larger than the floor: paths that miss the floor escape and are not stored.",
    ]
    reason = find_llvm()
    if reason:
        subject.skipped.append(f"Mitsuba/Dr.Jit: {reason}")
    for name in SCENES:
        for emission in ("random", "sobol"):
            measure_scene(subject, name, emission)
    return subject


if __name__ == "__main__":
    print_subject(measure())
