# SPDX-License-Identifier: Apache-2.0
"""The prism bends light as its closed forms say; its stripe is lost with primal trajectories and survives with PPCA."""

from __future__ import annotations

import json
import math

import numpy as np
import pytest

import photonloupe as pl
from bar_maps import build_bar_oracle, compare_cells, measure_kept, select_straight, trace_bar
from conftest import SCENES, find_scene
from generate import PRISM
from stripes import LOST, SURVIVES, find_contrast, load_stripe

COUNT = 100_000
BETA_AGREEMENT = 5e-3  # the script reads t_beta from 4,096 bins
CDF_AGREEMENT = 2e-3
# From the lamp to below the base and above the apex.
ANGLES = (-0.7, -0.05)
# Corners in the order of PrismScene.list_corners: sides have the number of the corner before plus that of the corners.
CORNERS = 7
NEAR_FACE, FOOT, BEVEL, MAIN_FACE = 5 + CORNERS, 0 + CORNERS, 2, 3 + CORNERS
EMISSIONS = ("random", "sobol")


def test_prism_loads_with_nothing_left_out_but_the_floors_lobe() -> None:
    scene = pl.load_scene(find_scene("prism"))
    assert [line for line in scene.report["ignored"] if "lobe" not in line] == []


def test_prism_has_enough_triangles() -> None:
    document = json.loads(find_scene("prism").read_text())
    bar = document["meshes"][0]["primitives"][0]["indices"]
    assert document["accessors"][bar]["count"] / 3 >= 20_000


def test_every_path_ends_somewhere() -> None:
    report = trace_bar("prism", COUNT, "random").report
    ends = ("absorbed", "escaped", "truncated", "ended_on_receiver")
    assert report["emitted"] == sum(report[end] for end in ends)


def test_flux_that_leaves_the_lamp_arrives_or_escapes() -> None:
    flux = trace_bar("prism", COUNT, "random").report["flux"]
    ends = np.sum([flux[end] for end in ("deposited", "escaped", "truncated")], axis=0)
    np.testing.assert_allclose(ends, flux["emitted"], rtol=1e-5)


def test_flat_faces_deviate_light_as_a_prism_does() -> None:
    # Across the edge a skew ray goes as in glass of index √(n² − sin²η)/cos η, η its angle to the cross-section.
    _, vertices, normals = select_straight("prism", COUNT)
    lean = np.degrees(np.arcsin(np.abs(normals[:, 1:3, 1])))
    flat = np.abs(lean - PRISM.face_angle).max(axis=1) < 1e-3
    assert flat.sum() > 10_000
    segments = np.diff(vertices[flat], axis=1)
    segments /= np.linalg.norm(segments, axis=2, keepdims=True)
    apex = math.radians(2.0 * PRISM.face_angle)
    eta = np.arcsin(segments[:, 0, 2])
    index = np.sqrt(PRISM.ior**2 - np.sin(eta) ** 2) / np.cos(eta)
    elevation = np.arctan2(-segments[:, :, 1], segments[:, :, 0])  # downward
    incident = math.radians(PRISM.face_angle) - elevation[:, 0]
    leaving = np.arcsin(index * np.sin(apex - np.arcsin(np.sin(incident) / index)))
    deviation = incident + leaving - apex
    # The last segment is at least 0.1 m long, its ends are floats of up to 1 m.
    np.testing.assert_allclose(elevation[:, 2] - elevation[:, 0], deviation, atol=1e-5)


def test_light_on_the_floor_agrees_with_the_closed_form() -> None:
    assert 0.001 <= compare_cells("prism", 4 * COUNT, 0.16, 0.96, ANGLES) <= 0.999


def test_bevels_light_lies_where_foot_and_main_face_both_shine() -> None:
    found = build_bar_oracle("prism").follow(np.linspace(*ANGLES, 20_001))
    stripe, foot, main = (found.x[found.met(NEAR_FACE, face)] for face in (BEVEL, FOOT, MAIN_FACE))
    assert main.min() < stripe.min()
    assert stripe.max() < foot.max()


def test_stripe_is_met_by_the_committed_line() -> None:
    found = build_bar_oracle("prism").follow(np.linspace(*ANGLES, 20_001))
    x = found.x[found.met(NEAR_FACE, BEVEL)]
    stripe = load_stripe("prism")
    assert x.min() < stripe.peak[0] < stripe.peak[1] < x.max()
    assert stripe.troughs[0][1] < x.min() < x.max() < stripe.troughs[1][0]


def test_committed_contrast_is_that_of_the_closed_form() -> None:
    # Other ways than 22, and |z| up to the line's half width, change it by a hundredth.
    stripe = load_stripe("prism")
    oracle = build_bar_oracle("prism")
    peak, first, second = (
        oracle.find_cell_irradiance(interval, ANGLES)[0] for interval in (stripe.peak, *stripe.troughs)
    )
    assert find_contrast(peak, 0.5 * (first + second)) == pytest.approx(stripe.reference_contrast, abs=0.01)


@pytest.mark.parametrize("emission", EMISSIONS)
def test_stripe_is_there_before_relaxation(emission: str) -> None:
    assert measure_kept("prism", emission, "raw") == pytest.approx(1.0, abs=0.1)


@pytest.mark.parametrize("emission", EMISSIONS)
def test_stripe_is_lost_with_primal_trajectories(emission: str) -> None:
    assert measure_kept("prism", emission, "primal_trajectory") <= LOST


@pytest.mark.parametrize("emission", EMISSIONS)
def test_stripe_survives_with_path_components(emission: str) -> None:
    assert measure_kept("prism", emission, "ppca") >= SURVIVES


@pytest.mark.parametrize("parameters", ["primal_trajectory", "ppca"])
def test_isotropy_script_finds_the_beta_of_the_measure(parameters: str) -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("prism")), 20_000, seed=1, emission="random")
    photons.run_script(SCENES / "scripts" / f"{parameters}.photon")
    measured = pl.optimal_beta(photons)
    run = photons.run_script(SCENES / "scripts" / "isotropy.photon", keep=True)
    told = float(run.prints[-1].split()[-1])
    assert told == pytest.approx(float(measured), rel=BETA_AGREEMENT)
    # Both count the same photons in the same 64 bins, but for a few whose ratio rounds across a border.
    counts = run.histograms["isotropy"].counts
    assert len(counts) == len(measured.isotropy.histogram)
    cdf = np.cumsum(counts) / counts.sum()
    np.testing.assert_allclose(cdf, measured.isotropy.cdf, atol=CDF_AGREEMENT)
