# SPDX-License-Identifier: Apache-2.0
"""The ball's light lies where the ball lens's closed form says: oracle 7."""

from __future__ import annotations

import json
from functools import lru_cache

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene
from glass_ball import BALL
from oracles import BallLens
from statistics_checks import compute_chi_square_p

EMITTED = 1 << 20
P_LIMITS = (0.001, 0.999)
LENS = BallLens(BALL.radius, BALL.ior, BALL.distance, BALL.irradiance)


@lru_cache(maxsize=2)
def trace(emission: str) -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene("ball")), emitted=EMITTED, emission=emission)


def find_fold() -> float:
    """Where the light's bright rim lies, m."""
    return float(LENS.landing(np.linspace(0.0, 0.9 * BALL.radius, 200_001)).max())


def measure_radii(photons: pl.PhotonMap) -> np.ndarray:
    return np.hypot(photons.positions[:, 0], photons.positions[:, 2]).astype(np.float64)


def test_ball_loads_with_nothing_left_out_but_the_floors_lobe() -> None:
    scene = pl.load_scene(find_scene("ball"))
    assert [line for line in scene.report["ignored"] if "lobe" not in line] == []


def test_ball_has_enough_triangles() -> None:
    document = json.loads(find_scene("ball").read_text())
    ball = document["meshes"][0]["primitives"][0]["indices"]
    assert document["accessors"][ball]["count"] / 3 >= 20_000


def test_floor_lies_before_the_focus_and_within_the_fold() -> None:
    assert BALL.distance < LENS.focus
    assert find_fold() > 0.1 * BALL.radius


def test_flux_that_the_sun_sends_arrives_or_escapes() -> None:
    report = trace("random").report
    ends = ("absorbed", "escaped", "truncated", "ended_on_receiver")
    assert report["emitted"] == sum(report[end] for end in ends)
    flux = report["flux"]
    arrived = np.sum([flux[end] for end in ("deposited", "escaped", "truncated")], axis=0)
    np.testing.assert_allclose(arrived, flux["emitted"], rtol=1e-5)


def test_photons_lie_where_the_closed_form_says() -> None:
    photons = trace("random").select(signature="22")
    # The facets turn the outermost light by a little too much; and a bin that holds the fold is as good as any other.
    edges = np.append(np.linspace(0.0, 1.2 * find_fold(), 49), np.linspace(0.05, 0.24, 20))
    expected = LENS.find_flux(edges) / float(photons.power[0, 0])
    counts = np.histogram(measure_radii(photons), edges)[0].astype(np.float64)
    assert P_LIMITS[0] <= compute_chi_square_p(counts, expected) <= P_LIMITS[1]


@pytest.mark.parametrize("share", [0.25, 0.5, 0.75])
def test_irradiance_inside_the_fold_is_that_of_both_sheets(share: float) -> None:
    rho = share * find_fold()
    angles = np.linspace(0.0, 2.0 * np.pi, 64, endpoint=False)
    points = np.stack([rho * np.cos(angles), 0.0 * angles, rho * np.sin(angles)], axis=1)
    found = trace("sobol").select(signature="22").irradiance(points, [0, 1, 0], k=100)[:, 0]
    assert float(found.mean()) == pytest.approx(LENS.irradiance_at(rho), rel=0.03)


def test_density_jumps_at_the_fold() -> None:
    fold = find_fold()
    photons = trace("sobol").select(signature="22")
    inside, outside = np.histogram(measure_radii(photons), [0.97 * fold, fold, 1.03 * fold])[0]
    assert inside > 10 * outside


def test_irradiance_of_the_closed_form_is_the_slope_of_its_flux() -> None:
    for rho in (0.01, 0.02, 0.1):
        edges = np.array([rho - 1e-4, rho + 1e-4])
        mean = LENS.find_flux(edges)[0] / (np.pi * np.diff(np.square(edges))[0])
        assert LENS.irradiance_at(rho) == pytest.approx(mean, rel=2e-3)
