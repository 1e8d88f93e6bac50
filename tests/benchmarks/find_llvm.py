# SPDX-License-Identifier: Apache-2.0
"""Finds an LLVM library on which Dr.Jit runs."""

from __future__ import annotations

import os
import re
from pathlib import Path

from measure import is_installed

OLDEST_LLVM = 17  # 15 and 16 abort on AVX-512 machines
VARIABLE = "DRJIT_LIBLLVM_PATH"


def find_llvm() -> str:
    """Point Dr.Jit at a Debian LLVM that works; returns why there is none, or nothing."""
    if not is_installed("mitsuba"):
        return "the package mitsuba is not installed (pip install '.[bench]')"
    if VARIABLE not in os.environ:
        found = {
            int(match[1]): str(path)
            for path in Path("/usr/lib").glob("*/libLLVM-*.so")
            if (match := re.fullmatch(r"libLLVM-(\d+)\.so", path.name)) and int(match[1]) >= OLDEST_LLVM
        }
        if not found:
            return f"no LLVM of {OLDEST_LLVM} or newer (apt-get install libllvm19, or set {VARIABLE})"
        os.environ[VARIABLE] = found[max(found)]
    return ""
