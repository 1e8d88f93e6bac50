# SPDX-License-Identifier: Apache-2.0
"""Where kernels are read: beside the extension module, or where they stand in a source tree that is used in place."""

import os
from pathlib import Path


def use_kernels_in_place() -> None:
    """In an editable install, read kernels where they are edited, unless PHOTONLOUPE_SHADER_DIR names other folders."""
    root = Path(__file__).resolve().parents[2]
    if (root / "CMakeLists.txt").is_file() and (root / "shaders").is_dir():
        os.environ.setdefault("PHOTONLOUPE_SHADER_DIR", str(root / "shaders"))
