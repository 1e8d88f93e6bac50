# SPDX-License-Identifier: Apache-2.0
"""Sessions: saved, opened and moved they show the same, and a killed save leaves a whole one."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

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
