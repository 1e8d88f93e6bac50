# SPDX-License-Identifier: Apache-2.0
"""The oracles against an independent brute-force tracer of the exact geometry."""

from __future__ import annotations

import numpy as np
import pytest

from brute_force import Landings, trace_cylinder, trace_slab
from generate import BOWL, RING, SLAB, CylinderScene
from oracles import (
    MirrorCylinder,
    Slab,
    cardioid,
    fresnel_reflectance,
    plane_cell_flux,
    plane_disc_flux,
    plane_irradiance,
)
from statistics_checks import Z_LIMIT, compute_chi_square_p, compute_z

RAYS = 1_000_000
EDGES = np.linspace(-2.0, 2.0, 65)
GOLD = (1.0, 0.78, 0.34)


def build_oracle(scene: CylinderScene, *, color: tuple[float, float, float] | None = None) -> MirrorCylinder:
    return MirrorCylinder(
        scene.radius, scene.wall_height, scene.light, scene.intensity, color=color or scene.mirror_color
    )


def build_slab() -> Slab:
    return Slab(SLAB.thickness, SLAB.ior, SLAB.light_height, SLAB.intensity)


def trace(scene: CylinderScene, *, seed: int) -> Landings:
    return trace_cylinder(scene.radius, scene.wall_height, scene.light, scene.mirror_color, count=RAYS, seed=seed)


@pytest.fixture(scope="module")
def ring_landings() -> Landings:
    return trace(RING, seed=11)


@pytest.fixture(scope="module")
def bowl_landings() -> Landings:
    return trace(BOWL, seed=12)


def bin_points(points: np.ndarray, edges: np.ndarray) -> np.ndarray:
    return np.histogram2d(points[:, 0], points[:, 1], bins=(edges, edges))[0]


def test_plane_cells_sum_to_the_disc() -> None:
    edges = np.linspace(-1.0, 1.0, 401)
    cells = plane_cell_flux(edges, edges, (0.0, 0.7, 0.0), 3.0)
    middle = 0.5 * (edges[1:] + edges[:-1])
    inside = np.hypot(middle[:, None], middle[None, :]) < 1.0
    # The staircase edge of the disc is the error.
    assert cells[inside].sum() == pytest.approx(plane_disc_flux(1.0, 0.7, 3.0), rel=1e-3)


def test_plane_cell_over_its_area_is_the_irradiance() -> None:
    edges = np.array([0.3, 0.3001])
    cell = plane_cell_flux(edges, edges, (0.0, 0.7, 0.0), 3.0)[0, 0]
    assert cell / 1e-8 == pytest.approx(float(plane_irradiance(np.hypot(0.30005, 0.30005), 0.7, 3.0)), rel=1e-6)


def test_slab_on_axis_has_its_closed_form() -> None:
    slab = build_slab()
    through = (1.0 - ((SLAB.ior - 1.0) / (SLAB.ior + 1.0)) ** 2) ** 2
    depth = SLAB.light_height - SLAB.thickness + SLAB.thickness / SLAB.ior
    assert float(slab.irradiance(0.0)) == pytest.approx(SLAB.intensity * through / depth**2, rel=1e-8)


def test_slab_of_air_is_a_plane() -> None:
    slab = Slab(0.2, 1.0, 1.5, 10.0)
    rho = np.linspace(0.0, 3.0, 7)
    np.testing.assert_allclose(slab.irradiance(rho), plane_irradiance(rho, 1.5, 10.0), rtol=1e-7)


def test_slab_cells_sum_to_the_square() -> None:
    slab = build_slab()
    edges = np.linspace(-1.5, 1.5, 31)
    assert slab.cell_flux(edges, edges).sum() == pytest.approx(slab.square_flux(1.5), rel=1e-6)


def test_slab_orders_pass_all_that_is_not_reflected() -> None:
    # Summed over all ways through, a plate passes (1 - R)/(1 + R).
    theta = np.array([0.3, 0.9, 1.3])
    reflectance = fresnel_reflectance(np.cos(theta), SLAB.ior)
    orders = sum(
        Slab(SLAB.thickness, SLAB.ior, SLAB.light_height, SLAB.intensity, pairs).transmittance(theta)
        for pairs in range(40)
    )
    np.testing.assert_allclose(orders, (1.0 - reflectance) / (1.0 + reflectance), rtol=1e-9)


def test_slab_flux_agrees_with_brute_force() -> None:
    landings = trace_slab(SLAB.slab_bottom, SLAB.slab_top, SLAB.ior, SLAB.light_height, count=RAYS, seed=13)
    inside = (np.abs(landings.points) < SLAB.floor_half).all(axis=1)
    truth = build_slab().square_flux(SLAB.floor_half)
    z = compute_z(landings.share[inside, 0], RAYS, truth, 4.0 * np.pi * SLAB.intensity)
    assert abs(z) < Z_LIMIT


def test_slab_bins_agree_with_brute_force() -> None:
    landings = trace_slab(SLAB.slab_bottom, SLAB.slab_top, SLAB.ior, SLAB.light_height, count=RAYS, seed=14)
    # Light passes with its share as the probability, so that the counts are Poisson.
    passed = np.random.default_rng(15).random(len(landings.share)) < landings.share[:, 0]
    edges = np.linspace(-1.5, 1.5, 33)
    expected = build_slab().cell_flux(edges, edges) / (4.0 * np.pi * SLAB.intensity) * RAYS
    assert 0.001 <= compute_chi_square_p(bin_points(landings.points[passed], edges), expected) <= 0.999


@pytest.mark.parametrize("bounces", [1, 2, 3])
@pytest.mark.parametrize("channel", [0, 1, 2])
def test_ring_flux_agrees_with_brute_force(ring_landings: Landings, bounces: int, channel: int) -> None:
    share = ring_landings.share[ring_landings.bounces == bounces, channel]
    truth = build_oracle(RING).total_flux(bounces)[channel]
    assert abs(compute_z(share, RAYS, truth, 4.0 * np.pi * RING.intensity)) < Z_LIMIT


@pytest.mark.parametrize("bounces", [1, 2])
def test_ring_bins_agree_with_brute_force(ring_landings: Landings, bounces: int) -> None:
    # Red gold reflects all: each ray counts as one.
    points = ring_landings.points[ring_landings.bounces == bounces]
    expected = build_oracle(RING).cell_flux(EDGES, EDGES, bounces=bounces)[0] / (4.0 * np.pi * RING.intensity) * RAYS
    assert 0.001 <= compute_chi_square_p(bin_points(points, EDGES), expected) <= 0.999


def test_bowl_flux_agrees_with_brute_force(bowl_landings: Landings) -> None:
    share = bowl_landings.share[bowl_landings.bounces == 1, 0]
    truth = build_oracle(BOWL).total_flux()[0]
    assert abs(compute_z(share, RAYS, truth, 4.0 * np.pi * BOWL.intensity)) < Z_LIMIT


def test_bowl_bins_agree_with_brute_force(bowl_landings: Landings) -> None:
    points = bowl_landings.points[bowl_landings.bounces == 1]
    edges = np.linspace(-1.0, 1.0, 65)
    expected = build_oracle(BOWL).cell_flux(edges, edges)[0] / (4.0 * np.pi * BOWL.intensity) * RAYS
    assert 0.001 <= compute_chi_square_p(bin_points(points, edges), expected) <= 0.999


def test_bowl_light_never_meets_the_wall_twice(bowl_landings: Landings) -> None:
    assert bowl_landings.bounces.max() == 1


@pytest.mark.parametrize("scene", [RING, BOWL], ids=["ring", "bowl"])
def test_cylinder_flux_is_converged(scene: CylinderScene) -> None:
    oracle = build_oracle(scene)
    np.testing.assert_allclose(oracle.total_flux(count=20_000), oracle.total_flux(count=101_000), rtol=2e-5)


def test_ring_cells_sum_to_the_total() -> None:
    oracle = build_oracle(RING)
    edges = np.linspace(-RING.floor_half, RING.floor_half, 65)
    np.testing.assert_allclose(oracle.cell_flux(edges, edges).sum(axis=(1, 2)), oracle.total_flux(), rtol=1e-4)


def test_ring_irradiance_times_area_is_a_small_cell() -> None:
    oracle = build_oracle(RING, color=GOLD)
    side = 0.01
    centers = np.array([[0.05, -0.2], [0.3, -0.2], [-0.1, 0.3], [0.0, 1.3], [0.2, -0.85]])
    irradiance = oracle.irradiance(centers, count=100_000)
    for (x, z), value in zip(centers, irradiance, strict=True):
        cell = oracle.cell_flux(x + np.array([-0.5, 0.5]) * side, z + np.array([-0.5, 0.5]) * side, count=200_000)
        np.testing.assert_allclose(cell[:, 0, 0] / side**2, value, rtol=1e-3)


def test_ring_irradiance_is_not_zero_in_the_band() -> None:
    assert build_oracle(RING).irradiance([[0.05, -0.2]])[0, 0] > 0.1


def test_source_on_the_circle_makes_the_cardioid() -> None:
    oracle = MirrorCylinder(1.0, 0.4, (-1.0 + 1e-9, 1.2, 0.0), 1.0)
    curve = oracle.caustic_curve(count=2_000)
    exact = cardioid(np.linspace(0.0, 2.0 * np.pi, 200_001), 1.0)
    nearest = [np.min(np.hypot(*(exact - point).T)) for point in curve[::50]]
    assert max(nearest) < 1e-4


def test_height_of_the_light_does_not_move_the_caustic() -> None:
    low = MirrorCylinder(1.0, 0.5, (0.0, 1.6, 2.0), 1.0).caustic_curve()
    high = MirrorCylinder(1.0, 0.6, (0.0, 1.92, 2.0), 1.0).caustic_curve()
    np.testing.assert_allclose(low, high, atol=1e-12)
