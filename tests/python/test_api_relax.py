# SPDX-License-Identifier: Apache-2.0
"""Relaxation as an interface: the report, what a relaxed map keeps, the constraint alone, step by step."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from relax_maps import COUNT, KEPT, STEPS, build, read_column


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
    return pl.trace_photons(ring, 2_000, seed=4)


@pytest.fixture(scope="module")
def relaxed_ring(traced: pl.PhotonMap) -> pl.PhotonMap:
    return traced.relax(STEPS)


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
