# SPDX-License-Identifier: Apache-2.0
"""Importing the package is quick and asks nothing of the machine."""

from __future__ import annotations

import os
import subprocess
import sys
from inspect import isfunction
from types import ModuleType

import pytest

import photonloupe as pl

IMPORT_SECONDS = 0.5
PRINT_BEST_IMPORT = "import time; t = time.perf_counter(); import photonloupe; print(time.perf_counter() - t)"


def run_python(program: str, **environment: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", program],
        capture_output=True,
        text=True,
        check=False,
        timeout=60,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path), **environment},
    )
    assert done.returncode == 0, done.stderr
    return done.stdout.strip()


def test_import_is_quick() -> None:
    # The best of five: the others measure what else the machine does.
    assert min(float(run_python(PRINT_BEST_IMPORT)) for _ in range(5)) < IMPORT_SECONDS


@pytest.mark.parametrize("module", ["zarr", "pyarrow", "PIL", "tqdm", "flip_evaluator", "scipy"])
def test_import_leaves_heavy_modules_alone(module: str) -> None:
    assert run_python(f"import sys, photonloupe; print({module!r} in sys.modules)") == "False"


def test_import_works_without_vulkan() -> None:
    # No driver is listed, so the loader finds no device; none is looked for before it is needed.
    assert run_python("import photonloupe; print('ok')", VK_ICD_FILENAMES="", VK_DRIVER_FILES="") == "ok"


def test_without_a_driver_the_error_says_so() -> None:
    program = (
        "import photonloupe as pl\ntry:\n pl.Device()\nexcept pl.DeviceError as error:\n print('DeviceError', error)"
    )
    nowhere = "/nonexistent/driver.json"
    assert run_python(program, VK_ICD_FILENAMES=nowhere, VK_DRIVER_FILES=nowhere).startswith("DeviceError")


@pytest.mark.parametrize("name", pl.__all__)
def test_public_name_is_there(name: str) -> None:
    assert hasattr(pl, name)


@pytest.mark.parametrize("module", [pl, pl.inspect])
def test_public_functions_are_documented(module: ModuleType) -> None:
    functions = [getattr(module, name) for name in module.__all__ if isfunction(getattr(module, name))]
    assert functions
    assert [function.__name__ for function in functions if "Returns" not in (function.__doc__ or "")] == []


@pytest.mark.parametrize("error", [pl.SceneError, pl.ScriptError, pl.DeviceError, pl.ArgumentError, pl.FileFormatError])
def test_every_error_has_the_base(error: type[Exception]) -> None:
    assert issubclass(error, pl.PhotonLoupeError)
