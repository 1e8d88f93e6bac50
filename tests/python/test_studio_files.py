# SPDX-License-Identifier: Apache-2.0
"""Files that are dropped, opened, changed on the disk, and what is said of those that are none."""

from __future__ import annotations

import shutil
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene, write_scene
from gltf import build_quad, make_mirror
from studio_driver import SHADES, choose, find_middle, open_empty, open_ring, read_state, show_panel


@pytest.fixture(scope="module")
def small() -> Iterator[pl.Studio]:
    with open_ring(size=(600, 500)) as studio:
        yield studio


def write_lamp(folder: Path) -> Path:
    """A lamp over a floor, with a mirror above that makes a caustic."""
    folder.mkdir(exist_ok=True)
    return write_scene(
        folder,
        "lamp",
        lambda writer: writer.add_mesh("mirror", build_quad(0.5, 2.0), make_mirror("m", (0.9, 0.9, 0.9))),
    )


def test_dropped_scene_is_traced(tmp_path: Path) -> None:
    with open_empty(size=(600, 500)) as studio:
        studio.drop(find_scene("ring"))
        assert read_state(studio)["trace"]["scene"] == str(find_scene("ring"))
        assert len(studio.photons) > 0
        assert studio.scene is not None


def test_dropped_script_is_opened_and_not_yet_run(small: pl.Studio, tmp_path: Path) -> None:
    before = small.state
    (tmp_path / "a.photon").write_text(SHADES)
    small.drop(tmp_path / "a.photon")
    script = read_state(small)["script"]
    assert (script["text"], script["ran"], script["path"]) == (SHADES, "", str(tmp_path / "a.photon"))
    small.command("edit.undo")
    assert small.state == before


def test_dropped_map_takes_the_photons_place(tmp_path: Path) -> None:
    with open_ring(SHADES, size=(600, 500)) as studio:
        pl.trace_photons(pl.load_scene(find_scene("ring")), 1_000, seed=9).save(tmp_path / "map.zarr")
        studio.drop(tmp_path / "map.zarr")
        expected = pl.load_photons(tmp_path / "map.zarr")
        np.testing.assert_array_equal(studio.photons.positions, expected.positions)
        np.testing.assert_allclose(studio.photons.parameters[:, 0], expected.positions[:, 0])  # the script runs over it


def test_undo_of_an_opened_map_traces_the_scene_again(tmp_path: Path) -> None:
    with open_ring(size=(600, 500)) as studio:
        before, positions = studio.state, np.asarray(studio.photons.positions).copy()
        studio.photons.select(np.arange(100)).save(tmp_path / "map.zarr")
        studio.drop(tmp_path / "map.zarr")
        assert len(studio.photons) == 100
        studio.command("edit.undo")
        assert studio.state == before
        np.testing.assert_array_equal(studio.photons.positions, positions)
        studio.command("edit.redo")
        assert len(studio.photons) == 100


def test_dropped_session_is_opened(small: pl.Studio, tmp_path: Path) -> None:
    before = small.state
    small.key("4")
    small.save_session(tmp_path / "a.loupe")
    small.key("2")
    small.drop(tmp_path / "a.loupe")
    assert read_state(small)["view"]["mode"] == "colored_points"
    while small.state != before:
        small.command("edit.undo")


def test_dropped_picture_is_the_reference_and_is_compared(tmp_path: Path) -> None:
    with open_ring(size=(1200, 800)) as studio:
        show_panel(studio, "Image")
        assert studio.rendered is not None
        studio.rendered.save(tmp_path / "same.exr")
        studio.drop(tmp_path / "same.exr")
        assert read_state(studio)["image"]["reference"] == str(tmp_path / "same.exr")
        choose(studio, "Image/Shows", "error")
        assert "Image/Picture" in studio.widgets()


def test_refused_map_leaves_the_origin_of_the_one_in_view(tmp_path: Path) -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("ring")), 1_000, seed=9)
    photons.save(tmp_path / "good.zarr")
    photons.select(np.array([], dtype=np.int64)).save(tmp_path / "empty.zarr")
    with open_empty(size=(400, 300)) as studio:
        studio.drop(tmp_path / "good.zarr")
        for _ in range(2):
            studio.drop(tmp_path / "empty.zarr")
            assert "no photons to look at" in studio.message
        assert studio.photons.settings["seed"] == 9
        assert len(studio.photons) == len(photons)


@pytest.mark.parametrize("name", ["a.txt", "missing.gltf", "missing.photon", "missing.zarr.x", "a", "..", "ü\n.loupe"])
def test_nonsense_is_refused_with_a_word(small: pl.Studio, tmp_path: Path, name: str) -> None:
    (tmp_path / "a.txt").write_text("nothing")
    before, count = small.state, len(small.photons)
    if name == "..":
        name = "../" + tmp_path.name + "/a.txt"
    small.selection = [0]
    small.command("edit.undo")
    small.drop(tmp_path / name)
    assert small.message
    assert "undone" not in small.message
    assert small.state == before
    assert len(small.photons) == count


@pytest.mark.parametrize("suffix", [".gltf", ".glb", ".photon", ".loupe", ".exr", ".png"])
def test_damaged_file_is_refused_and_the_photons_stay(tmp_path: Path, suffix: str) -> None:
    with open_ring(size=(600, 400), photons=1_000) as studio:
        if suffix in (".exr", ".png"):  # a reference is compared with a rendered view
            studio.key("5")
        path = tmp_path / f"damaged{suffix}"
        path.write_bytes(np.random.default_rng(0).bytes(2_000))
        positions = np.asarray(studio.photons.positions).copy()
        studio.drop(path)
        studio.frame()
        if suffix != ".photon":  # any text is a script, perhaps with errors
            assert studio.message
        np.testing.assert_array_equal(studio.photons.positions, positions)


def test_open_raises_what_drop_says(small: pl.Studio, tmp_path: Path) -> None:
    with pytest.raises(pl.PhotonLoupeError, match=r"\.gltf"):
        small.open(tmp_path / "a.txt")
    with pytest.raises((pl.PhotonLoupeError, OSError)):
        small.open(tmp_path / "missing.gltf")


def test_path_is_opened_by_typing_it_in_the_status_line() -> None:
    with open_empty() as studio:
        studio.click(*find_middle(studio, "Status/Open"))
        studio.type(f"{find_scene('ring')}\n")
        assert len(studio.photons) > 0


def test_changed_script_runs_again_and_a_wrong_one_leaves_the_last(tmp_path: Path) -> None:
    path = tmp_path / "a.photon"
    path.write_text(SHADES)
    with open_ring(path) as studio:
        assert studio.photons.colors[0, 0] == np.float32(0.25)
        path.write_text(SHADES.replace("0.25", "0.75"))
        studio.watch_files()
        assert studio.photons.colors[0, 0] == np.float32(0.75)
        good = studio.state
        path.write_text("oops(")
        studio.watch_files()
        assert "changed on the disk" in studio.message
        assert studio.state == good
        assert studio.photons.colors[0, 0] == np.float32(0.75)
        path.unlink()
        studio.watch_files()
        assert studio.state == good


def test_changed_scene_is_traced_again_and_a_wrong_one_leaves_the_last(tmp_path: Path) -> None:
    path = write_lamp(tmp_path / "scene")
    with pl.Studio(scene=path, offscreen=True, size=(600, 500), photons=2_000) as studio:
        studio.frame()
        high = len(studio.photons)
        assert high > 0
        flux = studio.photons.total_flux
        shutil.copy(path, tmp_path / "kept")
        path.write_text(path.read_text().replace('"intensity": 10', '"intensity": 20'))
        studio.watch_files()
        np.testing.assert_allclose(studio.photons.total_flux, 2 * np.asarray(flux), rtol=1e-5)
        path.write_text("{")
        studio.watch_files()
        assert "changed on the disk" in studio.message
        np.testing.assert_allclose(studio.photons.total_flux, 2 * np.asarray(flux), rtol=1e-5)


def test_scene_and_script_of_an_opened_session_are_watched(tmp_path: Path) -> None:
    path = tmp_path / "a.photon"
    path.write_text(SHADES)
    with open_ring(path) as studio:
        studio.save_session(tmp_path / "a.loupe")
    with open_empty() as studio:
        studio.load_session(tmp_path / "a.loupe")
        studio.frame()
        studio.watch_files()
        path.write_text(SHADES.replace("0.25", "0.75"))
        studio.watch_files()
        assert studio.photons.colors[0, 0] == np.float32(0.75)


def test_script_is_saved_under_the_name_in_its_field(tmp_path: Path) -> None:
    with open_ring(SHADES) as studio:
        studio.click(*find_middle(studio, "Script/Path"))
        studio.type(str(tmp_path / "saved.photon"))
        studio.press("Script/Save")
        assert (tmp_path / "saved.photon").read_text() == SHADES
        assert read_state(studio)["script"]["path"] == str(tmp_path / "saved.photon")
        studio.watch_files()  # its own save is no change
        assert read_state(studio)["script"]["ran"] == SHADES


def test_figure_is_written_by_the_export_menu(tmp_path: Path) -> None:
    with open_ring() as studio:
        studio.press("Export/Menu")
        studio.click(*find_middle(studio, "Export/Path"))
        studio.type(str(tmp_path / "figure.png"))
        studio.press("Export/Write")
        studio.frame()
        assert np.asarray(pl.load_image(tmp_path / "figure.png")).shape == (800, 1200, 3)
