# SPDX-License-Identifier: Apache-2.0
"""Copy as Python: the program gives the studio's photons, relaxation, loupe, plot and image, exactly."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from studio_driver import (
    SHADES,
    TRAJECTORY,
    aim_loupe,
    change_state,
    drag_slider,
    drag_within,
    look_down,
    open_empty,
    open_ring,
    read_state,
)

CROSSING = (0.0, 0.0, -0.6)


class NoImage:
    """Stands for a picture that was not rendered."""

    def save(self, path: str) -> None:
        pass


def execute(
    studio: pl.Studio, folder: Path, monkeypatch: pytest.MonkeyPatch, *, renders: bool = False
) -> dict[str, Any]:
    monkeypatch.chdir(folder)
    if not renders:  # it takes longer than all else
        monkeypatch.setattr(pl, "render", lambda *_, **__: NoImage())
    names: dict[str, Any] = {}
    exec(compile(studio.python(), "copied", "exec"), names)
    return names


def test_copied_program_gives_the_photons_and_the_image(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with open_ring(SHADES) as studio:
        drag_slider(studio, "Script/shade", 0.8)
        drag_within(studio, "View/Picture", (0.4, 0.5), (0.6, 0.6))
        studio.key("5")
        names = execute(studio, tmp_path, monkeypatch, renders=True)
        np.testing.assert_array_equal(names["photons"].positions, studio.photons.positions)
        np.testing.assert_array_equal(names["photons"].colors, studio.photons.colors)
        assert studio.rendered is not None
        assert np.array_equal(np.asarray(names["image"]), np.asarray(studio.rendered))
        assert np.asarray(studio.rendered).max() > 0
        assert (tmp_path / "view.exr").is_file()


def test_copied_program_gives_the_relaxed_photons_their_image_and_loupe(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with open_ring(TRAJECTORY) as studio:
        look_down(studio, CROSSING, 3.0)
        studio.key("n")
        studio.key("n")
        aim_loupe(studio, CROSSING)
        studio.key("p")
        studio.key("l")
        aim_loupe(studio, (0.05, 0.0, -0.65))
        found = studio.loupe_ids
        studio.key("5")
        names = execute(studio, tmp_path, monkeypatch, renders=True)
        assert studio.relaxed is not None
        for column in ("positions", "power", "drift", "constraint_weights"):
            np.testing.assert_array_equal(getattr(names["relaxed"], column), getattr(studio.relaxed, column))
        assert np.array_equal(np.asarray(names["image"]), np.asarray(studio.rendered))
        np.testing.assert_array_equal(names["view"].ids, found)


@pytest.mark.parametrize("lock", ["none", "brushes"])
@pytest.mark.parametrize("space", ["world", "parameter", "constrained"])
def test_copied_program_looks_through_the_same_loupe(
    space: str, lock: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with open_ring(TRAJECTORY) as studio:
        look_down(studio, CROSSING, 2.0)
        axes = [{"name": "right", "brushes": [[-0.2, 0.05]]}, {"name": "up"}]
        change_state(studio, loupe={"space": space, "lock": lock, "k": 60}, parallel={"axes": axes, "source": "loupe"})
        aim_loupe(studio, CROSSING)
        assert len(studio.loupe_ids) == 60
        names = execute(studio, tmp_path, monkeypatch)
        np.testing.assert_array_equal(names["view"].ids, studio.loupe_ids)
        assert [axis.name for axis in names["axes"]] == ["right", "up"]
        assert names["plot"] is not None


def test_copied_program_looks_at_the_traced_photons_while_they_are_in_view(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with open_ring() as studio:
        look_down(studio, CROSSING, 2.0)
        studio.key("n")
        studio.key("tab")
        aim_loupe(studio, CROSSING)
        names = execute(studio, tmp_path, monkeypatch)
        np.testing.assert_array_equal(names["view"].ids, studio.loupe_ids)


@pytest.mark.parametrize("text", ["'''", "a = 1; // '''\n", "// it's\\", "// \r\n", "// tricky '", "file.photon"])
def test_copied_program_holds_any_script(text: str) -> None:
    with open_ring() as studio:
        change_state(studio, script={"text": text, "ran": text})
        given: list[str] = []
        program = studio.python()
        call = program[program.index("photons.run_script(") :]
        call = call[: call.index("\n)\n") + 3]

        class Photons:
            def run_script(self, script: str, **_: Any) -> None:
                given.append(script)

        exec(call, {"photons": Photons()})
        assert given == [text]


def test_copied_program_of_a_saved_map_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with open_ring() as studio:
        studio.photons.save(tmp_path / "map.zarr")
        studio.open(tmp_path / "map.zarr")
        studio.frame()
        names = execute(studio, tmp_path, monkeypatch)
        np.testing.assert_array_equal(names["photons"].positions, studio.photons.positions)


def test_empty_studio_gives_a_program_that_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with open_empty(size=(400, 300)) as studio:
        execute(studio, tmp_path, monkeypatch)


def test_key_copies_the_program() -> None:
    with open_ring() as studio:
        studio.key("ctrl+shift+c")
        assert "clipboard" in studio.message


def test_program_names_the_settings_that_differ_from_the_defaults() -> None:
    with open_ring() as studio:
        change_state(studio, trace={"seed": 7})
        program = studio.python()
        assert f"trace_photons(scene, count={read_state(studio)['trace']['photons']}, seed=7)" in program
        assert "store=" not in program
