# SPDX-License-Identifier: Apache-2.0
"""Relaxation as an interface: settings and their refusals, the report, what a relaxed map keeps, saving and loading."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from photonloupe.columns import PATH_NAMES, STATE_COLUMNS
from photonloupe.relaxing import SEARCHES

COUNT = 600
STEPS = 3
STATE = tuple(column.name for column in STATE_COLUMNS)
KEPT = ("emitter", "emitted_index", "object")
UP = (0.0, 1.0, 0.0)


def build(count: int = COUNT, *, parameters: bool = False) -> pl.PhotonMap:
    """Photons of two lights on the plane y = 0, denser on one half."""
    rng = np.random.default_rng(5)
    x = np.where(rng.random(count) < 0.8, 0.5 * rng.random(count), rng.random(count))
    photons = pl.PhotonMap.from_arrays(
        positions=np.stack([x, np.zeros(count), rng.random(count)], axis=1),
        normals=np.tile([UP], (count, 1)),
        power=rng.random((count, 3)),
        emitter=np.arange(count) % 2,
        emitted_index=3 * np.arange(count),
        object=np.arange(count) % 5 - 1,
    )
    if parameters:
        set_parameters(photons)
    return photons


def set_parameters(photons: pl.PhotonMap) -> None:
    """A parameter along x, in steps; a few photons are unset."""
    values = np.stack([np.floor(4 * photons.positions[:, 0]), photons.positions[:, 2]], axis=1)
    values[::50] = np.nan
    photons.set_parameters(values, ("layer", "z"))


@pytest.fixture(scope="module")
def photons() -> pl.PhotonMap:
    return build()


@pytest.fixture(scope="module")
def layered() -> pl.PhotonMap:
    return build(parameters=True)


@pytest.fixture(scope="module")
def relaxed(layered: pl.PhotonMap) -> pl.PhotonMap:
    return layered.relax(STEPS)


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


def read_column(photons: pl.PhotonMap, name: str) -> tuple[Any, ...]:
    """Type, shape and bits of a column, also of the traced positions, which have no attribute."""
    values = photons._columns[name]
    return values.dtype, values.shape, values.tobytes()


# Settings


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"steps": -1}, "steps must be from 0 to 10000, not -1"),
        ({"steps": 10_001}, "steps must be from 0"),
        ({"steps": 2.5}, "steps must be a whole number"),
        ({"steps": True}, "steps must be from 0"),
        ({"neighbors": 0}, "neighbors must be from 1 to 998, not 0"),
        ({"neighbors": 999}, "neighbors must be from 1"),
        ({"constraint": "paths"}, "constraint must be one of auto, world, parameter, not 'paths'"),
        ({"descriptor": "ppca"}, "descriptor must be one of none, gradient, pca, tensor, split, not 'ppca'"),
        ({"repel": "auto"}, "repel must be one of world, parameter, not 'auto'"),
        ({"search": "quick"}, "search must be one of exact, .*, not 'quick'"),
        ({"surface": "plane"}, "surface must be one of auto, tangent, not 'plane'"),
        ({"over_relaxation": 0.0}, "over_relaxation must be from 0.001 to 1000, not 0.0"),
        ({"over_relaxation": (2.0, np.nan)}, "over_relaxation must be from"),
        ({"over_relaxation": (2.0, 1.5, 1.0)}, "over_relaxation must be one number, or the first and the last"),
        ({"over_relaxation": "fast"}, "over_relaxation must be"),
        ({"limit": 0.0}, "limit must be from 1e-06 to 1e\\+06, not 0.0"),
        ({"limit": np.inf}, "limit must be from"),
        ({"limit": "none"}, "limit must be a number"),
        ({"constraint_neighbors": 11}, "constraint_neighbors must be from 12 to 998, not 11"),
        ({"constraint_neighbors": 999}, "constraint_neighbors must be from 12"),
        ({"thresholds": (0.5,)}, "thresholds must be the value that leaves free and the one that fixes"),
        ({"thresholds": (0.5, 0.5)}, "thresholds are both 0.5"),
        ({"thresholds": (0.5, np.nan)}, "thresholds must be from"),
        ({"thresholds": 0.5}, "thresholds must be"),
        ({"constraint": "parameter"}, 'constraint="parameter" needs parameters'),
        ({"repel": "parameter"}, 'repel="parameter" needs parameters'),
        ({"beta": -1.0}, "beta must be from 0"),
        ({"beta": "best"}, "beta must be one of auto"),
        ({"period": (1.0, 1.0)}, "period must be three lengths"),
        ({"period": (1.0, -1.0, 0.0)}, "period must be from 0"),
    ],
    ids=lambda value: None if isinstance(value, str) else str(value),
)
def test_setting_out_of_range_is_refused(photons: pl.PhotonMap, settings: dict[str, Any], message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        photons.relax(**settings)


@pytest.mark.parametrize(
    ("beta", "message"),
    [(-1.0, "beta must be from 0"), (np.nan, "beta must be from 0"), ("best", "beta must be one of auto")],
)
def test_beta_out_of_range_is_refused_where_it_is_used(layered: pl.PhotonMap, beta: Any, message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        layered.relax(STEPS, beta=beta)


def test_unknown_setting_is_refused(photons: pl.PhotonMap) -> None:
    with pytest.raises(TypeError, match="speed"):
        photons.relax(speed=1)  # type: ignore[call-arg]


def test_constraint_is_that_of_the_parameters_where_there_are_any(layered: pl.PhotonMap) -> None:
    assert layered.relax(0).relaxation["settings"]["constraint"] == "parameter"


def test_constraint_is_that_of_the_world_where_there_are_no_parameters(photons: pl.PhotonMap) -> None:
    assert photons.relax(0).relaxation["settings"]["constraint"] == "world"


def test_constraint_of_the_world_leaves_parameters_alone(photons: pl.PhotonMap, layered: pl.PhotonMap) -> None:
    here, there = (each.relax(STEPS, constraint="world") for each in (photons, layered))
    assert here.positions.tobytes() == there.positions.tobytes()


def test_layers_change_where_photons_go(layered: pl.PhotonMap) -> None:
    world, parameter = (layered.relax(STEPS, beta=1.0, constraint=space) for space in ("world", "parameter"))
    assert not np.array_equal(world.positions, parameter.positions)


def test_beta_auto_is_that_of_optimal_beta(layered: pl.PhotonMap) -> None:
    assert layered.relax(0, beta="auto").relaxation["settings"]["beta"] == float(pl.optimal_beta(layered))


def test_one_number_is_both_ends_of_over_relaxation(photons: pl.PhotonMap) -> None:
    one, two = (photons.relax(STEPS, over_relaxation=value) for value in (1.5, (1.5, 1.5)))
    assert one.positions.tobytes() == two.positions.tobytes()


def test_neighbors_are_the_second_argument(photons: pl.PhotonMap) -> None:
    assert photons.relax(1, 7).relaxation["settings"]["neighbors"] == 7


def test_settings_that_nothing_was_said_of_are_in_the_report(photons: pl.PhotonMap) -> None:
    assert None not in photons.relax(0).relaxation["settings"].values()


def test_even_emission_needs_fewer_steps(ring: pl.Scene) -> None:
    sobol, random = (pl.trace_photons(ring, 500, emission=emission) for emission in ("sobol", "random"))
    assert pl.Relaxation(sobol).steps < pl.Relaxation(random).steps


@pytest.mark.parametrize("search", SEARCHES)
def test_every_search_moves_photons_apart(photons: pl.PhotonMap, search: str) -> None:
    moved = photons.relax(STEPS, descriptor="none", search=search)
    nearest = [np.median(each.neighbors(np.arange(COUNT), 1)[1]) for each in (photons, moved)]
    assert nearest[1] > nearest[0]


# Report


def test_report_has_a_row_for_each_step(relaxed: pl.PhotonMap) -> None:
    assert [row["step"] for row in relaxed.relaxation["steps"]] == list(range(STEPS))


def test_row_says_how_far_photons_moved(relaxed: pl.PhotonMap) -> None:
    names = {"step", "tau", "mean_move", "largest_move", "mean_pressure", "mean_displacement", "flux_drift"}
    assert set(relaxed.relaxation["steps"][0]) == names


def test_over_relaxation_fades_as_equation_two_says(photons: pl.PhotonMap) -> None:
    rows = photons.relax(10, over_relaxation=(2.0, 1.2)).relaxation["steps"]
    expected = 1.2 + 0.8 * np.exp(-6.0 * (np.arange(10) / 10) ** 2)
    np.testing.assert_allclose([row["tau"] for row in rows], expected, rtol=1e-6)


def test_one_step_displaces_photons_by_their_mean_drift(photons: pl.PhotonMap) -> None:
    moved = photons.relax(1)
    drift = np.linalg.norm(moved.drift.astype(float), axis=1).mean()
    assert moved.relaxation["steps"][0]["mean_displacement"] == pytest.approx(drift, rel=1e-5)


def test_mean_pressure_is_the_mean_of_the_pressures(relaxed: pl.PhotonMap) -> None:
    mean = relaxed.pressure.astype(float).mean()
    assert relaxed.relaxation["steps"][-1]["mean_pressure"] == pytest.approx(mean, rel=1e-5)


def test_limiter_shortens_the_largest_move(photons: pl.PhotonMap) -> None:
    rows = [photons.relax(1, descriptor="none", limit=limit).relaxation["steps"][0] for limit in (0.05, None)]
    assert rows[0]["largest_move"] < rows[1]["largest_move"]


def test_map_from_arrays_moves_in_tangent_planes(relaxed: pl.PhotonMap) -> None:
    assert (relaxed.relaxation["surface"], relaxed.relaxation["off_surface"]) == ("tangent planes", COUNT)


def test_traced_map_returns_to_its_scene(relaxed_ring: pl.PhotonMap, ring_path: Path) -> None:
    assert Path(relaxed_ring.relaxation["surface"]).samefile(ring_path)


def test_traced_map_can_stay_in_tangent_planes(traced: pl.PhotonMap) -> None:
    assert traced.relax(0, surface="tangent").relaxation["surface"] == "tangent planes"


def test_provenance_names_the_relaxation(relaxed: pl.PhotonMap) -> None:
    assert relaxed.provenance["relaxation"] == relaxed.relaxation["settings"]


def test_map_that_was_not_relaxed_has_no_report(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    assert layered.relaxation == {}
    assert relaxed.relaxation != {}


# The new map and the old one


def test_old_map_stays_as_it_was() -> None:
    photons, twin = build(), build()
    photons.relax(STEPS)
    assert photons.recorded == twin.recorded
    assert all(getattr(photons, name).tobytes() == getattr(twin, name).tobytes() for name in twin.recorded)


def test_old_map_still_finds_its_own_neighbors() -> None:
    photons, twin = build(), build()
    photons.relax(STEPS)
    np.testing.assert_array_equal(photons.neighbors([[0.5, 0, 0.5]], 20)[0], twin.neighbors([[0.5, 0, 0.5]], 20)[0])


def test_new_map_finds_neighbors_where_its_photons_are(relaxed: pl.PhotonMap) -> None:
    point = np.array([0.5, 0.0, 0.5], dtype=np.float32)
    nearest = int(np.argmin(np.linalg.norm(relaxed.positions.astype(float) - point, axis=1)))
    assert relaxed.neighbors(point[None], 1)[0].item() == nearest


def test_photons_move(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    assert np.count_nonzero((relaxed.positions != layered.positions).any(axis=1)) > COUNT // 2


def test_drift_is_the_way_from_the_traced_position(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    np.testing.assert_allclose(relaxed.drift, relaxed.positions - layered.positions, atol=1e-6)


@pytest.mark.parametrize("name", KEPT)
def test_column_is_that_of_the_old_map(layered: pl.PhotonMap, relaxed: pl.PhotonMap, name: str) -> None:
    assert getattr(relaxed, name).tobytes() == getattr(layered, name).tobytes()


def test_power_stays_to_the_bit(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    assert relaxed.power.tobytes() == layered.power.tobytes()


def test_total_flux_stays_to_the_bit(traced: pl.PhotonMap, relaxed_ring: pl.PhotonMap) -> None:
    assert relaxed_ring.total_flux.tobytes() == traced.total_flux.tobytes()


def test_number_emitted_stays(traced: pl.PhotonMap, relaxed_ring: pl.PhotonMap) -> None:
    assert relaxed_ring.emitted == traced.emitted


def test_parameters_stay_with_their_photons(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    assert relaxed.parameters.tobytes() == layered.parameters.tobytes()
    assert relaxed.parameter_list == layered.parameter_list


def test_neighbors_in_parameter_space_stay(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    ids = np.arange(0, COUNT, 7)
    here, there = (each.neighbors(ids, 5, space="parameter")[0] for each in (layered, relaxed))
    np.testing.assert_array_equal(here, there)


def test_flux_diffusion_evens_fluxes_out(photons: pl.PhotonMap) -> None:
    assert photons.relax(STEPS, diffuse_flux=True).power.std() < 0.9 * photons.power.std()


def test_flux_diffusion_keeps_the_total(photons: pl.PhotonMap) -> None:
    total = photons.relax(STEPS, diffuse_flux=True).total_flux
    np.testing.assert_allclose(total, photons.total_flux, rtol=1e-6)


def test_photons_of_the_ring_stay_on_its_floor(relaxed_ring: pl.PhotonMap) -> None:
    # Objects are the scene's: the wall, then the floor at y = 0.
    assert np.abs(relaxed_ring.positions[:, 1]).max() < 1e-6


def test_same_settings_give_the_same_bits(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    assert layered.relax(STEPS).positions.tobytes() == relaxed.positions.tobytes()


@pytest.mark.parametrize("count", [0, 1, 2, 3, 12, 13])
@pytest.mark.parametrize("parameters", [False, True])
def test_few_photons_are_relaxed_to_finite_places(count: int, parameters: bool) -> None:
    moved = build(count, parameters=parameters).relax(2)
    assert moved.positions.shape == (count, 3)
    assert np.isfinite(moved.positions).all()


def test_relaxed_map_can_be_read(relaxed: pl.PhotonMap) -> None:
    assert repr(relaxed).startswith(f"<PhotonMap: {COUNT} photons of {relaxed.emitted:,} emitted, flux (")


# Constraint alone


def test_no_steps_leave_every_photon_in_place(layered: pl.PhotonMap) -> None:
    assert layered.relax(0).positions.tobytes() == layered.positions.tobytes()


def test_no_steps_leave_no_drift(layered: pl.PhotonMap) -> None:
    assert not layered.relax(0).drift.any()


def test_constrain_leaves_every_photon_in_place(layered: pl.PhotonMap) -> None:
    assert layered.constrain().positions.tobytes() == layered.positions.tobytes()


@pytest.mark.parametrize("name", ["constraint_basis", "constraint_weights", "gradient", "one_sidedness"])
def test_constrain_measures_what_relax_relaxes_by(layered: pl.PhotonMap, relaxed: pl.PhotonMap, name: str) -> None:
    assert getattr(layered.constrain(), name).tobytes() == getattr(relaxed, name).tobytes()


def test_constraint_basis_is_orthonormal_and_tangent(relaxed: pl.PhotonMap) -> None:
    axes = np.concatenate([relaxed.constraint_basis, relaxed.normals[:, None]], axis=1).astype(float)
    np.testing.assert_allclose(axes @ axes.transpose(0, 2, 1), np.tile(np.eye(3), (COUNT, 1, 1)), atol=1e-5)


def test_constraint_weights_are_shares(relaxed: pl.PhotonMap) -> None:
    assert ((relaxed.constraint_weights >= 0.0) & (relaxed.constraint_weights <= 1.0)).all()


def test_constraint_holds_some_and_frees_others(relaxed: pl.PhotonMap) -> None:
    assert relaxed.constraint_weights[:, 1].min() == 0.0
    assert relaxed.constraint_weights[:, 1].max() == 1.0


@pytest.mark.parametrize(
    "name", ["constraint_basis", "constraint_weights", "gradient", "one_sidedness", "drift", "pressure"]
)
def test_map_that_was_not_relaxed_says_who_makes_its_state(photons: pl.PhotonMap, name: str) -> None:
    with pytest.raises(pl.PhotonLoupeError, match=r"relax\(\)"):
        getattr(photons, name)


# Step by step


def test_stepping_by_hand_equals_relax_to_the_bit(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    relaxation = pl.Relaxation(layered, steps=STEPS)
    for _ in range(STEPS):
        relaxation.step()
    stepped = relaxation.photons
    assert all(read_column(stepped, name) == read_column(relaxed, name) for name in relaxed.recorded)


def test_looking_between_steps_changes_nothing(layered: pl.PhotonMap, relaxed: pl.PhotonMap) -> None:
    relaxation = pl.Relaxation(layered, steps=STEPS)
    for _ in range(STEPS):
        relaxation.step()
        relaxation.photons.neighbors([0], 1)
    assert relaxation.photons.positions.tobytes() == relaxed.positions.tobytes()


def test_map_taken_between_steps_stays_as_it_was(layered: pl.PhotonMap) -> None:
    relaxation = pl.Relaxation(layered, steps=STEPS)
    relaxation.step()
    between = relaxation.photons
    before = between.positions.tobytes()
    relaxation.step()
    assert between.positions.tobytes() == before


def test_report_grows_with_the_steps(layered: pl.PhotonMap) -> None:
    relaxation = pl.Relaxation(layered, steps=STEPS)
    row = relaxation.step()
    assert (relaxation.report["steps"], relaxation.step_count, relaxation.steps) == ([row], 1, STEPS)


def test_relaxation_refuses_what_relax_refuses(photons: pl.PhotonMap) -> None:
    with pytest.raises(pl.ArgumentError, match="steps must be"):
        pl.Relaxation(photons, steps=-1)


def test_callback_hears_of_the_constraint_and_the_steps(photons: pl.PhotonMap) -> None:
    heard: list[str] = []
    photons.relax(1, progress=lambda stage, _: heard.append(stage))
    assert {"measure constraint", "relax photons"} <= set(heard)


def test_false_stops_relaxation(photons: pl.PhotonMap) -> None:
    with pytest.raises(pl.Cancelled):
        photons.relax(STEPS, progress=lambda stage, _: stage != "relax photons")


# Paths


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


# Saving, selecting


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
    rows = relaxed._columns[name][[9, 4]]
    assert read_column(relaxed.select([9, 4]), name) == (rows.dtype, rows.shape, rows.tobytes())


def test_selection_keeps_the_report(relaxed: pl.PhotonMap) -> None:
    assert relaxed.select([9, 4]).relaxation == relaxed.relaxation
