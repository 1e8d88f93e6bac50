# SPDX-License-Identifier: Apache-2.0
"""Every setting of every stage is the same wherever it is told: the engine's table is the only one."""

from __future__ import annotations

import ast
import inspect
import json
from collections.abc import Callable, Iterator
from typing import Any

import pytest

import photonloupe as pl
from manual_tables import KEYWORDS, SETTINGS_MANUAL, fill_tables, write_keywords
from photonloupe import settings as tables
from photonloupe.cli import build_parser
from photonloupe.settings import STAGES, Setting, check_settings, list_settings
from studio_driver import open_ring, show_panel
from test_api_cli import run

ROWS = [(stage, setting) for stage in STAGES for setting in list_settings(stage).values()]
EVERY = pytest.mark.parametrize(("stage", "setting"), ROWS, ids=lambda value: getattr(value, "name", value))
FUNCTIONS: dict[str, tuple[Callable[..., Any], ...]] = {
    "trace": (pl.trace_photons,),
    "relax": (pl.PhotonMap.relax, pl.Relaxation.__init__),
    "irradiance": (pl.PhotonMap.irradiance,),
    "render": (pl.render,),
    "loupe": (pl.inspect.loupe, pl.PhotonMap.neighbors),
}
VERBS = {"trace": ("a.gltf",), "relax": ("a.zarr",), "render": ("a.gltf",)}
# Where a session, and the widgets of which panel, hold a stage; the view decides the rest of a rendering.
PLACES = {
    "trace": (("trace",), "Trace"),
    "relax": (("relax", "choices"), "Relaxation"),
    "render": (("image",), "Image"),
    "loupe": (("loupe",), "Loupe"),
}
OF_THE_VIEW = ("width", "height", "mode")
# What the studio begins with instead.
OWN_DEFAULTS = {("trace", "count"): 50_000, ("render", "samples"): 1}


def choose_other(setting: Setting) -> Any:
    """Find a value that is not the default."""
    if setting.kind == "flag":
        return not setting.default
    if setting.kind == "choice":
        return next(name for name in setting.choices if name != setting.default)
    if setting.kind == "numbers":
        return [0.5 + i for i in range(setting.width)]
    return 77 if setting.high >= 77 else setting.limits[1]


def get_place(state: dict[str, Any], stage: str) -> dict[str, Any]:
    for name in PLACES[stage][0]:
        state = state[name]
    return state


@pytest.fixture(scope="module")
def studio() -> Iterator[pl.Studio]:
    with open_ring() as opened:
        yield opened


@EVERY
def test_default_is_one_that_may_be_given(stage: str, setting: Setting) -> None:
    assert setting.check(setting.shown_default) == setting.default
    assert check_settings(stage, {})[setting.name] == setting.default


@EVERY
def test_setting_is_told_in_a_line(stage: str, setting: Setting) -> None:
    assert setting.doc
    assert "\n" not in setting.tell()
    assert setting.empty in ("", "none") or setting.automatic


@EVERY
def test_function_names_the_setting_with_its_default(stage: str, setting: Setting) -> None:
    for function in FUNCTIONS[stage]:
        parameter = inspect.signature(function).parameters[setting.name]
        assert parameter.default in (setting.shown_default, inspect.Parameter.empty)


@EVERY
def test_docstring_tells_the_setting(stage: str, setting: Setting) -> None:
    for function in FUNCTIONS[stage]:
        assert function.__doc__ is None or f"\n{setting.name}\n    {setting.tell()}." in function.__doc__


@EVERY
def test_wrong_value_is_refused_by_name(stage: str, setting: Setting) -> None:
    if setting.kind == "flag":
        return
    with pytest.raises(pl.ArgumentError, match=f"^{setting.name} must be "):
        check_settings(stage, {setting.name: "no such thing"})


@EVERY
def test_range_ends_where_the_table_says(stage: str, setting: Setting) -> None:
    if not setting.tell_range():
        return
    for value in (setting.low, setting.high):
        beyond = value + (1 if setting.kind == "count" else abs(value) + 1) * (1 if value == setting.high else -1)
        whole = int(beyond) if setting.kind == "count" else beyond
        with pytest.raises(pl.ArgumentError, match=f"^{setting.name} must be from "):
            check_settings(stage, {setting.name: (whole,) * setting.width if setting.kind == "numbers" else whole})


def test_unknown_setting_is_named() -> None:
    with pytest.raises(TypeError, match="there is no setting 'speed'; trace has count, "):
        check_settings("trace", {"speed": 1})


@EVERY
def test_command_line_has_the_setting(stage: str, setting: Setting, capsys: pytest.CaptureFixture[str]) -> None:
    if stage not in VERBS:
        return
    assert run(stage, "--help") == 0
    printed = " ".join(capsys.readouterr().out.split())
    assert setting.option in printed
    assert setting.tell().replace("`", "") in printed
    other = choose_other(setting)
    text = ",".join(map(str, other)) if isinstance(other, list) else str(other)
    given = [setting.option] if setting.kind == "flag" else [f"{setting.option}={text}"]
    parsed = build_parser().parse_args([stage, *VERBS[stage], "-o", "out", *given])
    read = tables.read_setting_options(parsed, stage)
    assert list(read) == [setting.name]
    assert setting.check(read[setting.name]) == other


def test_types_of_keywords_are_those_of_the_tables() -> None:
    assert KEYWORDS.read_text() == write_keywords(), "run tests/python/manual_tables.py"


def test_manual_has_the_tables() -> None:
    text = SETTINGS_MANUAL.read_text()
    assert fill_tables(text) == text, "run tests/python/manual_tables.py"
    assert all(f"\n| `{setting.name}` | {setting.doc} |" in text for _, setting in ROWS)


def test_every_setting_of_the_studio_is_begun_with_at_its_default() -> None:
    with pl.Studio(offscreen=True, size=(400, 300)) as empty:
        state = json.loads(empty.state)
    for stage, setting in ROWS:
        if stage in PLACES and setting.name not in OF_THE_VIEW:
            expected = setting.default if setting.default is not None else setting.empty
            held = get_place(state, stage)[setting.alias or setting.name]
            assert held == OWN_DEFAULTS.get((stage, setting.name), expected), setting.name


def test_every_setting_has_a_widget(studio: pl.Studio) -> None:
    studio.press("Trace/Menu")
    studio.frame()
    drawn = set(studio.widgets())
    studio.key("escape")
    for panel in ("Relaxation", "Image", "Loupe"):
        show_panel(studio, panel)
        studio.frame()
        drawn |= set(studio.widgets())
    for stage, setting in ROWS:
        if stage in PLACES and setting.name not in OF_THE_VIEW:
            assert f"{PLACES[stage][1]}/{setting.alias or setting.name}" in drawn


def test_every_setting_is_copied_as_python() -> None:
    with pl.Studio(offscreen=True, size=(400, 300)) as empty:
        state = json.loads(empty.state)
        state["trace"]["scene"] = "/none.gltf"
        state["relax"] |= {"made": 1, "is_measured": True}
        state["loupe"] |= {"has_point": True, "space": "constrained"}
        others: dict[tuple[str, str], Any] = {}
        for stage, setting in ROWS:
            if stage in PLACES and setting.name not in OF_THE_VIEW:
                others[stage, setting.name] = other = choose_other(setting)
                get_place(state, stage)[setting.alias or setting.name] = other
        state["relax"]["used"] = state["relax"]["choices"]
        empty.set_state(json.dumps(state))
        program = ast.parse(empty.python())
    calls = {"trace_photons": "trace", "Relaxation": "relax", "render": "render", "loupe": "loupe"}
    told = {
        (calls[call.func.attr], keyword.arg): ast.literal_eval(keyword.value)
        for call in ast.walk(program)
        if isinstance(call, ast.Call) and isinstance(call.func, ast.Attribute) and call.func.attr in calls
        for keyword in call.keywords
        if (calls[call.func.attr], keyword.arg) in others
    }
    assert told == {key: tuple(other) if isinstance(other, list) else other for key, other in others.items()}
