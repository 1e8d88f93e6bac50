# SPDX-License-Identifier: Apache-2.0
"""Times the start: importing the package, and the launcher's own share of a command."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from measure import Row, Subject, compare_speed, find_median, format_seconds, print_subject, time_in_turn

ROOT = Path(__file__).resolve().parents[2]
PAIRS = 7
IMPORT_GATE = 0.5  # s, our gate


def run(*command: str) -> None:
    """Run a command to its end, its output thrown away."""
    subprocess.run(command, check=True, cwd=ROOT, stdout=subprocess.DEVNULL)


def measure() -> Subject:
    """Whole processes, from the start of Python to its end."""
    subject = Subject("Start-up")
    subject.notes.append(f"Whole processes, median of {PAIRS} pairs. The gate holds for the whole process.")
    python = sys.executable
    # The launcher runs its own environment's Python: the command beside it must too.
    own_python = ROOT / ".venv" / "bin" / "python"
    beside = str(own_python) if own_python.exists() else python
    seconds = time_in_turn(
        {
            "nothing": lambda _: run(python, "-c", "pass"),
            "numpy": lambda _: run(python, "-c", "import numpy"),
            "ours": lambda _: run(python, "-c", "import photonloupe"),
            "module": lambda _: run(beside, "-P", "-m", "photonloupe", "--help"),
            "launcher": lambda _: run(str(ROOT / "photonloupe"), "--help"),
        },
        PAIRS,
    )
    median = {name: find_median(values) for name, values in seconds.items()}
    own = median["ours"] - median["nothing"]
    ratio = compare_speed(seconds["numpy"], seconds["ours"])
    subject.rows.append(
        Row(
            "`import photonloupe`",
            "`import numpy`",
            format_seconds(median["numpy"]),
            f"{format_seconds(median['ours'])}, of it {format_seconds(own)} after Python's own start",
            str(ratio),
            "< 0.5 s",
            median["ours"] < IMPORT_GATE,
        )
    )
    ratio = compare_speed(seconds["module"], seconds["launcher"])
    subject.rows.append(
        Row(
            "`./photonloupe --help`",
            "`python -m photonloupe --help`",
            format_seconds(median["module"]),
            f"{format_seconds(median['launcher'])} (difference "
            f"{(median['launcher'] - median['module']) * 1e3:+.0f} ms)",
            str(ratio),
        )
    )
    return subject


if __name__ == "__main__":
    print_subject(measure())
