# SPDX-License-Identifier: Apache-2.0
"""Writes tables of the manuals from the engine: run this file after changing a predefined call, a code or a command."""

from __future__ import annotations

import re
from pathlib import Path

from photonloupe import _engine

DOCS = Path(__file__).resolve().parents[2] / "docs"
MANUAL = DOCS / "script.md"
STUDIO_MANUAL = DOCS / "studio.md"


def list_builtins() -> str:
    """One table a group, in the order of the engine's."""
    lines: list[str] = []
    group = ""
    for row in _engine.list_script_builtins():
        if row["group"] != group:
            group = row["group"]
            lines += ["", f"### {group}", "", "| call | what it gives |", "|---|---|"]
        lines.append(f"| `{row['signature']}` | {row['doc']} |")
    return "\n".join(lines[1:])


def list_codes() -> str:
    """Every code with its meaning."""
    rows = [f"| {row['code']} | {row['meaning']} |" for row in _engine.list_script_codes()]
    return "\n".join(["| code | meaning |", "|---|---|", *rows])


def list_commands() -> str:
    """Every command of the studio with its keys."""
    rows = [
        f"| {f'`{keys}`' if keys else '—'} | `{name}` | {about} |"
        for name, keys, about in _engine.list_studio_commands()
    ]
    return "\n".join(["| keys | command | what it does |", "|---|---|---|", *rows])


def fill_tables(text: str) -> str:
    """Put the tables between their marks."""
    for name, table in (("builtins", list_builtins()), ("codes", list_codes()), ("commands", list_commands())):
        begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
        pattern = re.compile(re.escape(begin) + ".*?" + re.escape(end), re.DOTALL)
        text = pattern.sub(lambda _, filled=f"{begin}\n{table}\n{end}": filled, text)
    return text


if __name__ == "__main__":
    for manual in (MANUAL, STUDIO_MANUAL):
        manual.write_text(fill_tables(manual.read_text(encoding="utf-8")), encoding="utf-8")
