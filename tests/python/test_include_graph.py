# SPDX-License-Identifier: Apache-2.0
"""The engine's folders include each other one way only.

A folder's files are one room. Where a folder holds further rooms, the files beside them are each their own, a header
with its source: `program.h` lies below all rooms of the language and `compile_script.cpp` above them.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from conftest import SCENES
from graph_cycles import name_cycle

ENGINE = SCENES.parent / "engine"

# Of each file, from the engine's folder on, what it includes.
Includes = dict[str, list[str]]


def read_includes(root: Path) -> Includes:
    sources = [path for path in root.rglob("*") if path.suffix in {".h", ".cpp"}]
    found = {path: re.findall(r'^\s*#\s*include\s+"([^"]+)"', path.read_text(), re.MULTILINE) for path in sources}
    return {path.relative_to(root).as_posix(): included for path, included in found.items()}


def find_room(file: str, folders: set[str]) -> str:
    path = Path(file)
    folder = path.parent.as_posix()
    has_rooms = any(other.startswith("" if folder == "." else folder + "/") and other != folder for other in folders)
    return path.with_suffix("").as_posix() if has_rooms else folder


def find_cycle(includes: Includes) -> str:
    """Name a cycle of rooms, an include for each of its steps; empty where there is none."""
    folders = {Path(file).parent.as_posix() for file in includes}
    reasons: dict[tuple[str, str], str] = {}
    for file, included in includes.items():
        for other in set(included) & includes.keys():
            step = find_room(file, folders), find_room(other, folders)
            if step[0] != step[1]:
                reasons.setdefault(step, f"{file} includes {other}")
    return name_cycle(reasons)


def test_no_cycle_of_rooms() -> None:
    assert find_cycle(read_includes(ENGINE)) == ""


def test_includes_are_read_with_their_folders(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "a" / "x.h").write_text('#include <vector>\n#include "b/y.h"\n// #include "c/z.h"\n')
    (tmp_path / "a" / "x.txt").write_text('#include "b/y.h"\n')
    assert read_includes(tmp_path) == {"a/x.h": ["b/y.h"]}


@pytest.mark.parametrize(
    "includes",
    [
        {"a/x.h": ["b/y.h"], "b/y.h": [], "b/z.cpp": ["b/y.h"]},
        {"a/x.h": ["shared/layout.h"]},
        {"s/top.cpp": ["s/a/x.h"], "s/a/x.h": ["s/base.h"], "s/base.h": []},
    ],
    ids=["one way", "outside", "above and below rooms"],
)
def test_one_way_has_no_cycle(includes: Includes) -> None:
    assert find_cycle(includes) == ""


def test_cycle_of_folders_is_named_with_its_includes() -> None:
    includes = {"a/x.h": ["b/y.h"], "b/y.h": [], "b/z.cpp": ["c/w.h"], "c/w.h": ["a/x.h"]}
    found = find_cycle(includes)
    rooms, steps = found.split(": ")
    assert rooms in {"a → b → c → a", "b → c → a → b", "c → a → b → c"}
    assert set(steps.split("; ")) == {"a/x.h includes b/y.h", "b/z.cpp includes c/w.h", "c/w.h includes a/x.h"}


@pytest.mark.parametrize(
    "includes",
    [
        {"s/top.h": ["s/a/x.h"], "s/a/x.h": ["s/top.h"]},
        {"s/top.h": [], "s/top.cpp": ["s/a/x.h"], "s/a/x.h": ["s/top.h"]},
        {"top.h": ["a/x.h"], "a/x.h": ["top.h"]},
    ],
    ids=["header", "header with its source", "outermost"],
)
def test_cycle_through_a_file_beside_rooms_is_found(includes: Includes) -> None:
    assert "top" in find_cycle(includes)
