# SPDX-License-Identifier: Apache-2.0
"""Times every stage of the main flow in this checkout and another one, turn by turn.

`./photonloupe python tests/benchmarks/stages.py OTHER`, where OTHER is a command that runs Python with the other
checkout, such as `/elsewhere/photonloupe python`.
"""

from __future__ import annotations

import argparse
import json
import shlex
import statistics
import subprocess
import sys
import time
from pathlib import Path

ROUNDS = 4
PHOTONS = 200_000


def time_stages(seed: int) -> dict[str, float]:
    """Seconds of each stage on the ring, with photons that nothing remembers."""
    import numpy as np  # noqa: PLC0415 - in the child alone

    import photonloupe as pl  # noqa: PLC0415

    seconds: dict[str, float] = {}

    def measure(stage: str, start: float) -> None:
        seconds[stage] = time.perf_counter() - start

    start = time.perf_counter()
    scene = pl.load_scene("scenes/ring/ring.gltf")
    measure("load", start)
    pl.render(scene, pl.trace_photons(scene, 20_000, columns=["path_vertices"]), width=64, height=64)  # kernels
    start = time.perf_counter()
    photons = pl.trace_photons(scene, PHOTONS, seed=seed, columns=["path_vertices"])
    measure("trace", start)
    script = Path("scenes/scripts/primal_trajectory.photon")
    photons.run_script(script)
    start = time.perf_counter()
    photons.run_script(script, seed=seed)
    measure("script", start)
    points = np.random.default_rng(seed).uniform(-1.0, 1.0, (100_000, 3)) * [1, 0, 1]
    start = time.perf_counter()
    photons.neighbors(points[:100], 10)
    measure("tree", start)
    start = time.perf_counter()
    photons.neighbors(points, 50)
    measure("neighbors", start)
    start = time.perf_counter()
    photons.irradiance(points, [0, 1, 0], k=50)
    measure("irradiance", start)
    start = time.perf_counter()
    photons.relax(5, beta=10.0)
    measure("relax", start)
    start = time.perf_counter()
    pl.render(scene, photons, camera="view", width=256, height=256, samples=4)
    measure("render", start)
    return seconds


def main() -> None:
    """Run both sides in turn and print medians and ratios."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("other", nargs="?", help="command that runs Python with the other checkout")
    parser.add_argument("--child", type=int, metavar="SEED", help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.child is not None:
        print(json.dumps(time_stages(arguments.child)))
        return
    commands = {"this": [sys.executable]} | ({"other": shlex.split(arguments.other)} if arguments.other else {})
    runs: dict[str, list[dict[str, float]]] = {name: [] for name in commands}
    for seed in range(1, ROUNDS + 1):
        for name, command in commands.items():
            child = [*command, str(Path(__file__).resolve()), "--child", str(seed)]
            text = subprocess.run(child, check=True, capture_output=True, text=True).stdout
            runs[name].append(json.loads(text.splitlines()[-1]))
    print("| stage | " + " | ".join(f"{name}, s" for name in commands) + (" | ratio |" if arguments.other else " |"))
    print("|---" * (len(commands) + (2 if arguments.other else 1)) + "|")
    for stage in runs["this"][0]:
        times = [statistics.median(run[stage] for run in runs[name]) for name in commands]
        ratio = f" | {times[0] / times[1]:.2f}" if arguments.other else ""
        print(f"| {stage} | " + " | ".join(f"{value:.3f}" for value in times) + ratio + " |")


if __name__ == "__main__":
    main()
