# SPDX-License-Identifier: Apache-2.0
"""Numerical extremes: each case is run, checked against double precision or a closed form, and put into a table."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from conftest import find_scene
from extremes_scenes import (
    FLOOR_HALF,
    add_zero_areas,
    build_plain_floor,
    build_sliver_floor,
    find_trapped_share,
    load_glass_block,
    load_lit_floor,
    move_scene,
)
from extremes_table import add_row, show
from gltf import build_quad
from oracles import plane_cell_flux, plane_disc_flux

UP = np.array([0.0, 1.0, 0.0])
EMITTED = 1 << 18
# 32-bit rounding along a path of a few segments, seen from a kernel estimate of 50 photons.
ROUNDING = 1e-4
# A ray leaves a surface beyond its position's error bound, 14 · 6e-8 of the coordinates, twice in a block at 2 m.
OFFSET_ERROR = 5e-6
POINTS = np.array([[0.1, 0.0, 0.2], [-0.4, 0.0, 0.3], [0.0, 0.0, -0.6]])


def find_error(found: NDArray[np.floating], truth: NDArray[np.floating]) -> float:
    """Largest difference, as a share of the largest true value."""
    assert np.isfinite(found).all()
    return float(np.abs(np.asarray(found, float) - truth).max() / np.abs(truth).max())


def check_finite(photons: pl.PhotonMap) -> None:
    for column in (photons.positions, photons.normals, photons.power):
        assert np.isfinite(column).all()


@pytest.fixture(scope="module")
def slab() -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene("slab")), emitted=EMITTED)


def test_scaled_scene_gives_scaled_irradiance(slab: pl.PhotonMap, tmp_path: Path) -> None:
    truth = slab.irradiance(POINTS, UP, k=50).astype(float)
    error = 0.0
    for scale in (1e-6, 1e-3, 1e3, 1e6):
        photons = pl.trace_photons(move_scene("slab", tmp_path, scale=scale), emitted=EMITTED)
        check_finite(photons)
        error = max(error, find_error(photons.total_flux, slab.total_flux))
        error = max(error, find_error(photons.irradiance(POINTS * scale, UP, k=50) * scale**2, truth))
    add_row("scale", f"error {show(error)}")
    assert error < ROUNDING


def test_scene_scaled_by_a_power_of_two_gives_the_same_bits(slab: pl.PhotonMap, tmp_path: Path) -> None:
    truth = slab.irradiance(POINTS, UP, k=50)
    for scale in (2.0**-20, 2.0**20):
        photons = pl.trace_photons(move_scene("slab", tmp_path, scale=scale), emitted=EMITTED)
        np.testing.assert_array_equal(photons.positions, slab.positions * np.float32(scale))
        np.testing.assert_array_equal(photons.power, slab.power)
        np.testing.assert_array_equal(photons.normals, slab.normals)
        estimate = photons.irradiance(POINTS * scale, UP, k=50)
        np.testing.assert_array_equal(estimate, truth * np.float32(scale**-2))
    add_row("scale-bits", "no bit differs")


def test_scene_far_away_gives_the_same_irradiance(slab: pl.PhotonMap, tmp_path: Path) -> None:
    offset = np.array([1e6, -1e6, 1e6])
    photons = pl.trace_photons(move_scene("slab", tmp_path, offset=offset), emitted=EMITTED)
    check_finite(photons)
    estimate = photons.irradiance(POINTS + offset, UP, k=50)
    error = find_error(estimate, slab.irradiance(POINTS, UP, k=50).astype(float))
    moved = np.abs(photons.positions - offset - slab.positions).max() if len(photons) == len(slab) else np.inf
    add_row("offset", f"error {show(error)}; positions within {show(float(moved))} m")
    assert error < ROUNDING
    assert moved <= 0.0625  # the spacing of floats at 10⁶ m


def test_grazing_light_lights_its_ring(tmp_path: Path) -> None:
    height = np.tan(np.radians(0.01))
    scene = load_lit_floor(tmp_path, light=(0.0, height, 0.0))
    photons = pl.trace_photons(scene, emitted=1 << 22, store="all", max_bounces=1)
    radius = np.hypot(photons.positions[:, 0].astype(float), photons.positions[:, 2].astype(float))
    direct = photons.power[(radius > 0.5) & (radius < 1.0), 0].sum(dtype=float)
    truth = plane_disc_flux(1.0, height, 1.0) - plane_disc_flux(0.5, height, 1.0)
    error = abs(direct / truth - 1.0)
    add_row("grazing", f"error {show(error)} of {show(truth / (4 * np.pi))} of the light's flux")
    check_finite(photons)
    assert error < 0.1  # some 370 photons


def test_light_on_a_surface_lights_what_it_faces(tmp_path: Path) -> None:
    scene = load_lit_floor(tmp_path, build_quad(FLOOR_HALF), build_quad(FLOOR_HALF, 1.0), light=(0.0, 0.0, 0.0))
    photons = pl.trace_photons(scene, emitted=EMITTED, store="all", max_bounces=1, columns=["path_vertices"])
    check_finite(photons)
    direct = photons.select(np.diff(photons.path_offsets) == 2)
    truth = plane_cell_flux([-FLOOR_HALF, FLOOR_HALF], [-FLOOR_HALF, FLOOR_HALF], (0.0, 1.0, 0.0), 1.0)[0, 0]
    error = abs(direct.total_flux[0] / truth - 1.0)
    add_row("on-surface", f"error {show(error)} on the surface it faces")
    assert error < 1e-3
    assert (direct.object == 1).all()


@pytest.mark.parametrize(("case", "ior"), [("inside-glass", 1.5), ("ior-4", 4.0)])
def test_light_in_glass_is_held_back_by_total_reflection(tmp_path: Path, case: str, ior: float) -> None:
    scene = load_glass_block(tmp_path, ior, light=(0.1, 0.93, -0.07))
    photons = pl.trace_photons(scene, emitted=EMITTED, max_bounces=64)
    check_finite(photons)
    share = photons.report["truncated"] / EMITTED
    error = share / find_trapped_share(ior) - 1.0
    add_row(case, f"{share:.3f}, error {show(abs(error))}")
    # At 64 bounces a few that meet their face at almost the critical angle are still inside.
    assert -2e-3 < error < 0.02


def test_almost_no_glass_holds_nothing_back(tmp_path: Path) -> None:
    scene = load_glass_block(tmp_path, 1.0001, light=(0.1, 0.93, -0.07))
    photons = pl.trace_photons(scene, emitted=EMITTED, max_bounces=64)
    check_finite(photons)
    share = 1.0 - photons.report["truncated"] / EMITTED
    add_row("ior-1.0001", f"{share:.4f}")
    assert share == 1.0


def test_ior_one_bends_nothing(tmp_path: Path) -> None:
    light = np.array([0.1, 2.0, -0.07])
    scene = load_glass_block(tmp_path, 1.0, light=tuple(light))
    photons = pl.trace_photons(scene, emitted=EMITTED, columns=["path_vertices"])
    first, last = photons.path_offsets[:-1], photons.path_offsets[1:] - 1
    assert (last - first == 3).all()  # in, out, floor
    entry = photons.path_vertices[first + 1].astype(float) - light
    toward = entry / np.linalg.norm(entry, axis=1, keepdims=True)
    arrived = photons.path_vertices[last].astype(float) - light
    error = float(np.linalg.norm(np.cross(arrived, toward), axis=1).max())
    add_row("ior-1", f"{show(error)} m")
    assert error < OFFSET_ERROR
    assert photons.report["truncated"] == 0


def test_64_bounces_are_accounted_for(tmp_path: Path) -> None:
    scene = load_glass_block(tmp_path, 4.0, light=(0.1, 0.93, -0.07))
    report = pl.trace_photons(scene, emitted=EMITTED, max_bounces=64, store="all").report
    ends = sum(report[end] for end in ("absorbed", "escaped", "truncated", "ended_on_receiver"))
    assert ends == EMITTED
    flux = report["flux"]
    spent = np.sum([flux[fate] for fate in ("deposited", "escaped", "truncated")], axis=0)
    error = find_error(spent, np.array(flux["emitted"]))
    add_row("bounces", f"error {show(error)}")
    assert error < 1e-5


def test_direct_paths_have_two_vertices(tmp_path: Path) -> None:
    light = np.array([0.0, 1.0, 0.0])
    photons = pl.trace_photons(
        load_lit_floor(tmp_path), emitted=4096, store="all", max_bounces=1, columns=["path_vertices"]
    )
    direct = np.diff(photons.path_offsets) == 2
    first = photons.path_offsets[:-1][direct]
    away = np.abs(photons.path_vertices[first] - light).max()
    away = max(away, np.abs(photons.path_vertices[first + 1] - photons.positions[direct]).max())
    add_row("two-vertices", f"{show(float(away))} m")
    assert direct.any()
    assert away == 0.0


def trace_floor(folder: Path, *meshes: object) -> pl.PhotonMap:
    folder.mkdir(exist_ok=True)
    scene = load_lit_floor(folder, *meshes, light=(0.3, 1.0, 0.1))  # type: ignore[arg-type]
    return pl.trace_photons(scene, emitted=EMITTED, store="all", max_bounces=1)


def test_triangles_of_zero_area_change_nothing(tmp_path: Path) -> None:
    plain = trace_floor(tmp_path / "plain", build_quad(FLOOR_HALF))
    nasty = trace_floor(tmp_path / "nasty", add_zero_areas(build_quad(FLOOR_HALF)))
    np.testing.assert_array_equal(nasty.positions, plain.positions)
    np.testing.assert_array_equal(nasty.power, plain.power)
    add_row("zero-area", "no bit differs")


def test_slivers_let_nothing_through(tmp_path: Path) -> None:
    plain = trace_floor(tmp_path / "plain", build_plain_floor())
    nasty = trace_floor(tmp_path / "nasty", build_sliver_floor())
    check_finite(nasty)
    error = find_error(nasty.total_flux, plain.total_flux)
    add_row("slivers", f"error {show(error)}")
    assert len(nasty) == len(plain)
    assert error < 1e-6


def test_duplicated_floor_stores_each_photon_once(tmp_path: Path) -> None:
    once = trace_floor(tmp_path / "once", build_quad(FLOOR_HALF))
    twice = trace_floor(tmp_path / "twice", build_quad(FLOOR_HALF), build_quad(FLOOR_HALF))
    np.testing.assert_array_equal(twice.emitted_index, once.emitted_index)
    error = float(np.abs(twice.positions - once.positions).max())
    add_row("duplicates", f"moved by {show(error)} m")
    assert error < 1e-6


def test_light_of_extreme_intensity_scales(tmp_path: Path) -> None:
    usual = pl.trace_photons(load_lit_floor(tmp_path), emitted=4096, store="all")
    error = 0.0
    for intensity in (1e-30, 1e30):
        extreme = pl.trace_photons(load_lit_floor(tmp_path, intensity=intensity), emitted=4096, store="all")
        check_finite(extreme)
        error = max(error, find_error(extreme.total_flux / intensity, usual.total_flux))
    add_row("intensity", f"error {show(error)}")
    assert error < 1e-6


def test_light_beyond_the_largest_intensity_is_refused(tmp_path: Path) -> None:
    with pytest.raises(pl.SceneError, match=r"lights/0/intensity: 3e\+38 is outside"):
        load_lit_floor(tmp_path, intensity=3e38)
    add_row("intensity-limit", "message checked")
