# SPDX-License-Identifier: Apache-2.0
"""Damaged and hostile sessions are refused in one message that names the field, and change nothing."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import photonloupe as pl
from studio_driver import TRAJECTORY, choose, drag_within, open_empty, open_ring, read_state


@pytest.fixture(scope="module")
def worked() -> Iterator[pl.Studio]:
    """Show all photons of the ring, some of them brushed."""
    with open_ring(TRAJECTORY) as studio:
        choose(studio, "Parallel coordinates/Source", "all")
        drag_within(studio, "Parallel coordinates/x", (0.5, 0.3), (0.5, 0.5))
        studio.key("n")
        yield studio


@pytest.fixture(scope="module")
def empty() -> Iterator[pl.Studio]:
    with open_empty(size=(400, 300)) as studio:
        yield studio


def test_ids_beyond_the_map_are_left_out(worked: pl.Studio) -> None:
    before = worked.state
    state = read_state(worked)
    state["parallel"]["axes"] = []  # no brushes, which would select anew
    state["selection"] = [3, 4_000_000_000]
    state["loupe"]["pins"] = [2, 4_000_000_000]
    state["named"] = {"far": [4_000_000_000]}
    worked.set_state(json.dumps(state))
    worked.frame()
    assert worked.selection is not None
    assert worked.selection.tolist() == [3]
    assert read_state(worked)["loupe"]["pins"] == [2]
    worked.key("ctrl+z")
    assert worked.state == before


def nest(depth: int) -> str:
    return '{"a":' * depth + "1" + "}" * depth


HOSTILE: list[tuple[str, Any, str]] = [
    ("trace.photons", "many", "trace.photons"),
    ("trace.photons", -1, "trace.photons"),
    ("trace.photons", 1.5, "trace.photons"),
    ("trace.photons", 1e300, "trace.photons"),
    ("trace.seed", None, "trace.seed"),
    ("trace.store", "everything", "trace.store"),
    ("trace.scene", 7, "trace.scene"),
    ("trace.scene", "a\0b.gltf", "trace.scene"),
    ("trace.scene", "x" * 5000, "trace.scene"),
    ("trace.scene", "../../secret.gltf", "trace.scene"),
    ("trace", [], "trace"),
    ("trace", None, "trace"),
    ("script.text", "x" * (1 << 21), "script.text"),
    ("script.values", {"a": "b"}, "script.values"),
    ("script.values", {str(i): 1 for i in range(300)}, "script.values"),
    ("view.mode", "hologram", "view.mode"),
    ("view.mode", 3, "view.mode"),
    ("view.camera.target", [0, 1], "view.camera.target"),
    ("view.camera.target", [0, 1, "2"], "view.camera.target"),
    ("view.camera.distance", 0, "view.camera.distance"),
    ("view.split_at", 1.01, "view.split_at"),
    ("view.is_split", 1, "view.is_split"),
    ("loupe.k", 1001, "loupe.k"),
    ("loupe.pins", list(range(17)), "loupe.pins"),
    ("loupe.numbers", ["x" * 300], "loupe.numbers"),
    ("parallel.axes", [{"name": "x"}] * 33, "parallel.axes"),
    ("parallel.axes", [1], "parallel.axes"),
    ("parallel.axes", [{"name": "x", "brushes": [[1]]}], "parallel.axes.brushes"),
    ("parallel.axes", [{"name": "x", "brushes": [[0, 1]] * 300}], "parallel.axes.brushes"),
    ("parallel.axes", [{"name": "x", "periods": 1e9}], "parallel.axes.periods"),
    ("relax.choices.neighbors", 999, "relax.choices.neighbors"),
    ("relax.made", 1_000_000, "relax.made"),
    ("image.exposure", 65, "image.exposure"),
    ("selection", [-1], "selection"),
    ("selection", [0.5], "selection"),
    ("selection", ["0"], "selection"),
    ("selection", {"0": 0}, "selection"),
    ("named", {"a": [2**32]}, "named"),
    ("named", {"x" * 300: []}, "named"),
    ("named", {str(i): [] for i in range(300)}, "named"),
    ("version", 3, "version"),
    ("format", "something else", "session"),
]


def set_field(state: dict[str, Any], place: str, value: Any) -> None:
    *path, last = place.split(".")
    target = state
    for name in path:
        target = target[name]
    target[last] = value


@pytest.mark.parametrize(("place", "value", "named"), HOSTILE, ids=lambda value: str(value)[:30])
def test_hostile_field_is_named_and_changes_nothing(
    empty: pl.Studio, tmp_path: Path, place: str, value: Any, named: str
) -> None:
    state = read_state(empty)
    set_field(state, place, value)
    path = tmp_path / "hostile.loupe"
    path.write_text(json.dumps(state))
    before = empty.state
    with pytest.raises(pl.PhotonLoupeError) as caught:
        empty.load_session(path)
    assert named in str(caught.value)
    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 600
    assert empty.state == before
    empty.frame()


@pytest.mark.parametrize(
    "text",
    [
        "",
        "{",
        "[]",
        "null",
        "3",
        '"session"',
        "\0\0\0",
        nest(100_000),
        "[" * 100_000,
        '{"format": "photonloupe session", "version": NaN}',
        '{"format": "photonloupe session", "version": 1e999}',
        '{"format": "photonloupe session", "version": 1, "selection": [1e400]}',
        '{"format": "photonloupe session", "version": 1, "trace": {"scene": "\udcff"}}',
    ],
    ids=range(13),
)
def test_what_is_no_session_is_refused(empty: pl.Studio, tmp_path: Path, text: str) -> None:
    path = tmp_path / "damaged.loupe"
    path.write_bytes(text.encode("utf-8", "surrogateescape"))
    before = empty.state
    with pytest.raises(pl.PhotonLoupeError, match="session: "):
        empty.load_session(path)
    assert empty.state == before


def test_truncated_sessions_are_refused(worked: pl.Studio, empty: pl.Studio, tmp_path: Path) -> None:
    worked.save_session(tmp_path / "whole.loupe")
    whole = (tmp_path / "whole.loupe").read_bytes()
    before = empty.state
    for length in np.random.default_rng(0).integers(0, len(whole) - 2, 20):
        (tmp_path / "part.loupe").write_bytes(whole[:length])
        with pytest.raises(pl.PhotonLoupeError, match="not JSON"):
            empty.load_session(tmp_path / "part.loupe")
    assert empty.state == before


def test_million_ids_are_a_selection(worked: pl.Studio) -> None:
    before = worked.state
    state = read_state(worked)
    state["parallel"]["axes"] = []
    state["selection"] = list(range(1_000_000))
    worked.set_state(json.dumps(state))
    worked.frame()
    assert worked.selection is not None
    assert worked.selection.tolist() == list(range(len(worked.photons)))
    worked.key("ctrl+z")
    assert worked.state == before


@pytest.mark.parametrize("path", ["missing.loupe", ".", "a\nb.loupe"])
def test_session_that_cannot_be_read_is_an_error(empty: pl.Studio, path: str) -> None:
    with pytest.raises(pl.PhotonLoupeError):
        empty.load_session(path)


def test_session_that_cannot_be_written_is_an_error(empty: pl.Studio, tmp_path: Path) -> None:
    with pytest.raises((pl.PhotonLoupeError, OSError)):
        empty.save_session(tmp_path / "no" / "folder" / "a.loupe")


VALUES = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**70), 2**70),
    st.floats(allow_nan=False),
    st.text(max_size=8),
    st.lists(st.integers(0, 5), max_size=3),
    st.dictionaries(st.text(max_size=4), st.integers(), max_size=2),
)


def list_places(value: Any, place: str = "") -> list[str]:
    if not isinstance(value, dict):
        return [place]
    return [found for name, part in value.items() for found in list_places(part, f"{place}.{name}".lstrip("."))]


@settings(
    max_examples=150, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(data=st.data())
def test_mutated_states_are_taken_or_refused_and_drawn(worked: pl.Studio, data: st.DataObject) -> None:
    """What is accepted draws a frame; work is not begun, for it may be long."""
    state = read_state(worked)
    places = [place for place in list_places(state) if not place.startswith(("trace.", "script.", "relax.", "image."))]
    for _ in range(data.draw(st.integers(1, 3))):
        set_field(state, data.draw(st.sampled_from(places)), data.draw(VALUES))
    before = worked.state
    try:
        worked.set_state(json.dumps(state))
    except pl.PhotonLoupeError:
        assert worked.state == before
        return
    worked._native.frame()
    worked.set_state(before)
    worked._native.frame()
