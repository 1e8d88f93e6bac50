# SPDX-License-Identifier: Apache-2.0
"""A user's own parameters: what is taken, what is refused and why, and that they stay with their photons."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from conftest import make_columns

PHOTONS = 24
NAMES = ("right", "up", "turn")
BOUNDS = ((-1.0, 1.0), (0.0, 4.0), (0.0, np.pi))
PERIODIC = (False, False, True)


@pytest.fixture
def photons() -> pl.PhotonMap:
    return pl.PhotonMap.from_arrays(**make_columns(PHOTONS))  # type: ignore[arg-type]


def make_values(width: int = 3, *, count: int = PHOTONS, seed: int = 0) -> NDArray[np.float64]:
    return np.random.default_rng(seed).random((count, width))


def set_all(photons: pl.PhotonMap) -> NDArray[np.float64]:
    """Set parameters with everything that can be said of them; photon 5 has none."""
    values = make_values()
    values[5, 1] = np.nan
    photons.set_parameters(values, NAMES, BOUNDS, PERIODIC)
    return values


def test_values_come_back_as_32_bit_floats(photons: pl.PhotonMap) -> None:
    values = make_values()
    photons.set_parameters(values)
    np.testing.assert_array_equal(photons.parameters, values.astype(np.float32))


@pytest.mark.parametrize("width", [1, 13])
def test_fewest_and_most_dimensions_are_taken(photons: pl.PhotonMap, width: int) -> None:
    photons.set_parameters(make_values(width))
    assert photons.parameters.shape == (PHOTONS, width)


def test_one_value_each_is_one_dimension(photons: pl.PhotonMap) -> None:
    photons.set_parameters(np.arange(PHOTONS))
    np.testing.assert_array_equal(photons.parameters, np.arange(PHOTONS, dtype=np.float32)[:, None])


def test_map_without_photons_takes_no_values() -> None:
    empty = pl.PhotonMap.from_arrays(**make_columns(0, paths=False))  # type: ignore[arg-type]
    empty.set_parameters(np.zeros((0, 2)))
    assert empty.parameters.shape == (0, 2)


def test_later_changes_of_the_callers_array_do_not_reach_the_map(photons: pl.PhotonMap) -> None:
    values = make_values().astype(np.float32)
    photons.set_parameters(values)
    values[:] = 9.0
    np.testing.assert_array_equal(photons.parameters, make_values().astype(np.float32))


def test_parameters_cannot_be_written_through_the_map(photons: pl.PhotonMap) -> None:
    photons.set_parameters(make_values())
    with pytest.raises(ValueError, match="read-only"):
        photons.parameters[0, 0] = 1.0


def test_names_count_dimensions_from_three(photons: pl.PhotonMap) -> None:
    photons.set_parameters(make_values(2))
    assert photons.parameter_names == ("p3", "p4")


def test_names_are_those_given(photons: pl.PhotonMap) -> None:
    set_all(photons)
    assert photons.parameter_names == NAMES


def test_bounds_are_the_extremes_of_the_set_photons(photons: pl.PhotonMap) -> None:
    values = make_values(2)
    values[3] = (np.nan, 100.0)
    photons.set_parameters(values)
    rest = np.delete(values, 3, axis=0).astype(np.float32)
    np.testing.assert_array_equal(photons.parameter_bounds, np.stack([rest.min(axis=0), rest.max(axis=0)], axis=1))


def test_bounds_are_those_given(photons: pl.PhotonMap) -> None:
    set_all(photons)
    np.testing.assert_array_equal(photons.parameter_bounds, np.float32(BOUNDS))


def test_bounds_where_no_photon_is_set_are_zero(photons: pl.PhotonMap) -> None:
    photons.set_parameters(np.full((PHOTONS, 2), np.nan))
    np.testing.assert_array_equal(photons.parameter_bounds, np.zeros((2, 2)))


def test_periodic_flags_come_back(photons: pl.PhotonMap) -> None:
    set_all(photons)
    assert [parameter.periodic for parameter in photons.parameter_list] == list(PERIODIC)


def test_nothing_is_periodic_unless_said(photons: pl.PhotonMap) -> None:
    photons.set_parameters(make_values(2))
    assert [parameter.periodic for parameter in photons.parameter_list] == [False, False]


def test_distance_wraps_in_a_periodic_dimension(photons: pl.PhotonMap) -> None:
    values = np.linspace(0.3, 0.6, PHOTONS)
    values[:2] = 0.01, 0.99
    one_emitter = pl.PhotonMap.from_arrays(positions=photons.positions, normals=photons.normals, power=photons.power)
    one_emitter.set_parameters(values, bounds=[(0.0, 1.0)], periodic=[True])
    ids, distances = one_emitter.neighbors([0], 1, space="parameter")
    assert (ids[0, 0], distances[0, 0]) == (1, pytest.approx(0.02, abs=1e-6))


def test_photon_with_a_nan_is_unset(photons: pl.PhotonMap) -> None:
    set_all(photons)
    assert np.flatnonzero(~photons.parameters_set).tolist() == [5]


def test_unset_photon_is_nobodys_neighbor_in_parameter_space(photons: pl.PhotonMap) -> None:
    set_all(photons)
    found = photons.neighbors(np.flatnonzero(photons.parameters_set), PHOTONS, space="parameter")[0]
    assert 5 not in found


@pytest.mark.parametrize("value", [np.inf, -np.inf, 1e39])
def test_infinite_value_is_refused_by_row_and_column(photons: pl.PhotonMap, value: float) -> None:
    values = make_values()
    values[7, 2] = value
    with pytest.raises(pl.ArgumentError, match=r"values\[7\]\[2\]"):
        photons.set_parameters(values)


@pytest.mark.parametrize(
    "values",
    [
        np.zeros((PHOTONS, 0)),
        np.zeros((PHOTONS, 14)),
        np.zeros((PHOTONS, 2, 1)),
        np.zeros((PHOTONS - 1, 2)),
        np.zeros(PHOTONS + 1),
        np.float64(1.0),
        np.full((PHOTONS, 2), "a"),
        np.zeros((PHOTONS, 2), dtype=complex),
        [[1.0]] * (PHOTONS - 1) + [[1.0, 2.0]],
    ],
    ids=["none", "fourteen", "deep", "short", "long", "scalar", "text", "complex", "ragged"],
)
def test_values_of_the_wrong_shape_or_kind_are_refused(photons: pl.PhotonMap, values: Any) -> None:
    with pytest.raises(pl.ArgumentError, match="values"):
        photons.set_parameters(values)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"names": ["a"]}, "names has 1 entries"),
        ({"names": ["a", "a"]}, "distinct"),
        ({"names": ["a", ""]}, "not empty"),
        ({"bounds": [(0.0, 1.0)]}, r"bounds must have shape \(2, 2\)"),
        ({"bounds": [(0.0, 1.0), (1.0, 0.0)]}, r"bounds\[1\] runs"),
        ({"bounds": [(0.0, 1.0), (0.0, np.nan)]}, r"bounds\[1\]\[1\]"),
        ({"bounds": [(-np.inf, 1.0), (0.0, 1.0)]}, r"bounds\[0\]\[0\]"),
        ({"bounds": [("low", 1.0), (0.0, 1.0)]}, "bounds"),
        ({"bounds": [(0.0, 1.0), (0.0,)]}, "bounds"),
        ({"periodic": [True]}, "periodic has 1 entries"),
        ({"periodic": [False, True]}, "p4 is periodic: its bounds must be given"),
        ({"periodic": [True, False], "bounds": [(1.0, 1.0), (0.0, 1.0)]}, "p3 is periodic from 1 to 1"),
    ],
    ids=lambda value: None if isinstance(value, str) else str(value),
)
def test_description_that_does_not_fit_is_refused(
    photons: pl.PhotonMap, keywords: dict[str, Any], message: str
) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        photons.set_parameters(make_values(2), **keywords)


def test_refused_call_leaves_the_parameters_there_were(photons: pl.PhotonMap) -> None:
    values = set_all(photons)
    with pytest.raises(pl.ArgumentError):
        photons.set_parameters(make_values(2), ["a", "a"])
    np.testing.assert_array_equal(photons.parameters, values.astype(np.float32))


def test_second_call_replaces_names_and_values(photons: pl.PhotonMap) -> None:
    set_all(photons)
    photons.set_parameters(make_values(1, seed=1), ["only"])
    assert (photons.parameter_names, photons.parameters.shape) == (("only",), (PHOTONS, 1))


def test_second_call_replaces_the_values_that_neighbors_are_found_by() -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.zeros((3, 3)), normals=[[0, 1, 0]] * 3, power=np.ones((3, 3)))
    photons.set_parameters([0.0, 1.0, 5.0])
    before = photons.neighbors([0], 1, space="parameter")[0][0, 0]
    photons.set_parameters([[0.0, 0.0], [9.0, 0.0], [0.0, 2.0]])
    assert (before, photons.neighbors([0], 1, space="parameter")[0][0, 0]) == (1, 2)


def test_map_without_parameters_says_who_sets_them(photons: pl.PhotonMap) -> None:
    with pytest.raises(pl.PhotonLoupeError, match="set_parameters"):
        _ = photons.parameters


def test_map_without_parameters_has_no_names(photons: pl.PhotonMap) -> None:
    assert photons.parameter_names == ()


def test_selection_keeps_the_values_of_its_photons(photons: pl.PhotonMap) -> None:
    values = set_all(photons)
    np.testing.assert_array_equal(photons.select([7, 5, 2]).parameters, values[[7, 5, 2]].astype(np.float32))


def test_selection_keeps_names_bounds_and_periods(photons: pl.PhotonMap) -> None:
    set_all(photons)
    assert photons.select([7, 5]).parameter_list == photons.parameter_list


def test_parameters_of_a_selection_are_its_own(photons: pl.PhotonMap) -> None:
    set_all(photons)
    photons.select([7, 5]).set_parameters([1.0, 2.0], ["other"])
    assert photons.parameter_names == NAMES


@pytest.fixture
def saved(photons: pl.PhotonMap, tmp_path: Path) -> Path:
    set_all(photons)
    photons.save(tmp_path / "map.zarr")
    return tmp_path / "map.zarr"


def test_values_survive_saving_bit_for_bit(photons: pl.PhotonMap, saved: Path) -> None:
    assert pl.load_photons(saved).parameters.tobytes() == photons.parameters.tobytes()


def test_names_bounds_and_periods_survive_saving(photons: pl.PhotonMap, saved: Path) -> None:
    assert pl.load_photons(saved).parameter_list == photons.parameter_list


def test_loaded_map_finds_the_same_neighbors_in_parameter_space(photons: pl.PhotonMap, saved: Path) -> None:
    ids = np.arange(PHOTONS)
    loaded = pl.load_photons(saved).neighbors(ids, 4, space="parameter")
    for there, here in zip(loaded, photons.neighbors(ids, 4, space="parameter"), strict=True):
        np.testing.assert_array_equal(there, here)


def change_row(key: str, value: Any) -> Callable[[dict[str, Any]], None]:
    """Change what is said of the second parameter."""

    def change(attributes: dict[str, Any]) -> None:
        attributes["parameters"][1][key] = value

    return change


def drop_row(attributes: dict[str, Any]) -> None:
    del attributes["parameters"][1]


def drop_name(attributes: dict[str, Any]) -> None:
    del attributes["parameters"][0]["name"]


def drop_all(attributes: dict[str, Any]) -> None:
    del attributes["parameters"]


def name_no_list(attributes: dict[str, Any]) -> None:
    attributes["parameters"] = "right, up, turn"


def name_no_rows(attributes: dict[str, Any]) -> None:
    attributes["parameters"] = [1, 2, 3]


@pytest.mark.parametrize(
    "change",
    [
        drop_row,
        drop_name,
        drop_all,
        name_no_list,
        name_no_rows,
        change_row("name", "right"),
        change_row("name", ""),
        change_row("low", "zero"),
        change_row("low", None),
        change_row("low", 9.0),
        change_row("high", float("nan")),
        change_row("high", 1e300),
        change_row("periodic", "no"),
    ],
    ids=[
        "row",
        "no name",
        "nothing",
        "text",
        "numbers",
        "twice",
        "empty",
        "low",
        "null",
        "order",
        "nan",
        "huge",
        "flag",
    ],
)
def test_damaged_description_is_refused(saved: Path, change: Callable[[dict[str, Any]], None]) -> None:
    document = json.loads((saved / "zarr.json").read_text())
    change(document["attributes"])
    (saved / "zarr.json").write_text(json.dumps(document))
    with pytest.raises(pl.FileFormatError, match="parameters"):
        pl.load_photons(saved)


@pytest.mark.parametrize("shape", [[PHOTONS, 2], [PHOTONS, 14], [PHOTONS, 0], [PHOTONS - 1, 3], [PHOTONS]])
def test_array_of_another_shape_is_refused(saved: Path, shape: list[int]) -> None:
    place = saved / "parameters" / "zarr.json"
    document = json.loads(place.read_text())
    document["shape"] = shape
    place.write_text(json.dumps(document))
    with pytest.raises(pl.FileFormatError, match="parameters"):
        pl.load_photons(saved)


def test_saved_infinity_is_refused(saved: Path) -> None:
    import zarr  # noqa: PLC0415 - only here

    values = make_values().astype(np.float32)
    values[2, 1] = np.inf
    zarr.open_array(store=saved / "parameters", mode="r+")[...] = values
    with pytest.raises(pl.FileFormatError, match=r"parameters\[2\]\[1\]"):
        pl.load_photons(saved)
