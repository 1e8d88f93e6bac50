# SPDX-License-Identifier: Apache-2.0
"""Times the demo from its start to its first picture: from an empty cache, where kernels are compiled, and a full."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
import time
from pathlib import Path

from measure import Row, Subject, compare_speed, find_median, format_seconds, print_subject

ROOT = Path(__file__).resolve().parents[2]
PAIRS = 3
FRESH_GATE = 5.0  # s, our gate
POLL = 0.002  # s
DEADLINE = 120.0  # s


def time_first_picture(cache: Path, ahead: bool) -> float:
    """Seconds from the start of the launcher to the first finished PNG; the rest of the demo is cut off."""
    environment = {
        name: value
        for name, value in os.environ.items()
        if name not in ("PHOTONLOUPE_CACHE_DIR", "MESA_SHADER_CACHE_DIR", "PHOTONLOUPE_COMPILE_AHEAD")
    }
    environment["XDG_CACHE_HOME"] = str(cache)
    if not ahead:
        environment["PHOTONLOUPE_COMPILE_AHEAD"] = "0"
    with tempfile.TemporaryDirectory() as folder:
        start = time.perf_counter()
        with subprocess.Popen(
            [str(ROOT / "photonloupe"), "demo", "-o", folder],
            env=environment,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        ) as demo:
            while not any(Path(folder).glob("*.png")):
                if demo.poll() is not None or time.perf_counter() - start > DEADLINE:
                    demo.kill()
                    raise RuntimeError("the demo wrote no picture")
                time.sleep(POLL)
            seconds = time.perf_counter() - start
            demo.send_signal(signal.SIGINT)
    return seconds


def measure() -> Subject:
    """Both ways in turn, each from a cache of its own."""
    subject = Subject("First picture")
    subject.notes.append(
        f"`./photonloupe demo` from its start to the first PNG, median of {PAIRS} pairs; the peer is the same program "
        "that compiles each kernel where it is used (PHOTONLOUPE_COMPILE_AHEAD=0). An empty cache has neither our "
        "SPIR-V nor the driver's machine code."
    )
    seconds: dict[tuple[str, bool], list[float]] = {}
    for _ in range(PAIRS):
        for ahead in (False, True):
            with tempfile.TemporaryDirectory() as cache:
                for state in ("empty", "full"):
                    seconds.setdefault((state, ahead), []).append(time_first_picture(Path(cache), ahead))
    for state in ("empty", "full"):
        before, after = seconds[state, False], seconds[state, True]
        gate = state == "empty"
        subject.rows.append(
            Row(
                f"first picture, {state} cache",
                "compiled where used",
                format_seconds(find_median(before)),
                format_seconds(find_median(after)),
                str(compare_speed(before, after)),
                f"< {FRESH_GATE:g} s" if gate else "—",
                find_median(after) < FRESH_GATE if gate else None,
            )
        )
    return subject


if __name__ == "__main__":
    subprocess.run([str(ROOT / "photonloupe"), "--help"], check=True, stdout=subprocess.DEVNULL)  # sets up
    print_subject(measure())
