# SPDX-License-Identifier: Apache-2.0
"""The lightguide's density jumps between photons that left the lamp side by side; PPCA keeps the band between."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import photonloupe as pl
from bar_maps import MIDDLE, build_bar_oracle, compare_cells, measure_kept, select_straight, trace_bar
from conftest import find_scene
from generate import LIGHTGUIDE
from stripes import LOST, SURVIVES, find_contrast, load_stripe

COUNT = 100_000
REACH = math.atan(LIGHTGUIDE.half_width / (LIGHTGUIDE.light_height - LIGHTGUIDE.crown_height))
ANGLES = (-0.5 * math.pi - 1.1 * REACH, -0.5 * math.pi + 1.1 * REACH)
# Corners in the order of LightguideScene.list_corners; sides as in GlassBar.
CORNERS = 7
BEVEL, CROWN, BASE, SHOULDER = 2, 3, 6 + CORNERS, 1 + CORNERS
EMISSIONS = ("random", "sobol")


def find_band() -> tuple[float, float]:
    """Where the light of the right bevel begins and ends, m."""
    found = build_bar_oracle("lightguide").follow(np.linspace(*ANGLES, 20_001))
    x = found.x[found.met(BEVEL, BASE)]
    return float(x.min()), float(x.max())


def test_lightguide_loads_with_nothing_left_out_but_the_floors_lobe() -> None:
    scene = pl.load_scene(find_scene("lightguide"))
    assert [line for line in scene.report["ignored"] if "lobe" not in line] == []


def test_lightguide_has_enough_triangles() -> None:
    document = json.loads(find_scene("lightguide").read_text())
    bar = document["meshes"][0]["primitives"][0]["indices"]
    assert document["accessors"][bar]["count"] / 3 >= 20_000


def test_every_path_ends_somewhere() -> None:
    report = trace_bar("lightguide", COUNT, "random").report
    ends = ("absorbed", "escaped", "truncated", "ended_on_receiver")
    assert report["emitted"] == sum(report[end] for end in ends)


def test_flux_that_leaves_the_lamp_arrives_or_escapes() -> None:
    flux = trace_bar("lightguide", COUNT, "random").report["flux"]
    ends = np.sum([flux[end] for end in ("deposited", "escaped", "truncated")], axis=0)
    np.testing.assert_allclose(ends, flux["emitted"], rtol=1e-5)


def test_light_on_the_floor_agrees_with_the_closed_form() -> None:
    assert 0.001 <= compare_cells("lightguide", 4 * COUNT, -0.135, 0.135, ANGLES) <= 0.999


def test_density_doubles_where_the_crown_meets_the_bevel() -> None:
    start, _ = find_band()
    oracle = build_bar_oracle("lightguide")
    crown, bevel = oracle.find_cell_irradiance([start - 5e-4, start, start + 5e-4], ANGLES)
    assert bevel / crown == pytest.approx(2.03, abs=0.03)


def test_photons_land_in_the_order_in_which_they_left_the_lamp() -> None:
    # No sheet of light lies over another: what is adjacent in primal trajectory is adjacent on the floor.
    photons, vertices, normals = select_straight("lightguide", COUNT)
    slope = np.degrees(np.arccos(np.abs(normals[:, 1, 1])))
    middle = (np.abs(photons.positions[:, 2]) < MIDDLE) & (slope < LIGHTGUIDE.shoulder_angle + 1e-3)
    first = vertices[middle, 1] - vertices[middle, 0]
    left = first[:, 0] / -first[:, 1]
    order = np.argsort(left)
    landed = photons.positions[middle, 0].astype(np.float64)[order]
    # Rays out of the middle plane land a little nearer to the axis.
    assert np.diff(landed).min() > -1e-4


def test_normal_turns_where_the_density_is_high_and_not_on_the_shoulder() -> None:
    start, end = find_band()
    photons, _, normals = select_straight("lightguide", COUNT)
    x = photons.positions[:, 0].astype(np.float64)
    slope = np.degrees(np.arcsin(normals[:, 1, 0]))
    near = np.abs(photons.positions[:, 2]) < MIDDLE
    near &= np.abs(slope) < LIGHTGUIDE.shoulder_angle + 1e-3  # not those that came in by an edge or a side
    rates = [
        np.polyfit(x[near & (x > low) & (x < high)], slope[near & (x > low) & (x < high)], 1)[0]
        for low, high in ((0.0, start), (start, end), (end, 0.13))
    ]
    # The bevel's curvature over the crown's, and its light drawn together to about a half.
    assert rates[1] / rates[0] > LIGHTGUIDE.crown_radius / LIGHTGUIDE.bevel_radius
    assert abs(rates[2]) < 1e-2


def test_committed_contrast_is_that_of_the_closed_form() -> None:
    stripe = load_stripe("lightguide")
    oracle = build_bar_oracle("lightguide")
    peak, first, second = (
        oracle.find_cell_irradiance(interval, ANGLES)[0] for interval in (stripe.peak, *stripe.troughs)
    )
    assert find_contrast(peak, 0.5 * (first + second)) == pytest.approx(stripe.reference_contrast, abs=0.01)


@pytest.mark.parametrize("emission", EMISSIONS)
def test_band_is_there_before_relaxation(emission: str) -> None:
    assert measure_kept("lightguide", emission, "raw") == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("emission", EMISSIONS)
def test_band_is_lost_with_primal_trajectories(emission: str) -> None:
    assert measure_kept("lightguide", emission, "primal_trajectory") <= LOST


@pytest.mark.parametrize("emission", EMISSIONS)
def test_band_survives_with_path_components(emission: str) -> None:
    assert measure_kept("lightguide", emission, "ppca") >= SURVIVES
