# SPDX-License-Identifier: Apache-2.0
"""Sessions: saved, opened and moved they show the same; damaged and hostile ones are refused and change nothing."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

import photonloupe as pl
from conftest import find_scene
from studio_driver import TRAJECTORY, choose, drag_within, find_place, open_empty, open_ring, read_state


def do_much(studio: pl.Studio) -> None:
    """Touch every part of the state that work or pictures follow from."""
    choose(studio, "Parallel coordinates/Source", "all")
    drag_within(studio, "Parallel coordinates/x", (0.5, 0.3), (0.5, 0.5))
    studio.click(*find_place(studio, "View/Picture", 0.5, 0.6))
    drag_within(studio, "View/Picture", (0.5, 0.5), (0.6, 0.55))
    drag_within(studio, "Script/zoom", (0.5, 0.5), (0.3, 0.5))
    studio.key("n")
    studio.key("4")
    studio.mouse_move(1, 1)
    studio.frame()


@pytest.fixture(scope="module")
def worked() -> Iterator[pl.Studio]:
    with open_ring(TRAJECTORY) as studio:
        do_much(studio)
        yield studio


@pytest.fixture(scope="module")
def empty() -> Iterator[pl.Studio]:
    with open_empty(size=(400, 300)) as studio:
        yield studio


def test_session_restores_state_work_and_picture(worked: pl.Studio, tmp_path: Path) -> None:
    worked.save_session(tmp_path / "a.loupe")
    with open_empty() as other:
        other.load_session(tmp_path / "a.loupe")
        other.mouse_move(1, 1)
        other.frame()
        other.frame()
        assert other.state == worked.state
        assert other.relaxed is not None
        assert worked.relaxed is not None
        np.testing.assert_array_equal(other.relaxed.positions, worked.relaxed.positions)
        np.testing.assert_array_equal(other.photons.parameters, worked.photons.parameters)
        np.testing.assert_array_equal(other.selection, worked.selection)
        np.testing.assert_array_equal(other.panel("View"), worked.panel("View"))
        np.testing.assert_array_equal(other.panel("Parallel coordinates"), worked.panel("Parallel coordinates"))


def test_saving_twice_writes_the_same_bytes(worked: pl.Studio, tmp_path: Path) -> None:
    worked.save_session(tmp_path / "a.loupe")
    first = (tmp_path / "a.loupe").read_bytes()
    worked.save_session(tmp_path / "a.loupe")
    assert (tmp_path / "a.loupe").read_bytes() == first
    assert [path.name for path in tmp_path.iterdir()] == ["a.loupe"]


def test_session_moves_with_its_scene(tmp_path: Path) -> None:
    shutil.copytree(find_scene("ring").parent, tmp_path / "old" / "ring")
    with pl.Studio(
        scene=tmp_path / "old" / "ring" / "ring.gltf", offscreen=True, size=(400, 300), photons=4_096
    ) as studio:
        studio.frame()
        count = len(studio.photons)
        studio.save_session(tmp_path / "old" / "a.loupe")
    assert json.loads((tmp_path / "old" / "a.loupe").read_text())["trace"]["scene"] == "ring/ring.gltf"
    (tmp_path / "old").rename(tmp_path / "new")
    with open_empty(size=(400, 300)) as studio:
        studio.load_session(tmp_path / "new" / "a.loupe")
        studio.frame()
        assert len(studio.photons) == count
        assert read_state(studio)["trace"]["scene"] == str(tmp_path / "new" / "ring" / "ring.gltf")


def test_session_of_a_scene_by_a_relative_path_finds_it_again(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shutil.copytree(find_scene("ring").parent, tmp_path / "ring")
    monkeypatch.chdir(tmp_path)
    with pl.Studio(scene=pl.load_scene("ring/ring.gltf"), offscreen=True, size=(400, 300), photons=4_096) as studio:
        studio.frame()
        (tmp_path / "elsewhere").mkdir()
        studio.save_session("elsewhere/a.loupe")
    with open_empty(size=(400, 300)) as studio:
        studio.load_session("elsewhere/a.loupe")
        studio.frame()
        assert len(studio.photons) > 0


def test_key_saves_the_session_where_it_was_opened(tmp_path: Path) -> None:
    with open_empty(size=(400, 300)) as studio:
        studio.save_session(tmp_path / "a.loupe")
        studio.open(tmp_path / "a.loupe")
        studio.frame()
        studio.key("5")
        studio.key("ctrl+s")
        assert json.loads((tmp_path / "a.loupe").read_text())["view"]["mode"] == "render"


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
    ("version", 2, "version"),
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


KILLED = """
import sys
import photonloupe as pl
studio = pl.Studio(offscreen=True, size=(64, 64))
import json
state = json.loads(studio.state)
state["selection"] = list(range(200_000))
studio.set_state(json.dumps(state))
studio.save_session(sys.argv[1])
print("saving", flush=True)
while True:
    studio.save_session(sys.argv[1])
"""


def test_killed_save_leaves_a_whole_session(empty: pl.Studio, tmp_path: Path) -> None:
    path = tmp_path / "a.loupe"
    before = empty.state
    for delay in np.random.default_rng(0).random(4) * 0.1:
        process = subprocess.Popen([sys.executable, "-c", KILLED, str(path)], stdout=subprocess.PIPE)
        assert process.stdout is not None
        assert process.stdout.readline() == b"saving\n"
        try:
            process.wait(float(delay))
        except subprocess.TimeoutExpired:
            os.kill(process.pid, signal.SIGKILL)
        assert process.wait() == -signal.SIGKILL
        process.stdout.close()
        empty.load_session(path)
        assert len(read_state(empty)["selection"]) == 200_000
    empty.set_state(before)
