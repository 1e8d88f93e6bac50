# SPDX-License-Identifier: Apache-2.0
"""Maps of a user's own photons: what is accepted, and what is refused by column and row."""

from __future__ import annotations

import numpy as np
import pytest

import photonloupe as pl
from conftest import make_columns

PHOTONS = 20


def build(**changes: object) -> pl.PhotonMap:
    return pl.PhotonMap.from_arrays(**{**make_columns(PHOTONS), **changes})  # type: ignore[arg-type]


def change(name: str, place: object, value: float) -> dict[str, np.ndarray]:
    column = make_columns(PHOTONS)[name].copy()
    column[place] = value
    return {name: column}


@pytest.mark.parametrize("name", list(make_columns(1)))
def test_column_comes_back_bit_for_bit(name: str) -> None:
    np.testing.assert_array_equal(getattr(build(), name), make_columns(PHOTONS)[name])


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
@pytest.mark.parametrize("name", ["positions", "normals", "power", "path_vertices", "path_normals", "path_scatter"])
def test_value_that_is_not_finite_is_refused_by_column_and_row(name: str, value: float) -> None:
    place = (7, 1) if name != "path_scatter" else (7,)
    with pytest.raises(pl.ArgumentError, match=rf"{name}\[7\]"):
        build(**change(name, place, value))


def test_double_that_overflows_a_float_is_refused() -> None:
    positions = make_columns(PHOTONS)["positions"].astype(np.float64)
    positions[3, 2] = 1e39
    with pytest.raises(pl.ArgumentError, match=r"positions\[3\]\[2\]"):
        build(positions=positions)


@pytest.mark.parametrize("name", ["positions", "normals", "power", "path_vertices"])
def test_wrong_width_is_refused(name: str) -> None:
    with pytest.raises(pl.ArgumentError, match=name):
        build(**{name: make_columns(PHOTONS)[name][:, :2]})


@pytest.mark.parametrize("name", ["normals", "power", "emitter", "emitted_index", "object"])
def test_shorter_column_is_refused(name: str) -> None:
    with pytest.raises(pl.ArgumentError, match=name):
        build(**{name: make_columns(PHOTONS)[name][:-1]})


@pytest.mark.parametrize("name", ["path_normals", "path_interactions", "path_objects", "path_scatter"])
def test_shorter_path_column_is_refused(name: str) -> None:
    with pytest.raises(pl.ArgumentError, match=name):
        build(**{name: make_columns(PHOTONS)[name][:-1]})


@pytest.mark.parametrize(("row", "value"), [(0, 1), (5, 10_000), (5, 0), (PHOTONS, 3)])
def test_bad_offset_is_refused(row: int, value: int) -> None:
    with pytest.raises(pl.ArgumentError, match="path_offsets"):
        build(**change("path_offsets", row, value))


def test_offsets_of_another_length_are_refused() -> None:
    with pytest.raises(pl.ArgumentError, match="path_offsets"):
        build(path_offsets=make_columns(PHOTONS)["path_offsets"][:-1])


@pytest.mark.parametrize(("name", "value"), [("path_interactions", 4), ("emitter", -1), ("object", -2)])
def test_value_out_of_range_is_refused_by_row(name: str, value: int) -> None:
    column = make_columns(PHOTONS)[name].astype(np.int64)
    column[4] = value
    with pytest.raises(pl.ArgumentError, match=rf"{name}\[4\]"):
        build(**{name: column})


def test_negative_power_is_refused() -> None:
    with pytest.raises(pl.ArgumentError, match=r"power\[2\]\[0\]"):
        build(**change("power", (2, 0), -1.0))


def test_normal_that_is_not_unit_is_refused() -> None:
    with pytest.raises(pl.ArgumentError, match=r"normals\[6\]"):
        build(**change("normals", 6, 1.0))


def test_whole_number_column_refuses_fractions() -> None:
    with pytest.raises(pl.ArgumentError, match=r"emitter\[0\]"):
        build(emitter=np.full(PHOTONS, 0.5))


def test_vertices_without_offsets_are_refused() -> None:
    columns = make_columns(PHOTONS)
    del columns["path_offsets"]
    with pytest.raises(pl.ArgumentError, match="path_offsets"):
        pl.PhotonMap.from_arrays(**columns)  # type: ignore[arg-type]


def test_emitted_below_an_index_is_refused() -> None:
    with pytest.raises(pl.ArgumentError, match="emitted"):
        build(emitted=1)


def test_map_does_not_change_with_the_callers_array() -> None:
    positions = make_columns(PHOTONS)["positions"].copy()
    photons = build(positions=positions)
    positions[0] = 99.0
    assert photons.positions[0, 0] != 99.0


def test_callers_array_stays_writable() -> None:
    positions = make_columns(PHOTONS)["positions"].copy()
    build(positions=positions)
    assert positions.flags.writeable


def test_map_of_no_photons_is_allowed() -> None:
    assert len(pl.PhotonMap.from_arrays(**make_columns(0, paths=False))) == 0  # type: ignore[arg-type]


def test_map_without_scene_says_why_it_has_no_paths() -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(3, paths=False))  # type: ignore[arg-type]
    with pytest.raises(pl.PhotonLoupeError, match="not traced here"):
        photons.path_vertices  # noqa: B018
