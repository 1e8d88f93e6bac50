# SPDX-License-Identifier: Apache-2.0
"""Runs every benchmark in one process and writes docs/benchmarks.md."""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from pathlib import Path

import build_tree
import caustic_error
import estimate_irradiance
import find_neighbors
import first_picture
import parallel_coordinates
import relax
import run_scripts
import start_up
import studio_frames
import trace_paths
from measure import Subject, print_subject
from peer_nanoflann import Nanoflann
from report import write_report

PAGE = Path(__file__).resolve().parents[2] / "docs" / "benchmarks.md"
SUBJECTS: dict[str, Callable[[], Subject]] = {
    "trace_paths": trace_paths.measure,
    "build_tree": build_tree.measure,
    "find_neighbors": find_neighbors.measure,
    "estimate_irradiance": estimate_irradiance.measure,
    "run_scripts": run_scripts.measure,
    "relax": relax.measure,
    "parallel_coordinates": parallel_coordinates.measure,
    "studio_frames": studio_frames.measure,
    "caustic_error": caustic_error.measure,
    "start_up": start_up.measure,
    "first_picture": first_picture.measure,
}


def find_nanoflann_version() -> str:
    """Return the version of the header, "" without one."""
    program = Nanoflann()
    found = program.version
    program.close()
    return found


def main() -> None:
    """Measure, show, write."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("-o", "--output", type=Path, default=PAGE, help="the page to write")
    arguments = parser.parse_args()
    start = time.perf_counter()
    subjects = []
    for name, measure in SUBJECTS.items():
        try:
            subject = measure()
        except Exception as error:
            subject = Subject(name, failed=[f"stopped with {type(error).__name__}: {error}"])
        subjects.append(subject)
        print_subject(subject)
    write_report(arguments.output, subjects, find_nanoflann_version(), (time.perf_counter() - start) / 60.0)


if __name__ == "__main__":
    main()
