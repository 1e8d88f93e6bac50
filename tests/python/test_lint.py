# SPDX-License-Identifier: Apache-2.0
"""The static checks: none is left out silently, and each can fail."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

import lint
import tidy


@pytest.mark.parametrize("check", ["clang-format", "shellcheck", "clang-tidy"])
def test_missing_tool_is_an_error_that_names_the_cure(
    check: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(lint, "TOOLS", tmp_path)
    assert not lint.run_check(check)
    assert "./photonloupe lint, which installs" in capsys.readouterr().out


def test_missing_build_is_an_error_that_names_the_cure(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(tidy, "DATABASE", tmp_path / "compile_commands.json")
    assert not lint.run_check("clang-tidy")
    assert "remove build/launcher/built" in capsys.readouterr().out


def test_long_file_is_named(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(lint, "LONGEST_FILE", 30)
    assert not lint.run_check("lengths")
    assert "tests/python/test_lint.py" in capsys.readouterr().out


def test_unknown_check_is_refused(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr("sys.argv", ["lint", "spelling"])
    with pytest.raises(SystemExit):
        lint.main()
    assert "clang-tidy" in capsys.readouterr().err


def test_fix_writes_what_is_generated_and_fails_where_it_cannot(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    written: list[str] = []

    def run(*command: str) -> bool:
        written.extend(command)
        return "nanobind.stubgen" not in command

    monkeypatch.setattr(lint, "run", run)
    monkeypatch.setattr(lint, "CHECKS", {"good": lambda: True})
    monkeypatch.setattr("sys.argv", ["lint", "--fix"])
    assert lint.main() == 1
    assert "lint FAILED: what is generated" in capsys.readouterr().out
    assert {"tests/python/manual_tables.py", "format"} <= set(written)


def test_failed_check_fails_the_whole(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(lint, "CHECKS", {"good": lambda: True, "bad": lambda: False, "other": lambda: True})
    monkeypatch.setattr("sys.argv", ["lint"])
    assert lint.main() == 1
    assert "== other passed" in capsys.readouterr().out


def test_what_passed_is_read_again_only_where_it_changed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    sources = [tmp_path / name for name in ("a.cpp", "b.cpp")]
    header = tmp_path / "b.h"
    for path in (*sources, header):
        path.write_text("")
    read: list[str] = []

    def find_nothing(_: str, source: str) -> str:
        read.append(os.path.basename(source))
        return ""

    monkeypatch.setattr(tidy, "PASSED", tmp_path / "passed.json")
    monkeypatch.setattr(tidy, "list_sources", lambda: {str(path): "c++" for path in sources})
    monkeypatch.setattr(tidy, "list_headers", lambda: {str(sources[1]): [str(sources[1]), str(header)]})
    monkeypatch.setattr(tidy, "tidy", find_nothing)
    tool = "/bin/true"
    assert tidy.tidy_sources(tool)
    header.write_text("changed")
    assert tidy.tidy_sources(tool)
    assert read == ["a.cpp", "b.cpp", "b.cpp"]
