# SPDX-License-Identifier: Apache-2.0
"""Writes what the engine's tables give: run this file after changing a call, a code, a command, a setting."""

from __future__ import annotations

import re
from pathlib import Path

from photonloupe import _engine
from photonloupe.settings import STAGES, Setting, list_settings

DOCS = Path(__file__).resolve().parents[2] / "docs"
MANUAL = DOCS / "script.md"
STUDIO_MANUAL = DOCS / "studio.md"
SETTINGS_MANUAL = DOCS / "settings.md"
KEYWORDS = DOCS.parent / "python" / "photonloupe" / "setting_keywords.py"

_KEYWORDS_HEAD = '''# SPDX-License-Identifier: Apache-2.0
"""Types of the stages' keywords, written by tests/python/manual_tables.py from the engine's tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict
'''
# Those that may be given by their place, which the function names itself.
_BY_PLACE = {"trace": ("count",), "relax": ("steps", "neighbors"), "irradiance": (), "render": ()}
_TYPES = {"flag": "bool", "count": "int", "number": "float", "numbers": "Sequence[float]", "choice": "str"}


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


def list_stage(stage: str) -> str:
    """Every setting of a stage."""
    rows = [
        f"| `{setting.name}` | {setting.doc} | {_tell_values(setting)} | {setting.tell_default()} |"
        for setting in list_settings(stage).values()
    ]
    return "\n".join(["| setting | what it is | what it may be | default |", "|---|---|---|---|", *rows])


def _tell_values(setting: Setting) -> str:
    names = [f"`{name}`" for name in (setting.names if setting.kind == "choice" else filter(None, [setting.empty]))]
    told = [setting.tell_range()] if setting.tell_range() else ["yes or no"] if setting.kind == "flag" else []
    text = ", ".join([*told, *names])
    automatic = setting.automatic and setting.default is not None
    return f"{text} ({setting.automatic})" if automatic else text


def write_keywords() -> str:
    """Write the types of all stages' keywords, with those that may be given by their place and without."""
    parts = [_KEYWORDS_HEAD]
    for stage, by_place in _BY_PLACE.items():
        known = list_settings(stage).values()
        name = f"{stage.title()}Keywords"
        parts.append(_write_type(name, "TypedDict", [one for one in known if one.name not in by_place]))
        if stage == "relax":  # nothing else takes all of them as keywords
            parts.append(_write_type(f"All{name}", name, [one for one in known if one.name in by_place]))
    return "\n\n".join(parts)


def _write_type(name: str, base: str, settings: list[Setting]) -> str:
    rows = [f"    {one.name}: {_name_type(one)}\n" for one in settings]
    return (
        f'class {name}({base}, total=False):\n    """`engine/*/settings.h` says what each means."""\n\n{"".join(rows)}'
    )


def _name_type(setting: Setting) -> str:
    types = [_TYPES[setting.kind]]
    types += ["float"] if setting.spreads else []
    types += ["str"] if setting.empty and setting.kind != "choice" else []
    return " | ".join([*types, "None"])


def fill_tables(text: str) -> str:
    """Put the tables between their marks."""
    stages = [(f"settings of {stage}", list_stage(stage)) for stage in STAGES]
    tables = [("builtins", list_builtins()), ("codes", list_codes()), ("commands", list_commands()), *stages]
    for name, table in tables:
        begin, end = f"<!-- {name}: begin -->", f"<!-- {name}: end -->"
        pattern = re.compile(re.escape(begin) + ".*?" + re.escape(end), re.DOTALL)
        text = pattern.sub(lambda _, filled=f"{begin}\n{table}\n{end}": filled, text)
    return text


if __name__ == "__main__":
    KEYWORDS.write_text(write_keywords(), encoding="utf-8")
    for manual in (MANUAL, STUDIO_MANUAL, SETTINGS_MANUAL):
        manual.write_text(fill_tables(manual.read_text(encoding="utf-8")), encoding="utf-8")
