# SPDX-License-Identifier: Apache-2.0
"""clang-tidy over the engine's sources; one that passed is not read again until it, a header or a check changes."""

from __future__ import annotations

import hashlib
import json
import os
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
BUILD = ROOT / "build" / "wheel"
DATABASE = BUILD / "compile_commands.json"
PASSED = ROOT / "build" / "lint" / "tidy.json"
# Reading a source with its headers costs seconds: the whole engine would take twice the two minutes that CI has for it.
LEFT_OUT = ("studio", "inspect")


def list_sources() -> dict[str, str]:
    """The compile commands of what is read, by source."""
    left_out = [ROOT / "engine" / name for name in LEFT_OUT]
    rows = json.loads(DATABASE.read_text())
    return {
        row["file"]: row["command"]
        for row in rows
        if Path(row["file"]).is_relative_to(ROOT / "engine")
        and not any(Path(row["file"]).is_relative_to(folder) for folder in left_out)
    }


def list_headers() -> dict[str, list[str]]:
    """The project's files that each source was built of, as the build noted them."""
    noted = subprocess.run(["ninja", "-C", str(BUILD), "-t", "deps"], check=True, capture_output=True, text=True).stdout
    found: dict[str, list[str]] = {}
    for block in noted.split("\n\n"):
        paths = [(BUILD / line.strip()).resolve() for line in block.splitlines() if line.startswith(" ")]
        own = sorted(str(path) for path in set(paths) if path.is_relative_to(ROOT) and path.is_file())
        for path in own:
            if path.endswith(".cpp"):
                found[path] = own
    return found


def hash_source(command: str, files: list[str], tool: str) -> str:
    """Hash all that decides what the tool says of a source."""
    state = hashlib.sha256((tool + command).encode())
    for path in [str(ROOT / ".clang-tidy"), *files]:
        state.update(Path(path).read_bytes())
    return state.hexdigest()


def tidy(tool: str, source: str) -> str:
    """Everything clang-tidy has to say of a source; empty: nothing."""
    # GCC's own switches mean nothing to it, and GCC's library calls what it deprecates.
    switches = ["--extra-arg=-Wno-unknown-warning-option", "--extra-arg=-Wno-deprecated-declarations"]
    command = [tool, "-p", str(BUILD), "--quiet", *switches, source]
    done = subprocess.run(command, cwd=ROOT, check=False, capture_output=True, text=True)
    return done.stdout + (done.stderr if done.returncode and not done.stdout else "")


def tidy_sources(tool: str) -> bool:
    """Read what changed since it last passed; False: something was found, and printed."""
    version = subprocess.run([tool, "--version"], check=True, capture_output=True, text=True).stdout
    headers = list_headers()
    hashes = {
        source: hash_source(command, headers.get(source, [source]), version)
        for source, command in list_sources().items()
    }
    passed = set(json.loads(PASSED.read_text())) if PASSED.is_file() else set()
    changed = [source for source, state in hashes.items() if state not in passed]
    print(f"  {len(changed)} of {len(hashes)} sources changed", flush=True)
    with ThreadPoolExecutor(int(os.environ.get("CMAKE_BUILD_PARALLEL_LEVEL", "2"))) as pool:
        found = dict(zip(changed, pool.map(lambda source: tidy(tool, source), changed), strict=True))
    print("".join(found.values()), end="")
    PASSED.parent.mkdir(parents=True, exist_ok=True)
    PASSED.write_text(json.dumps(sorted(state for source, state in hashes.items() if not found.get(source))))
    return not any(found.values())
