# SPDX-License-Identifier: Apache-2.0
"""The launcher: what it sets up, when it does it again, and what it says when a step fails.

It runs in a small tree with stand-ins for apt, dpkg and Python, which write down how they were called.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from pathlib import Path

import pytest

from conftest import SCENES

# Logs its arguments; `-m venv X` copies it to X/bin/python; fails, with CODE, where FAIL matches the arguments.
FAKE_PYTHON = """#!/bin/bash
echo "$*" >> "$LOG"
if [ -n "${FAIL:-}" ] && [[ "$*" == *"$FAIL"* ]]; then echo "the reason"; exit "${CODE:-1}"; fi
case "$*" in
  *"-m venv "*) mkdir -p "${@: -1}/bin"; cp "$0" "${@: -1}/bin/python" ;;
  *"-m photonloupe"*) echo "ran $*" ;;
esac
"""
# Logs its arguments; holds the tests NAMES.
FAKE_TESTS = """#!/bin/bash
echo "tests $*" >> "$LOG"
[[ "$*" != *--gtest_list_tests* ]] || printf '%s\\n' "Suite." ${NAMES:+"  $NAMES"}
exit "${CPP:-0}"
"""
FAKE_DPKG = """#!/bin/bash
for name in "${@:3}"; do [[ " $MISSING " == *" $name "* ]] || echo "$name installed"; done
"""
FAKE_APT = """#!/bin/bash
echo "apt-get $*" >> "$LOG"
[ "$1" = update ] || ! [ -n "${STALE:-}" ] || grep -q "apt-get update" "$LOG"
"""


class Tree:
    """A repository in miniature, with its launcher and the stand-ins."""

    def __init__(self, folder: Path) -> None:
        self.root = folder / "repository"
        self.tools = folder / "tools"
        self.log = folder / "log"
        for name in ("engine", "shaders", "bindings", "python", "cmake", "tests"):
            (self.root / name).mkdir(parents=True)
        (self.root / "engine" / "a.cpp").write_text("int a;")
        (self.root / "engine" / "b.cpp").write_text("int b;")
        (self.root / "python" / "requirements.txt").write_text("numpy\n")
        (self.root / "python" / "requirements-checks.txt").write_text("ruff\n")
        (self.root / "python" / "a.py").write_text("a = 1\n")
        (self.root / "shaders" / "a.comp").write_text("void main() {}\n")
        (self.root / "shaders" / "a.h").write_text("struct A {};\n")
        for name in ("CMakeLists.txt", "pyproject.toml"):
            (self.root / name).write_text("")
        shutil.copy(SCENES.parent / "photonloupe", self.root)
        self.tools.mkdir()
        self.add_tool("python3", FAKE_PYTHON)
        self.add_tool("dpkg-query", FAKE_DPKG)
        self.add_tool("apt-get", FAKE_APT)
        self.add_tool("id", "#!/bin/sh\necho 0\n")

    def add_tool(self, name: str, text: str) -> None:
        (self.tools / name).write_text(text)
        (self.tools / name).chmod(0o755)

    def run(self, *arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
        self.log.write_text("")
        return subprocess.run(
            [str(self.root / "photonloupe"), *arguments],
            capture_output=True,
            text=True,
            check=False,
            timeout=60,
            cwd="/",
            env={
                "PATH": f"{self.tools}:{os.environ['PATH']}",
                "LOG": str(self.log),
                "PHOTONLOUPE_PYTHON": str(self.tools / "python3"),
                **environment,
            },
        )

    def list_steps(self) -> list[str]:
        """What the last call did, in order."""
        marks = {"apt-get": "apt", "-m venv": "venv", "--requirement": "requirements", "--force-reinstall": "wheel"}
        return [step for line in self.log.read_text().splitlines() for mark, step in marks.items() if mark in line]


@pytest.fixture
def tree(tmp_path: Path) -> Tree:
    return Tree(tmp_path)


@pytest.fixture
def ready(tree: Tree) -> Tree:
    assert tree.run("doctor").returncode == 0
    return tree


def test_first_call_sets_up_and_runs(tree: Tree) -> None:
    done = tree.run("render", "a b")
    assert tree.list_steps() == ["venv", "requirements", "wheel"]
    assert done.stdout == "ran -P -m photonloupe render a b\n"


def test_second_call_sets_nothing_up(ready: Tree) -> None:
    assert ready.run("doctor").stderr == ""
    assert ready.list_steps() == []


def test_changed_source_rebuilds_only(ready: Tree) -> None:
    (ready.root / "engine" / "a.cpp").write_text("int changed;")
    ready.run("doctor")
    assert ready.list_steps() == ["wheel"]


@pytest.mark.parametrize("name", ["python/a.py", "shaders/a.comp"])
def test_changed_python_source_or_kernel_builds_nothing(ready: Tree, name: str) -> None:
    assert "--editable" in ready.log.read_text()
    (ready.root / name).write_text("changed")
    ready.run("doctor")
    assert ready.list_steps() == []


@pytest.mark.parametrize("name", ["shaders/a.h", "python/b.py"])
def test_changed_layout_and_new_module_are_built(ready: Tree, name: str) -> None:
    (ready.root / name).write_text("changed")
    ready.run("doctor")
    assert ready.list_steps() == ["wheel"]


def test_deleted_source_rebuilds(ready: Tree) -> None:
    (ready.root / "engine" / "b.cpp").unlink()
    ready.run("doctor")
    assert ready.list_steps() == ["wheel"]


def test_changed_requirements_are_installed_in_the_same_environment(ready: Tree) -> None:
    (ready.root / "python" / "requirements.txt").write_text("numpy\nscipy\n")
    ready.run("doctor")
    assert ready.list_steps() == ["requirements", "wheel"]


def test_moved_repository_still_runs(ready: Tree) -> None:
    ready.root = ready.root.rename(ready.root.with_name("elsewhere"))
    assert ready.run("doctor").returncode == 0


def test_missing_packages_are_installed_alone(tree: Tree) -> None:
    tree.run("doctor", MISSING="ccache libpng-dev")
    assert "apt-get install --yes --no-install-recommends ccache libpng-dev" in tree.log.read_text()
    assert "apt-get update" not in tree.log.read_text()


def test_stale_lists_are_renewed(tree: Tree) -> None:
    assert tree.run("doctor", MISSING="ccache", STALE="yes").returncode == 0
    assert tree.list_steps()[:3] == ["apt", "apt", "apt"]


def test_user_without_root_is_told_the_command(tree: Tree) -> None:
    tree.add_tool("id", "#!/bin/sh\necho 1000\n")
    tree.add_tool("sudo", "#!/bin/sh\nexit 1\n")
    done = tree.run("doctor", MISSING="ccache")
    assert done.returncode == 2
    assert "apt-get update && apt-get install --yes --no-install-recommends ccache" in done.stderr


@pytest.mark.parametrize("step", ["-m venv", "--requirement", "--force-reinstall"])
def test_failed_step_shows_its_log(tree: Tree, step: str) -> None:
    done = tree.run("doctor", FAIL=step)
    assert done.returncode == 2
    assert "the reason" in done.stderr
    assert ".log" in done.stderr


def test_failed_build_is_tried_again(tree: Tree) -> None:
    tree.run("doctor", FAIL="--force-reinstall")
    assert tree.run("doctor").returncode == 0
    assert tree.list_steps() == ["wheel"]


def test_python_is_the_environments(ready: Tree) -> None:
    ready.run("python", "-c", "1 + 1")
    assert ready.log.read_text() == "-c 1 + 1\n"


def test_old_python_is_refused(tree: Tree) -> None:
    done = tree.run("doctor", FAIL="sys.version_info")
    assert done.returncode == 2
    assert "PHOTONLOUPE_PYTHON" in done.stderr


@pytest.fixture
def built(ready: Tree) -> Tree:
    tests = ready.root / "build" / "wheel" / "photonloupe_tests"
    tests.parent.mkdir(parents=True, exist_ok=True)
    tests.write_text(FAKE_TESTS)
    tests.chmod(0o755)
    return ready


@pytest.mark.parametrize(("cpp", "python", "code"), [(0, "", 0), (1, "", 1), (0, "-m pytest", 1)])
def test_test_fails_where_either_suite_does(built: Tree, cpp: int, python: str, code: int) -> None:
    assert built.run("test", "-q", CPP=str(cpp), FAIL=python).returncode == code


@pytest.mark.parametrize(("words", "patterns"), [("tree", "*tree*"), ("tree or knn", "*tree*:*knn*")])
def test_test_selects_by_word_in_both_suites(built: Tree, words: str, patterns: str) -> None:
    assert built.run("test", "-k", words, "-x").returncode == 0
    assert built.log.read_text().splitlines() == [
        f"tests --gtest_brief=1 --gtest_filter={patterns}",
        f"-P -m pytest -k {words} -x",
    ]


@pytest.mark.parametrize("arguments", [["-k"], ["-k", "a and b"], ["-k", "not a"], ["-k", "a[1]"]])
def test_test_refuses_what_only_one_suite_could_select(built: Tree, arguments: list[str]) -> None:
    done = built.run("test", *arguments)
    assert done.returncode == 2
    assert "test -k" in done.stderr
    assert built.log.read_text() == ""


@pytest.mark.parametrize(("names", "code"), [("a_tree_is_built", 0), ("", 2)])
def test_word_may_be_found_in_one_suite_alone(built: Tree, names: str, code: int) -> None:
    done = built.run("test", "-k", "tree", NAMES=names, FAIL="-m pytest", CODE="5")
    assert done.returncode == code
    assert ("no test has 'tree' in its name" in done.stderr) == (code != 0)


def test_test_explains_its_arguments(built: Tree) -> None:
    assert "-k WORD" in built.run("test", "--help").stdout
    assert built.log.read_text() == ""


def test_lint_installs_its_tools_once(ready: Tree) -> None:
    ready.run("lint", "ruff")
    assert ready.list_steps() == ["requirements"]
    ready.run("lint", "ruff")
    assert ready.log.read_text() == f"{ready.root}/.ci/lint.py ruff\n"
