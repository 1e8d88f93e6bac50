# SPDX-License-Identifier: Apache-2.0
"""The package's modules import each other one way only, wherever the import stands.

Imports within functions and those for annotations count too: what is needed to read a module lies below it. That every
import of `photonloupe.x` runs the package's ``__init__`` does not count; naming the package itself does.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

from conftest import SCENES
from graph_cycles import name_cycle

PYTHON = SCENES.parent / "python"

Modules = dict[str, str]


def read_modules(root: Path) -> Modules:
    """Read the text of every module by its name; stubs stand for what is compiled."""
    modules: Modules = {}
    for path in (*root.rglob("*.py"), *root.rglob("*.pyi")):
        names = path.relative_to(root).with_suffix("").parts
        package = names[:-1] if names[-1] == "__init__" else names
        modules[".".join(package)] = path.read_text()
    return modules


def list_imports(text: str, modules: Modules) -> Iterator[tuple[int, str]]:
    """List line and module of all imports of `modules`; those that name a thing in a module import the module."""
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            assert node.level == 0, f"line {node.lineno}: imports name the package, they are not relative"
            whole = [f"{node.module}.{alias.name}" for alias in node.names]
            names = [name if name in modules else str(node.module) for name in whole]
        else:
            continue
        yield from ((node.lineno, name) for name in names if name in modules)


def find_cycle(modules: Modules) -> str:
    """Name a cycle of modules, an import for each of its steps; empty where there is none."""
    reasons: dict[tuple[str, str], str] = {}
    for user, text in modules.items():
        for line, used in list_imports(text, modules):
            if used != user:
                reasons.setdefault((user, used), f"{user} line {line} imports {used}")
    return name_cycle(reasons)


def test_no_cycle_of_modules() -> None:
    assert find_cycle(read_modules(PYTHON)) == ""


def test_modules_have_the_names_that_imports_use(tmp_path: Path) -> None:
    (tmp_path / "p" / "inner").mkdir(parents=True)
    for name in ("p/__init__.py", "p/a.py", "p/_c.pyi", "p/inner/__init__.py", "p/inner/b.py", "p/notes.txt"):
        (tmp_path / name).write_text("")
    assert set(read_modules(tmp_path)) == {"p", "p.a", "p._c", "p.inner", "p.inner.b"}


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("import p.a", ["p.a"]),
        ("import numpy as np, p as q", ["p"]),
        ("from p import a, b", ["p.a", "p"]),
        ("from p.a import thing", ["p.a"]),
        ("def f():\n    from p import a", ["p.a"]),
        ("if TYPE_CHECKING:\n    from p.a import Thing", ["p.a"]),
        ('"""\n>>> import p.a\n"""', []),
    ],
    ids=["module", "package", "from package", "from module", "in a function", "for annotations", "in an example"],
)
def test_import_is_found(text: str, expected: list[str]) -> None:
    assert [name for _, name in list_imports(text, {"p": "", "p.a": ""})] == expected


def test_one_way_has_no_cycle() -> None:
    modules = {"p": "from p.top import run", "p.top": "from p import low", "p.low": "import os"}
    assert find_cycle(modules) == ""


@pytest.mark.parametrize(
    "back",
    ["from p import a", "def f():\n    import p.a", "if TYPE_CHECKING:\n    from p.a import A"],
    ids=["at the top", "in a function", "for annotations"],
)
def test_cycle_is_named_with_its_imports(back: str) -> None:
    found = find_cycle({"p": "", "p.a": "from p.b import B", "p.b": "\nfrom p import c", "p.c": back})
    modules, steps = found.split(": ")
    assert modules in {"p.a → p.b → p.c → p.a", "p.b → p.c → p.a → p.b", "p.c → p.a → p.b → p.c"}
    last = f"p.c line {back.count(chr(10)) + 1} imports p.a"
    assert set(steps.split("; ")) == {"p.a line 1 imports p.b", "p.b line 2 imports p.c", last}


def test_module_that_imports_its_package_is_found() -> None:
    assert "p.a line 1 imports p" in find_cycle({"p": "from p.a import A", "p.a": "import p as q"})
