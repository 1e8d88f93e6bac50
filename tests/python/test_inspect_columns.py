# SPDX-License-Identifier: Apache-2.0
"""Columns are what their definitions say, in every scene, and say what they lack."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
import relax_maps
from conftest import find_scene, make_columns
from inspect_twins import COLUMNS
from script_twins import measure_isotropy

SCENES = ("ring", "prism", "slab")
COUNT = 2_000
# Of values about 1, rounded once from a difference of 32-bit coordinates.
TOLERANCE = 2e-5
# Angles where φ has no lever: θ beneath this.
LEAST_THETA = 1e-3


@cache
def get_map(scene: str) -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene(scene)), COUNT, seed=3, store="indirect")


@cache
def get_arrays() -> pl.PhotonMap:
    columns = make_columns(500, seed=9)
    columns["path_normals"] /= np.linalg.norm(columns["path_normals"], axis=1, keepdims=True)
    columns["path_interactions"] = (1 + np.arange(len(columns["path_normals"])) % 2).astype(np.uint8)
    return pl.PhotonMap.from_arrays(**columns)


@pytest.mark.parametrize("scene", [*SCENES, "arrays"])
@pytest.mark.parametrize("name", COLUMNS)
def test_columns_equal_their_definitions(scene: str, name: str) -> None:
    photons = get_arrays() if scene == "arrays" else get_map(scene)
    found = pl.inspect.column(photons, name)
    expected = COLUMNS[name](photons)
    away = found.values.astype(np.float64) - expected
    if found.period > 0.0:
        away -= found.period * np.round(away / found.period)
        lever = found.period and name != "normal_angle"
        theta = COLUMNS[name.replace("phi", "theta")](photons) if lever else np.ones(len(photons))
        away[theta < LEAST_THETA] = 0.0
    np.testing.assert_array_equal(np.isnan(found.values), np.isnan(expected))
    scale = max(1.0, float(np.nanmax(np.abs(expected), initial=0.0)))
    assert np.nanmax(np.abs(away), initial=0.0) <= TOLERANCE * scale


def test_ranges_are_those_of_the_values_and_of_angles_a_turn() -> None:
    photons = get_map("ring")
    x, phi = pl.inspect.column(photons, "x"), pl.inspect.column(photons, "primal_phi")
    assert (x.low, x.high, x.period) == (x.values.min(), x.values.max(), 0.0)
    assert phi.period == pytest.approx(2.0 * np.pi)
    assert (phi.low, phi.high) == pytest.approx((-np.pi, np.pi))


def test_signatures_and_emitters_are_discrete() -> None:
    discrete = {info.name for info in pl.inspect.columns(get_map("ring")) if info.discrete}
    assert discrete == {"emitter", "object", "vertices", "signature"}


def test_parameters_are_columns_by_their_names_with_their_bounds() -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(100, paths=False))
    values = np.random.default_rng(0).random((100, 4))
    values[3, 1] = np.nan
    values[:, 2] = np.arange(100) % 5
    photons.set_parameters(
        values, ["phi", "x", "kind", "plain"], [(0, 2), (-1, 1), (0, 9), (0, 0)], [True] + [False] * 3
    )
    names = [info.name for info in pl.inspect.columns(photons)]
    assert names[-4:] == ["phi", "parameter.x", "kind", "plain"]
    phi = pl.inspect.column(photons, "phi")
    assert (phi.low, phi.high, phi.period, phi.discrete) == (0.0, 2.0, 2.0, False)
    shown = values.astype(np.float32)
    shown[3] = np.nan  # a photon with one value missing has none
    np.testing.assert_array_equal(phi.values, shown[:, 0])
    np.testing.assert_array_equal(pl.inspect.column(photons, "parameter.x").values, shown[:, 1])
    np.testing.assert_array_equal(pl.inspect.column(photons, "x").values, photons.positions[:, 0])
    assert pl.inspect.column(photons, "kind").discrete
    plain = pl.inspect.column(photons, "plain")
    assert (plain.low, plain.high) == (np.nanmin(shown[:, 3]), np.nanmax(shown[:, 3]))


def test_scripts_leave_their_parameters_as_columns() -> None:
    photons = get_map("ring").select(np.arange(200))
    photons.run_script(
        'declarePhotonParameter(3, 0, 9, "kind"); for (i = 0; i < getNumPhotons(); i++) '
        "setPhotonParameter(i, 3, i % 3);"
    )
    kind = pl.inspect.column(photons, "kind")
    assert (kind.low, kind.high, kind.discrete) == (0.0, 9.0, True)
    np.testing.assert_array_equal(kind.values, np.arange(200) % 3)


def test_isotropy_is_that_of_equation_5() -> None:
    photons = relax_maps.build(parameters=True)
    np.testing.assert_allclose(pl.inspect.column(photons, "isotropy").values, measure_isotropy(photons), atol=1e-3)


def read_state(photons: pl.PhotonMap) -> dict[str, np.ndarray]:
    names = ("drift", "drift_u", "drift_v", "pressure", "w_u", "w_v", "gradient", "one_sidedness")
    return {name: pl.inspect.column(photons, name).values for name in names}


@cache
def get_relaxed() -> pl.PhotonMap:
    return relax_maps.build(parameters=True).relax(steps=3, descriptor="pca", beta=3.0)


def test_what_relaxation_measured_is_in_columns() -> None:
    relaxed = get_relaxed()
    state = read_state(relaxed)
    np.testing.assert_allclose(state["drift"], np.linalg.norm(relaxed.drift, axis=1), rtol=1e-6)
    along = np.abs(np.einsum("ia,ija->ij", relaxed.drift.astype(np.float64), relaxed.constraint_basis))
    np.testing.assert_allclose(np.stack([state["drift_u"], state["drift_v"]], axis=1), along, atol=1e-9)
    np.testing.assert_array_equal(state["pressure"], relaxed.pressure)
    np.testing.assert_array_equal(np.stack([state["w_u"], state["w_v"]], axis=1), relaxed.constraint_weights)
    np.testing.assert_array_equal(state["one_sidedness"], relaxed.one_sidedness)
    np.testing.assert_allclose(state["gradient"], np.linalg.norm(relaxed.gradient, axis=1), rtol=1e-6)
    assert state["drift"].max() > 0.0


def test_what_relaxation_measured_survives_selection_and_files(tmp_path: Path) -> None:
    relaxed = get_relaxed()
    relaxed.save(tmp_path / "map.zarr")
    rows = np.arange(5, 300, 7)
    expected = read_state(relaxed)
    for name, values in read_state(pl.load_photons(tmp_path / "map.zarr")).items():
        np.testing.assert_array_equal(values, expected[name], err_msg=name)
    for name, values in read_state(relaxed.select(rows)).items():
        np.testing.assert_array_equal(values, expected[name][rows], err_msg=name)


def test_constraining_alone_gives_weights_and_no_drift() -> None:
    state = read_state(relax_maps.build().constrain(descriptor="pca"))
    assert state["drift"].max() == 0.0
    assert state["w_v"].max() > 0.0


def test_columns_that_cannot_be_had_say_what_to_do() -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(10, paths=False))
    for name, lack in (
        ("signature", "no paths"),
        ("w_v", "no constraint"),
        ("drift", "not relaxed"),
        ("isotropy", "no parameters"),
    ):
        with pytest.raises(pl.ArgumentError, match=lack):
            pl.inspect.column(photons, name)
    with pytest.raises(pl.ArgumentError, match="there is no column 'phi'; the columns are x, y, z"):
        pl.inspect.column(photons, "phi")


def test_a_path_that_does_not_say_what_it_met_has_no_signature() -> None:
    columns = make_columns(6)
    for name in ("path_interactions", "path_normals", "path_objects", "path_scatter"):
        del columns[name]
    photons = pl.PhotonMap.from_arrays(**columns)
    found = pl.inspect.column(photons, "signature").values
    np.testing.assert_array_equal(np.isnan(found), np.diff(photons.path_offsets) > 2)
    assert np.isnan(pl.inspect.column(photons, "incident_theta").values).all()
    assert np.isfinite(pl.inspect.column(photons, "path_length").values).all()


@pytest.mark.parametrize("count", [0, 1, 2])
def test_few_photons_have_all_columns(count: int) -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(count))
    for info in pl.inspect.columns(photons):
        if not info.missing:
            assert pl.inspect.column(photons, info.name).values.shape == (count,)


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_angles_do_not_depend_on_the_scale(scale: float) -> None:
    columns = make_columns(200, seed=2)
    here = pl.PhotonMap.from_arrays(**columns)
    columns["positions"] *= scale
    columns["path_vertices"] *= scale
    there = pl.PhotonMap.from_arrays(**columns)
    for name in ("primal_theta", "incident_u", "tortuosity"):
        np.testing.assert_allclose(
            pl.inspect.column(there, name).values, pl.inspect.column(here, name).values, atol=TOLERANCE, err_msg=name
        )
    np.testing.assert_allclose(
        pl.inspect.column(there, "path_length").values / scale, pl.inspect.column(here, "path_length").values, rtol=1e-5
    )
