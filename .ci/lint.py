# SPDX-License-Identifier: Apache-2.0
"""The static checks, all of them or those named: ./photonloupe lint [--fix] [CHECK …]."""

from __future__ import annotations

import argparse
import shutil
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import tidy

ROOT = Path(__file__).resolve().parents[1]
TOOLS = Path(sys.executable).parent
SHELL_SCRIPTS = ("photonloupe", ".ci/run")
LONGEST_FILE = 500  # lines; a longer one holds more than one concept
CURE = "remove build/launcher/checks and run ./photonloupe lint, which installs python/requirements-checks.txt"


class MissingToolError(Exception):
    """A check cannot run; the message names the cure."""


def find_tool(name: str) -> str:
    tool = TOOLS / name
    if not tool.is_file():
        raise MissingToolError(f"{tool} is missing; {CURE}")
    return str(tool)


def run(*command: str) -> bool:
    return subprocess.run(command, cwd=ROOT, check=False).returncode == 0


def list_files(*patterns: str) -> list[str]:
    """List files of the repository, new ones too, less those that are deleted."""
    command = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "-z", "--", *patterns]
    listed = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return sorted({name for name in listed.split("\0") if name and (ROOT / name).is_file()})


def check_ruff() -> bool:
    return run(sys.executable, "-m", "ruff", "check", ".")


def check_ruff_format() -> bool:
    return run(sys.executable, "-m", "ruff", "format", "--check", ".")


def check_types() -> bool:
    return run(sys.executable, "-m", "pyright")


def list_formatted() -> list[str]:
    return list_files("engine/*.cpp", "engine/*.h", "bindings/*.cpp", "bindings/*.h", "tests/*.cpp", "tests/*.h")


def check_clang_format() -> bool:
    return run(find_tool("clang-format"), "--dry-run", "--Werror", *list_formatted())


def check_clang_tidy() -> bool:
    if not tidy.DATABASE.is_file():
        raise MissingToolError(f"{tidy.DATABASE} is missing; remove build/launcher/built and run ./photonloupe lint")
    return tidy.tidy_sources(find_tool("clang-tidy"))


def check_bash() -> bool:
    bash = shutil.which("bash")
    if bash is None:
        raise MissingToolError("bash is missing; install the package bash")
    return all([run(bash, "-n", script) for script in SHELL_SCRIPTS])  # noqa: C419 - every script is checked


def check_shellcheck() -> bool:
    return run(find_tool("shellcheck"), *SHELL_SCRIPTS)


def check_lengths() -> bool:
    counts = {
        name: (ROOT / name).read_bytes().count(b"\n")
        for name in list_files("*.cpp", "*.h", "*.py", "*.comp", "*.glsl", *SHELL_SCRIPTS)
    }
    long = {name: count for name, count in counts.items() if count > LONGEST_FILE}
    for name, count in long.items():
        print(f"  {name}: {count} lines, {LONGEST_FILE} at most")
    return not long


CHECKS: dict[str, Callable[[], bool]] = {
    "ruff": check_ruff,
    "ruff-format": check_ruff_format,
    "pyright": check_types,
    "clang-format": check_clang_format,
    "clang-tidy": check_clang_tidy,
    "bash": check_bash,
    "shellcheck": check_shellcheck,
    "lengths": check_lengths,
}


def write_generated() -> bool:
    """Write anew what comes from the engine: the manuals' tables, the types of keywords, the stub of the bindings."""
    stub = ("-m", "nanobind.stubgen", "-m", "photonloupe._engine", "-o", "python/photonloupe/_engine.pyi", "--quiet")
    return all((run(sys.executable, "tests/python/manual_tables.py"), run(sys.executable, *stub)))


def fix() -> bool:
    """Write anew what tools can mend: formatting, and what ruff knows the cure of."""
    ruff = (sys.executable, "-m", "ruff")
    return all(
        (
            run(*ruff, "check", "--fix", "--quiet", "."),
            run(*ruff, "format", "--quiet", "."),
            run(find_tool("clang-format"), "-i", *list_formatted()),
        )
    )


def run_check(name: str) -> bool:
    print(f"== {name}", flush=True)
    start = time.monotonic()
    try:
        passed = CHECKS[name]()
    except MissingToolError as error:
        print(f"  {error}")
        passed = False
    print(f"== {name} {'passed' if passed else 'FAILED'} in {time.monotonic() - start:.1f} s", flush=True)
    return passed


def main() -> int:
    """Run the checks and say which failed; every one runs, whatever the others find."""
    parser = argparse.ArgumentParser(prog="photonloupe lint", description="Run the static checks.")
    parser.add_argument("checks", nargs="*", metavar="CHECK", help=f"of {', '.join(CHECKS)}; default: all")
    parser.add_argument(
        "--fix", action="store_true", help="first write what is generated, format all, mend what ruff can"
    )
    options = parser.parse_args()
    unknown = set(options.checks) - CHECKS.keys()
    if unknown:
        parser.error(f"no check is called {', '.join(sorted(unknown))}; there are {', '.join(CHECKS)}")
    failed = []
    if options.fix:
        failed += [] if write_generated() else ["what is generated"]
        fix()
    failed += [name for name in options.checks or CHECKS if not run_check(name)]
    if failed:
        print(f"== lint FAILED: {', '.join(failed)}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
