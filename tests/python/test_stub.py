# SPDX-License-Identifier: Apache-2.0
"""The extension's stub in the repository is the one its bindings generate."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

STUB = Path(__file__).parents[2] / "python" / "photonloupe" / "_engine.pyi"


def test_committed_stub_is_the_generated_one(tmp_path: Path) -> None:
    made = tmp_path / "_engine.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "photonloupe._engine", "-o", str(made)]
    subprocess.run(command, check=True, timeout=60)
    assert made.read_text() == STUB.read_text(), (
        "the bindings changed; write the stub anew: "
        "./photonloupe python -m nanobind.stubgen -m photonloupe._engine -o python/photonloupe/_engine.pyi"
    )
