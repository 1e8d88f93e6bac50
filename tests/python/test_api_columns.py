# SPDX-License-Identifier: Apache-2.0
"""What a traced map holds: types, shapes, paths recorded on demand, the same bits for the same seed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl

BLOCK = 4096  # emitted indices are taken in whole blocks


@pytest.mark.parametrize(
    ("name", "dtype", "width"),
    [
        ("positions", np.float32, 3),
        ("normals", np.float32, 3),
        ("power", np.float32, 3),
        ("emitter", np.int32, 0),
        ("emitted_index", np.uint64, 0),
        ("object", np.int32, 0),
    ],
)
def test_photon_column_has_its_type_and_shape(ring_map: pl.PhotonMap, name: str, dtype: type, width: int) -> None:
    column = getattr(ring_map, name)
    assert (column.dtype, column.shape) == (dtype, (len(ring_map), width) if width else (len(ring_map),))


@pytest.mark.parametrize(
    ("name", "dtype", "width"),
    [
        ("path_vertices", np.float32, 3),
        ("path_normals", np.float32, 3),
        ("path_interactions", np.uint8, 0),
        ("path_objects", np.int32, 0),
        ("path_scatter", np.float32, 0),
    ],
)
def test_path_column_has_its_type_and_shape(ring_map: pl.PhotonMap, name: str, dtype: type, width: int) -> None:
    column = getattr(ring_map, name)
    rows = int(ring_map.path_offsets[-1])
    assert (column.dtype, column.shape) == (dtype, (rows, width) if width else (rows,))


def test_columns_are_read_only(ring_map: pl.PhotonMap) -> None:
    with pytest.raises(ValueError, match="read-only"):
        ring_map.positions[0] = 0.0


def test_count_is_the_least_number_stored(ring_map: pl.PhotonMap) -> None:
    assert len(ring_map) >= 200_000


def test_photons_are_emitted_in_whole_blocks(ring_map: pl.PhotonMap) -> None:
    assert ring_map.emitted % BLOCK == 0


def test_emitted_index_ascends(ring_map: pl.PhotonMap) -> None:
    assert (np.diff(ring_map.emitted_index.astype(np.int64)) >= 0).all()


def test_every_index_was_emitted(ring_map: pl.PhotonMap) -> None:
    assert int(ring_map.emitted_index.max()) < ring_map.emitted


def test_paths_end_at_the_photons(ring_map: pl.PhotonMap) -> None:
    np.testing.assert_array_equal(ring_map.path_vertices[ring_map.path_offsets[1:] - 1], ring_map.positions)


def test_paths_start_at_the_lamp(ring_map: pl.PhotonMap, ring: pl.Scene) -> None:
    starts = ring_map.path_vertices[ring_map.path_offsets[:-1]]
    np.testing.assert_allclose(starts, np.tile((0.0, 1.6, 2.0), (len(starts), 1)), atol=1e-6)


def test_only_ends_have_no_interaction(ring_map: pl.PhotonMap) -> None:
    ends = np.zeros(len(ring_map.path_interactions), dtype=bool)
    ends[ring_map.path_offsets[:-1]] = True
    ends[ring_map.path_offsets[1:] - 1] = True
    np.testing.assert_array_equal(ring_map.path_interactions == 0, ends)


def test_stored_normals_point_up_on_the_floor(ring_map: pl.PhotonMap) -> None:
    np.testing.assert_allclose(ring_map.normals, np.tile((0.0, 1.0, 0.0), (len(ring_map), 1)), atol=1e-6)


def test_power_times_photons_is_the_total_flux(ring_map: pl.PhotonMap) -> None:
    np.testing.assert_allclose(ring_map.total_flux, ring_map.power.astype(np.float64).sum(axis=0), rtol=1e-12)


def test_paths_recorded_at_once_are_those_recorded_later(ring: pl.Scene) -> None:
    later = pl.trace_photons(ring, 5_000, seed=3)
    at_once = pl.trace_photons(ring, 5_000, seed=3, columns=["path_vertices"])
    assert "path_vertices" in at_once.recorded
    np.testing.assert_array_equal(later.path_vertices, at_once.path_vertices)


def test_same_seed_gives_the_same_bits(ring: pl.Scene) -> None:
    first, second = (pl.trace_photons(ring, 10_000, seed=5) for _ in range(2))
    assert first.positions.tobytes() == second.positions.tobytes()


def test_other_seed_gives_other_photons(ring: pl.Scene) -> None:
    first, second = (pl.trace_photons(ring, 10_000, seed=seed).positions for seed in (5, 6))
    rows = min(len(first), len(second))
    assert (first[:rows] != second[:rows]).any(axis=1).mean() > 0.99


def test_larger_map_begins_with_the_same_paths(ring: pl.Scene) -> None:
    small, large = (pl.trace_photons(ring, count, seed=7) for count in (5_000, 20_000))
    np.testing.assert_array_equal(large.positions[: len(small)], small.positions)


def test_emitted_fixes_the_emission(ring: pl.Scene) -> None:
    assert pl.trace_photons(ring, emitted=3 * BLOCK).emitted == 3 * BLOCK


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"count": 0}, "count"),
        ({"count": 1.5}, "count"),
        ({"seed": -1}, "seed"),
        ({"emission": "halton"}, "emission"),
        ({"store": "everything"}, "store"),
        ({"max_bounces": 65}, "max_bounces"),
        ({"columns": ["paths"]}, "columns"),
        ({"emitted": 0}, "emitted"),
    ],
)
def test_wrong_setting_is_refused_by_name(ring: pl.Scene, settings: dict, message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        pl.trace_photons(ring, **settings)


def test_unknown_device_lists_those_there(ring: pl.Scene) -> None:
    with pytest.raises(pl.DeviceError):
        pl.trace_photons(ring, 100, device="no such device")


def test_repr_says_what_it_is(ring_map: pl.PhotonMap) -> None:
    assert "ring.gltf" in repr(ring_map)
    assert f"{len(ring_map):,} photons" in repr(ring_map)


def test_arrow_table_has_a_row_for_every_photon(ring: pl.Scene) -> None:
    photons = pl.trace_photons(ring, 1_000, columns=["path_vertices"])
    table = photons.to_arrow()
    assert table.num_rows == len(photons)
    assert len(table["path_vertices"][0]) == int(np.diff(photons.path_offsets)[0])


def test_columns_pass_through_dlpack(ring_map: pl.PhotonMap) -> None:
    assert np.from_dlpack(ring_map.positions.copy()).shape == ring_map.positions.shape


def test_scene_lists_its_cameras(ring: pl.Scene) -> None:
    assert [camera["name"] for camera in ring.cameras] == ["top", "view", "close"]


def test_missing_scene_is_named(tmp_path: Path) -> None:
    with pytest.raises(pl.SceneError, match=r"none\.gltf"):
        pl.load_scene(tmp_path / "none.gltf")
