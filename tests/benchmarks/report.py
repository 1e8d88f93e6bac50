# SPDX-License-Identifier: Apache-2.0
"""Writes the subjects' tables as docs/benchmarks.md."""

from __future__ import annotations

import platform
import re
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

import numpy as np
from find_llvm import find_llvm
from measure import PAIRS, Row, Subject

import photonloupe as pl

COMMANDS = """\
    apt-get install libllvm19 libnanoflann-dev
    ./photonloupe python -m pip install matplotlib mitsuba numba pykdtree scikit-learn scipy taichi # the extra `bench`
    ./photonloupe python tests/benchmarks/run.py"""
PACKAGES = ("scipy", "numba", "pykdtree", "taichi", "scikit-learn", "matplotlib")
HEAD = "| work | peer | peer's figure | ours | ratio ours/peer | gate | met |\n|---|---|---|---|---|---|---|"


def read_proc(path: str, key: str) -> str:
    """One value of a file under /proc, or "unknown"."""
    try:
        found = re.search(rf"^{key}\s*:\s*(.+)$", Path(path).read_text(), re.MULTILINE)
    except OSError:
        found = None
    return found[1] if found else "unknown"


def describe_machine() -> str:
    """Processor, cores, memory, device and driver."""
    info = pl.Device("auto").info
    cores = read_proc("/proc/cpuinfo", "cpu cores")
    memory = read_proc("/proc/meminfo", "MemTotal").removesuffix(" kB")
    gigabytes = f"{int(memory) / 2**20:.0f} GiB" if memory.isdigit() else "unknown"
    wide = "avx512f" in read_proc("/proc/cpuinfo", "flags")
    return (
        f"{read_proc('/proc/cpuinfo', 'model name')}{' with AVX-512' if wide else ''}, {cores} cores, {gigabytes}; "
        f"device {info['name']}, driver {info['driver']}"
    )


def describe_versions(nanoflann: str) -> str:
    """Ours, Python's and every peer's."""
    parts = [f"Photon Loupe {pl.__version__}", f"Python {platform.python_version()}", f"NumPy {np.__version__}"]
    for name in PACKAGES:
        try:
            parts.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            parts.append(f"{name} absent")
    if not find_llvm():
        import peer_tracer  # noqa: PLC0415 - an optional peer

        parts.append(peer_tracer.describe_versions())
    else:
        parts.append("Mitsuba absent")
    parts.append(f"nanoflann {nanoflann}" if nanoflann else "nanoflann absent")
    return ", ".join(parts)


def format_row(row: Row) -> str:
    """One line of a table."""
    met = {None: "—", True: "yes", False: "**no**"}[row.met]
    cells = (row.work, row.peer, row.peer_figure, row.our_figure, row.ratio, row.gate, met)
    return "| " + " | ".join(cells) + " |"


def list_unmet(subjects: list[Subject]) -> list[str]:
    """Every gate that was missed, every disagreement, every subject that failed, as list items."""
    lines = []
    for subject in subjects:
        lines += [
            f"- {subject.title}: {row.work}: {row.our_figure}; gate {row.gate}"
            + (f", ratio {row.ratio}" if row.ratio != "—" else "")
            + "."
            for row in subject.rows
            if row.met is False
        ]
        lines += [f"- {subject.title}: {line}." for line in subject.failed]
    return lines or ["Nothing: every gate was met."]


def write_report(path: Path, subjects: list[Subject], nanoflann: str, minutes: float) -> None:
    """Write the page; what was there is replaced."""
    skipped = [f"- {subject.title}: {line}." for subject in subjects for line in subject.skipped]
    lines = [
        "<!-- SPDX-License-Identifier: Apache-2.0; written by tests/benchmarks/run.py, not by hand -->",
        "# Benchmarks",
        "",
        f"Peer and ours in turn (A B A B …), in one run, on the same data, on all cores unless a note says otherwise: "
        f"one warm-up, then {PAIRS} pairs or more; figures are medians. The ratio is our speed over the peer's, median "
        "of the pairs (least–most): above 1 ours is faster.",
        "",
        f"- Machine: {describe_machine()}.",
        f"- Versions: {describe_versions(nanoflann)}.",
        f"- The whole run took {minutes:.1f} minutes, {subjects_with_rows(subjects)} of {len(subjects)} subjects with "
        "figures. Reproduce it with",
        "",
        COMMANDS,
        "",
        "  One subject alone: the same with its own script. The truth of the caustic is kept in the temporary folder.",
        "",
        "## Not met",
        "",
        *list_unmet(subjects),
        "",
        "## Peers skipped",
        "",
        *(skipped or ["None."]),
    ]
    for subject in subjects:
        lines += ["", f"## {subject.title}", ""]
        for note in subject.notes:
            lines += [note, ""]
        if subject.rows:
            lines += [HEAD, *(format_row(row) for row in subject.rows)]
        else:
            lines.append("No figures.")
    path.parent.mkdir(exist_ok=True)
    path.write_text("\n".join(lines) + "\n", encoding="utf-8")


def subjects_with_rows(subjects: list[Subject]) -> int:
    """Count the subjects that have figures."""
    return sum(bool(subject.rows) for subject in subjects)
