# SPDX-License-Identifier: Apache-2.0
"""Saved maps come back bit for bit, a killed save leaves one whole map, and damage is named."""

from __future__ import annotations

import json
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from conftest import make_columns

PHOTONS = 200
OLD, NEW = 1, 2

# Saves a new map over the old one and kills itself at the given Python call; prints the number of calls if it ends.
KILLED_SAVE = """
import os, signal, sys
sys.path[:0] = sys.argv[3:]
import photonloupe as pl
from conftest import make_columns
photons = pl.PhotonMap.from_arrays(**make_columns(200, seed=2))
photons.save(sys.argv[1] + ".warm")
limit, calls = int(sys.argv[2]), 0
def count(frame, event, argument):
    global calls
    calls += 1
    if calls == limit:
        os.kill(os.getpid(), signal.SIGKILL)
sys.setprofile(count)
photons.save(sys.argv[1])
sys.setprofile(None)
print(calls)
"""


def build(seed: int) -> pl.PhotonMap:
    return pl.PhotonMap.from_arrays(**make_columns(PHOTONS, seed=seed))  # type: ignore[arg-type]


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    build(OLD).save(tmp_path / "map.zarr")
    return tmp_path / "map.zarr"


@pytest.mark.parametrize("name", list(make_columns(1)))
def test_column_survives_bit_for_bit(saved: Path, name: str) -> None:
    assert getattr(pl.load_photons(saved), name).tobytes() == make_columns(PHOTONS, seed=OLD)[name].tobytes()


def test_traced_map_survives_with_its_settings(ring: pl.Scene, tmp_path: Path) -> None:
    photons = pl.trace_photons(ring, 2_000, seed=4)
    photons.save(tmp_path / "ring.zarr")
    loaded = pl.load_photons(tmp_path / "ring.zarr")
    assert (loaded.settings, loaded.emitted) == (photons.settings, photons.emitted)


def test_loaded_map_records_its_paths_from_its_scene(ring: pl.Scene, tmp_path: Path) -> None:
    photons = pl.trace_photons(ring, 2_000, seed=4)
    photons.save(tmp_path / "ring.zarr")
    np.testing.assert_array_equal(pl.load_photons(tmp_path / "ring.zarr").path_vertices, photons.path_vertices)


def test_map_names_its_scene_and_device(ring_map: pl.PhotonMap) -> None:
    assert {"version", "device", "driver", "scene_hash", "settings"} <= set(ring_map.provenance)


def test_array_names_are_the_property_names(saved: Path) -> None:
    assert {path.name for path in saved.iterdir() if path.is_dir()} == set(make_columns(1))


def test_save_replaces_an_older_map(saved: Path) -> None:
    build(NEW).save(saved)
    np.testing.assert_array_equal(pl.load_photons(saved).positions, build(NEW).positions)


def test_save_leaves_nothing_beside_it(saved: Path) -> None:
    build(NEW).save(saved)
    assert [path.name for path in saved.parent.iterdir()] == ["map.zarr"]


def test_save_refuses_to_replace_another_folder(tmp_path: Path) -> None:
    (tmp_path / "letters").mkdir()
    with pytest.raises(pl.FileFormatError, match="not a photon map"):
        build(OLD).save(tmp_path / "letters")


def test_save_names_a_missing_parent(tmp_path: Path) -> None:
    with pytest.raises(pl.FileFormatError, match="not a folder"):
        build(OLD).save(tmp_path / "none" / "map.zarr")


def test_empty_map_survives(tmp_path: Path) -> None:
    pl.PhotonMap.from_arrays(**make_columns(0, paths=False)).save(tmp_path / "e.zarr")  # type: ignore[arg-type]
    assert len(pl.load_photons(tmp_path / "e.zarr")) == 0


def run_killed_save(target: Path, limit: int) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-c", KILLED_SAVE, str(target), str(limit), *(p for p in sys.path if p)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=120)


def test_killed_save_leaves_the_old_map_or_the_new_one(saved: Path) -> None:
    calls = int(run_killed_save(saved, 0).stdout)
    outcomes = {OLD: build(OLD).positions.tobytes(), NEW: build(NEW).positions.tobytes()}
    # The last steps, where the folders change places, and points spread over the writing before.
    for limit in [*np.linspace(1, calls - 60, 4, dtype=int), *range(calls - 60, calls, 12)]:
        build(OLD).save(saved)
        assert run_killed_save(saved, int(limit)).returncode == -signal.SIGKILL
        assert pl.load_photons(saved).positions.tobytes() in outcomes.values()


def test_next_save_clears_what_a_killed_one_left(saved: Path) -> None:
    calls = int(run_killed_save(saved, 0).stdout)
    run_killed_save(saved, calls // 2)
    assert any(path.name.endswith(".writing") for path in saved.parent.iterdir())
    build(NEW).save(saved)
    assert not any(path.name.endswith(".writing") for path in saved.parent.iterdir())


def test_missing_map_is_named(tmp_path: Path) -> None:
    with pytest.raises(pl.FileFormatError, match=r"none\.zarr"):
        pl.load_photons(tmp_path / "none.zarr")


def test_missing_array_is_named(saved: Path) -> None:
    (saved / "power").rename(saved / "nothing")
    with pytest.raises(pl.FileFormatError, match="power"):
        pl.load_photons(saved)


def test_missing_chunk_is_named(saved: Path) -> None:
    (saved / "power" / "c" / "0" / "0").unlink()
    with pytest.raises(pl.FileFormatError, match="power"):
        pl.load_photons(saved)


def test_flipped_bit_is_noticed(saved: Path) -> None:
    chunk = saved / "positions" / "c" / "0" / "0"
    data = bytearray(chunk.read_bytes())
    data[len(data) // 2] ^= 1
    chunk.write_bytes(data)
    with pytest.raises(pl.FileFormatError, match="positions"):
        pl.load_photons(saved)


def test_link_out_of_the_folder_is_refused(saved: Path) -> None:
    chunk = saved / "positions" / "c" / "0" / "0"
    chunk.rename(saved.parent / "elsewhere")
    chunk.symlink_to(saved.parent / "elsewhere")
    with pytest.raises(pl.FileFormatError, match="link"):
        pl.load_photons(saved)


@pytest.mark.parametrize(
    ("key", "value"),
    [("shape", [2**40, 3]), ("shape", [-1, 3]), ("shape", [PHOTONS, 4]), ("data_type", "float64"), ("codecs", [])],
)
def test_changed_description_is_refused(saved: Path, key: str, value: object) -> None:
    place = saved / "positions" / "zarr.json"
    document = json.loads(place.read_text())
    document[key] = value
    place.write_text(json.dumps(document))
    with pytest.raises(pl.FileFormatError, match="positions"):
        pl.load_photons(saved)


@pytest.mark.parametrize("text", ["", "[]", "{", "null", '{"attributes": 3}'])
def test_damaged_group_is_refused(saved: Path, text: str) -> None:
    (saved / "zarr.json").write_text(text)
    with pytest.raises(pl.FileFormatError):
        pl.load_photons(saved)


def test_map_that_stepped_aside_is_still_found(saved: Path) -> None:
    # What a kill leaves on a file system that cannot exchange two folders.
    saved.rename(saved.with_name(".map.zarr.old"))
    np.testing.assert_array_equal(pl.load_photons(saved).positions, build(OLD).positions)


def test_save_works_without_an_exchange(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("photonloupe.atomic._exchange", lambda a, b: False)
    build(NEW).save(saved)
    np.testing.assert_array_equal(pl.load_photons(saved).positions, build(NEW).positions)
