# SPDX-License-Identifier: Apache-2.0
"""nanoflann as a small C++ program that is compiled here and then answers over a pipe."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

SOURCE = Path(__file__).with_name("nanoflann_peer.cpp")
FLAGS = ("-std=c++17", "-O3", "-march=native", "-pthread")
DEADLINE = 120.0  # s, for the compiler


class Nanoflann:
    """The running program; `reason` says why it could not be had."""

    def __init__(self) -> None:
        self.reason = ""
        self.version = ""
        self._folder = tempfile.TemporaryDirectory(prefix="photonloupe-nanoflann-")
        self._program: subprocess.Popen[str] | None = None
        compiler = shutil.which("g++")
        if compiler is None:
            self.reason = "no g++"
            return
        binary = Path(self._folder.name) / "nanoflann_peer"
        made = subprocess.run(
            [compiler, *FLAGS, str(SOURCE), "-o", str(binary)],
            capture_output=True,
            text=True,
            timeout=DEADLINE,
            check=False,
        )
        if made.returncode != 0:
            missing = "nanoflann.hpp: No such file" in made.stderr
            self.reason = "no header (apt-get install libnanoflann-dev)" if missing else "g++ refused the program"
            return
        self._program = subprocess.Popen([str(binary)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.version = self._read()

    def load(self, positions: NDArray[np.float32]) -> None:
        """Hand over positions (n, 3); builds no tree."""
        path = Path(self._folder.name) / "positions.bin"
        np.ascontiguousarray(positions, dtype=np.float32).tofile(path)
        self._ask(f"load {path}")

    def build(self) -> float:
        """Seconds to build the tree, on one core: this version's builder has no threads."""
        return self._ask("build -")[0]

    def find(self, k: int) -> tuple[float, float]:
        """Seconds for the k nearest of every photon on all cores; mean distance, the photon itself (0) included."""
        return self._ask(f"knn {k}")

    def close(self) -> None:
        """End the program."""
        if self._program is not None and self._program.stdin is not None:
            self._program.stdin.close()
            self._program.wait()
        self._folder.cleanup()

    def _ask(self, line: str) -> tuple[float, float]:
        if self._program is None or self._program.stdin is None:
            raise RuntimeError(f"nanoflann is not there: {self.reason}")
        self._program.stdin.write(line + "\n")
        self._program.stdin.flush()
        seconds, mean = self._read().split()
        return float(seconds), float(mean)

    def _read(self) -> str:
        if self._program is None or self._program.stdout is None:
            return ""
        return self._program.stdout.readline().strip()
