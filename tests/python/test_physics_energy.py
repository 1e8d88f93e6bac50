# SPDX-License-Identifier: Apache-2.0
"""Energy: the flux stored is the oracle's within 0.2 % at four million photons, and every path is accounted for."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene
from oracles import plane_cell_flux
from physics import BOWL, FOUR_MILLION, RING, find_cylinder_flux, find_slab_flux

ENERGY_TOLERANCE = 2e-3
BALANCE_TOLERANCE = 1e-5
PATH_ENDS = ("absorbed", "escaped", "truncated", "ended_on_receiver")


@pytest.mark.parametrize("emission", ["sobol", "random"])
def test_plane_receives_its_solid_angle(plate_path: Path, emission: str) -> None:
    photons = pl.trace_photons(
        pl.load_scene(plate_path), emitted=FOUR_MILLION, store="all", max_bounces=1, emission=emission
    )
    direct = photons.power.sum(axis=0, dtype=np.float64)
    truth = plane_cell_flux([-2.0, 2.0], [-2.0, 2.0], (0.0, 1.0, 0.0), 10.0)[0, 0]
    np.testing.assert_allclose(direct, truth, rtol=ENERGY_TOLERANCE)


@pytest.mark.parametrize("emission", ["sobol", "random"])
def test_ring_sends_its_flux_to_the_floor(emission: str) -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("ring")), emitted=FOUR_MILLION, emission=emission)
    np.testing.assert_allclose(photons.total_flux, find_cylinder_flux(RING), rtol=ENERGY_TOLERANCE)


@pytest.mark.parametrize("emission", ["sobol", "random"])
def test_bowl_sends_its_flux_to_the_floor(emission: str) -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("bowl")), emitted=FOUR_MILLION, emission=emission)
    np.testing.assert_allclose(photons.total_flux, find_cylinder_flux(BOWL), rtol=ENERGY_TOLERANCE)


@pytest.mark.parametrize("emission", ["sobol", "random"])
def test_slab_passes_its_flux_to_the_floor(emission: str) -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("slab")), emitted=FOUR_MILLION, emission=emission)
    np.testing.assert_allclose(photons.total_flux, find_slab_flux(), rtol=ENERGY_TOLERANCE)


@pytest.mark.parametrize("store", ["caustic", "indirect", "all"])
@pytest.mark.parametrize("name", ["ring", "slab", "bowl"])
def test_every_path_ends_once(name: str, store: str) -> None:
    report = pl.trace_photons(pl.load_scene(find_scene(name)), emitted=1 << 17, store=store).report
    assert report["emitted"] == sum(report[end] for end in PATH_ENDS)


@pytest.mark.parametrize("store", ["caustic", "all"])
@pytest.mark.parametrize("name", ["ring", "slab", "bowl"])
def test_flux_is_balanced(name: str, store: str) -> None:
    flux = pl.trace_photons(pl.load_scene(find_scene(name)), emitted=1 << 17, store=store).report["flux"]
    spent = np.sum([flux[end] for end in ("deposited", "escaped", "truncated")], axis=0)
    np.testing.assert_allclose(spent, flux["emitted"], rtol=BALANCE_TOLERANCE)


def test_emission_is_limited_to_what_is_specular(ring: pl.Scene) -> None:
    # The whole sphere is 4π·10 W; the ring covers little of it, seen from the lamp.
    photons = pl.trace_photons(ring, 10_000)
    assert np.max(photons.report["flux"]["emitted"]) < 0.5 * 4.0 * np.pi * RING.intensity


def test_all_light_starts_with_the_whole_power(ring: pl.Scene) -> None:
    photons = pl.trace_photons(ring, 10_000, store="all")
    np.testing.assert_allclose(photons.report["flux"]["emitted"], 4.0 * np.pi * RING.intensity, rtol=1e-5)
