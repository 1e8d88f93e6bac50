# SPDX-License-Identifier: Apache-2.0
"""Times the peer and us in turn, and holds what came of it as rows of a table."""

from __future__ import annotations

import importlib.util
import statistics
import sys
import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

from photonloupe.device import open_device

PAIRS = 3

# One round: takes the round's number (0 is the warm-up); a float it returns is its seconds, else its wall time counts.
Round = Callable[[int], object]


@dataclass(frozen=True)
class Row:
    """One comparison, or one figure of ours where `peer` is empty."""

    work: str
    peer: str
    peer_figure: str
    our_figure: str
    ratio: str = "—"
    gate: str = "—"
    met: bool | None = None


@dataclass
class Subject:
    """A table with the sentences that say how its figures were taken."""

    title: str
    notes: list[str] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)
    skipped: list[str] = field(default_factory=list)  # "peer: reason"
    failed: list[str] = field(default_factory=list)  # results of ours that disagree with the peer's


@dataclass(frozen=True)
class Ratio:
    """Our speed over the peer's, pair by pair."""

    median: float
    least: float
    most: float

    def __str__(self) -> str:
        return f"{self.median:.2f} ({self.least:.2f}–{self.most:.2f})"


def time_in_turn(rounds: Mapping[str, Round], pairs: int = PAIRS) -> dict[str, list[float]]:
    """Run every entry once to warm up, then A B A B …; seconds of each, in the order of the pairs."""
    seconds: dict[str, list[float]] = {name: [] for name in rounds}
    for number in range(pairs + 1):
        for name, run in rounds.items():
            open_device().forget_results()
            start = time.perf_counter()
            told = run(number)
            spent = told if isinstance(told, float) else time.perf_counter() - start
            if number > 0:
                seconds[name].append(spent)
    return seconds


def find_median(values: list[float]) -> float:
    """Return the median of the rounds."""
    return statistics.median(values)


def compare_speed(peer: list[float], ours: list[float]) -> Ratio:
    """Ratio of the speeds: the peer's seconds over ours, so that above 1 we are faster."""
    ratios = [theirs / own for theirs, own in zip(peer, ours, strict=True)]
    return Ratio(statistics.median(ratios), min(ratios), max(ratios))


def format_seconds(seconds: float) -> str:
    """Seconds, or milliseconds below one."""
    return f"{seconds:.2f} s" if seconds >= 1.0 else f"{seconds * 1e3:.3g} ms"


def format_rate(count: float, unit: str) -> str:
    """Count per second with a prefix: "7.80 M paths/s"."""
    scale, prefix = (1e-6, "M") if count >= 1e6 else (1e-3, "k")
    return f"{count * scale:.3g} {prefix} {unit}/s"


def is_installed(module: str) -> bool:
    """Whether a peer's Python package is there."""
    return importlib.util.find_spec(module) is not None


def print_subject(subject: Subject) -> None:
    """Show a subject on the terminal."""
    print(f"\n{subject.title}")
    for row in subject.rows:
        verdict = {None: "", True: "met", False: "NOT met"}[row.met]
        print(f"  {row.work} | {row.peer} {row.peer_figure} | {row.our_figure} | {row.ratio} | {row.gate} {verdict}")
    for line in subject.skipped:
        print(f"  skipped: {line}")
    for line in subject.failed:
        print(f"  FAILED: {line}")
    sys.stdout.flush()
