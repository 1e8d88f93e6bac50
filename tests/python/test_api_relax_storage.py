# SPDX-License-Identifier: Apache-2.0
"""A relaxed map knows the paths its photons were traced on, and survives saving and selecting bit for bit."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from photonloupe.columns import PATH_NAMES, STATE_COLUMNS
from relax_maps import KEPT, STEPS, build, read_column

STATE = tuple(
    column.name for column in STATE_COLUMNS if column.name != "colors"
)  # colors are a script's, see test_api_scripts


@pytest.fixture(scope="module")
def relaxed() -> pl.PhotonMap:
    return build(parameters=True).relax(STEPS)


@pytest.fixture(scope="module")
def traced(ring: pl.Scene) -> pl.PhotonMap:
    """A map of the ring whose paths nobody has read yet."""
    return pl.trace_photons(ring, 2_000, seed=4)


@pytest.fixture(scope="module")
def relaxed_ring(traced: pl.PhotonMap) -> pl.PhotonMap:
    return traced.relax(STEPS)


@pytest.fixture(scope="module")
def traced_paths(ring: pl.Scene) -> dict[str, NDArray[Any]]:
    """Paths of the same photons from a tracing of their own."""
    photons = pl.trace_photons(ring, 2_000, seed=4)
    return {name: getattr(photons, name) for name in PATH_NAMES}


@pytest.fixture
def reloaded(relaxed: pl.PhotonMap, tmp_path: Path) -> pl.PhotonMap:
    relaxed.save(tmp_path / "map.zarr")
    return pl.load_photons(tmp_path / "map.zarr")


def as_saved(value: Any) -> Any:
    """As JSON gives it back: tuples are lists there."""
    return json.loads(json.dumps(value))


@pytest.mark.parametrize("name", PATH_NAMES)
def test_paths_of_a_relaxed_map_are_those_traced(
    relaxed_ring: pl.PhotonMap, traced_paths: dict[str, NDArray[Any]], name: str
) -> None:
    np.testing.assert_array_equal(getattr(relaxed_ring, name), traced_paths[name])


@pytest.mark.parametrize("name", PATH_NAMES)
def test_paths_read_before_relaxing_stay(ring: pl.Scene, traced_paths: dict[str, NDArray[Any]], name: str) -> None:
    photons = pl.trace_photons(ring, 2_000, seed=4, columns=PATH_NAMES)
    np.testing.assert_array_equal(getattr(photons.relax(1), name), traced_paths[name])


def test_loaded_relaxed_map_records_the_paths_traced(
    ring: pl.Scene, traced_paths: dict[str, NDArray[Any]], tmp_path: Path
) -> None:
    pl.trace_photons(ring, 2_000, seed=4).relax(STEPS).save(tmp_path / "map.zarr")
    loaded = pl.load_photons(tmp_path / "map.zarr")
    assert "path_vertices" not in loaded.recorded
    np.testing.assert_array_equal(loaded.path_vertices, traced_paths["path_vertices"])


def test_map_relaxed_twice_records_the_paths_traced(ring: pl.Scene, traced_paths: dict[str, NDArray[Any]]) -> None:
    twice = pl.trace_photons(ring, 2_000, seed=4).relax(1).relax(1)
    np.testing.assert_array_equal(twice.path_vertices, traced_paths["path_vertices"])


def test_selection_of_a_relaxed_map_records_its_own_paths(
    relaxed_ring: pl.PhotonMap, traced_paths: dict[str, NDArray[Any]]
) -> None:
    ids = np.arange(len(relaxed_ring))[::-7]
    picked = relaxed_ring.select(ids)
    ends = traced_paths["path_vertices"][traced_paths["path_offsets"][1:] - 1]
    np.testing.assert_array_equal(picked.path_vertices[picked.path_offsets[1:] - 1], ends[ids])


def test_path_ends_where_the_photon_was_traced(traced: pl.PhotonMap, relaxed_ring: pl.PhotonMap) -> None:
    ends = relaxed_ring.path_vertices[relaxed_ring.path_offsets[1:] - 1]
    np.testing.assert_array_equal(ends, traced.positions)


@pytest.mark.parametrize("name", ["positions", "normals", "power", *KEPT, *STATE])
def test_column_survives_saving_bit_for_bit(relaxed: pl.PhotonMap, reloaded: pl.PhotonMap, name: str) -> None:
    assert read_column(reloaded, name) == read_column(relaxed, name)


def test_report_survives_saving(relaxed: pl.PhotonMap, reloaded: pl.PhotonMap) -> None:
    assert as_saved(reloaded.relaxation) == as_saved(relaxed.relaxation)


def test_loaded_map_relaxes_on_as_the_saved_one(relaxed: pl.PhotonMap, reloaded: pl.PhotonMap) -> None:
    assert reloaded.relax(1).positions.tobytes() == relaxed.relax(1).positions.tobytes()


def test_loaded_traced_map_relaxes_as_the_saved_one(
    traced: pl.PhotonMap, relaxed_ring: pl.PhotonMap, tmp_path: Path
) -> None:
    traced.save(tmp_path / "map.zarr")
    relaxed = pl.load_photons(tmp_path / "map.zarr").relax(STEPS)
    assert relaxed.positions.tobytes() == relaxed_ring.positions.tobytes()


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("pressure", -1.0, "is below 0"),
        ("drift", np.inf, "is not finite"),
        ("constraint_weights", 1.5, "is above 1"),
        ("constraint_basis", np.nan, "is not finite"),
        ("traced_positions", np.nan, "is not finite"),
    ],
)
def test_saved_state_that_cannot_be_is_refused(
    relaxed: pl.PhotonMap, tmp_path: Path, name: str, value: float, message: str
) -> None:
    import zarr  # noqa: PLC0415 - only here

    relaxed.save(tmp_path / "map.zarr")
    array = zarr.open_array(store=tmp_path / "map.zarr" / name, mode="r+")
    values = np.array(array[...])
    values[3] = value
    array[...] = values
    with pytest.raises(pl.FileFormatError, match=rf"{name}\[3\].*{message}"):
        pl.load_photons(tmp_path / "map.zarr")


@pytest.mark.parametrize("name", STATE)
def test_selection_keeps_the_state_of_its_photons(relaxed: pl.PhotonMap, name: str) -> None:
    rows = relaxed.read_columns()[name][[9, 4]]
    assert read_column(relaxed.select([9, 4]), name) == (rows.dtype, rows.shape, rows.tobytes())


def test_selection_keeps_the_report(relaxed: pl.PhotonMap) -> None:
    assert relaxed.select([9, 4]).relaxation == relaxed.relaxation
