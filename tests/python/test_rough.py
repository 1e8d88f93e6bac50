# SPDX-License-Identifier: Apache-2.0
"""Rough metal and glass: where light goes and how much, against the textbook's density integrated over bins."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from gltf import GltfWriter, Mesh, build_quad, make_diffuse, make_glass, make_mirror
from lit_scenes import build_ball, load
from microfacet_twin import Doubles, normalize, reflect_rough, scatter_glass, scatter_thin
from statistics_checks import compute_chi_square_p

P_LIMIT = 1e-4
PHOTONS = 1 << 19
SHELL = 1000.0  # metres: seen from there the plate is a point
PLATE = 0.5
IOR = 1.5
Density = Callable[[Doubles], Doubles]


def find_arriving(degrees: float, *, from_below: bool = False) -> Doubles:
    """Unit vector towards the light, out of every plane of symmetry."""
    angle, azimuth = np.radians(degrees), 0.7
    up = -np.cos(angle) if from_below else np.cos(angle)
    return np.array([np.sin(angle) * np.cos(azimuth), up, np.sin(angle) * np.sin(azimuth)])


def trace_to_shell(folder: Path, material: dict[str, Any], arriving: Doubles, seed: int = 0) -> pl.PhotonMap:
    """Light on a small plate in the middle of a black ball, stored where it lands."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("plate", build_quad(PLATE), material)
        ball = build_ball(SHELL, 0.0, 64)
        writer.add_mesh("shell", Mesh(ball.positions, -ball.normals, ball.indices[:, ::-1]), make_diffuse("black", 0.0))
        writer.add_spot_light("spot", tuple(100.0 * arriving), (0.0, 0.0, 0.0), 1.0, 1e-3, 1e-3)

    scene = pl.load_scene(write_without_floor(folder, change))
    return pl.trace_photons(scene, emitted=PHOTONS, store="caustic", emission="random", seed=seed)


def write_without_floor(folder: Path, change: Callable[[GltfWriter], Any]) -> Path:
    writer = GltfWriter("shell")
    change(writer)
    writer.write(folder)
    return folder / "shell.gltf"


def build_bins(axis: Doubles) -> tuple[Doubles, Doubles, Doubles, Doubles]:
    """Edges of polar angle about `axis`, of azimuth, and the basis's other axes."""
    polar = np.concatenate([[0.0], np.geomspace(2e-3, np.pi, 40)])
    u = normalize(np.cross(axis, [0.3, 0.1, 0.9]))
    return polar, np.linspace(-np.pi, np.pi, 13), u, np.cross(axis, u)


def count_directions(directions: Doubles, axis: Doubles) -> Doubles:
    polar, azimuth, u, v = build_bins(axis)
    angle = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
    turn = np.arctan2(directions @ v, directions @ u)
    return np.histogram2d(angle, turn, [polar, azimuth])[0]


def integrate_density(density: Density, axis: Doubles, steps: int = 24) -> Doubles:
    """Over the same bins, by the midpoint rule in equal solid angles."""
    polar, azimuth, u, v = build_bins(axis)
    fine = (np.arange(steps) + 0.5) / steps
    heights = np.cos(polar[:-1, None]) + (np.cos(polar[1:]) - np.cos(polar[:-1]))[:, None] * fine
    turns = azimuth[:-1, None] + np.diff(azimuth)[:, None] * fine
    cosine, turn = np.meshgrid(heights.ravel(), turns.ravel(), indexing="ij")
    sine = np.sqrt(1.0 - cosine**2)
    along, across = (sine * np.cos(turn))[..., None] * u, (sine * np.sin(turn))[..., None] * v
    values = density(cosine[..., None] * axis + along + across).reshape(len(polar) - 1, steps, 12, steps)
    solid = (np.cos(polar[:-1]) - np.cos(polar[1:])) * (2.0 * np.pi / 12.0)
    return values.mean(axis=(1, 3)) * solid[:, None]


def check_directions(photons: pl.PhotonMap, density: Density, axis: Doubles, *, above: bool) -> None:
    """Every photon carries the same flux, so that counts tell where it goes."""
    assert np.ptp(photons.power) <= 1e-6 * photons.power.max()
    directions = normalize(photons.positions.astype(np.float64))
    side = directions[:, 1] > 0.0 if above else directions[:, 1] < 0.0
    expected = PHOTONS * integrate_density(
        lambda w: np.where((w[..., 1] > 0.0) == above, density(w), 0.0), normalize(axis)
    )
    counts = count_directions(directions[side], normalize(axis))
    total = expected.sum()
    assert abs(counts.sum() - total) < 4.0 * np.sqrt(total) + 1e-3 * total
    assert compute_chi_square_p(counts.ravel(), expected.ravel()) > P_LIMIT


@pytest.mark.parametrize("degrees", [0.0, 50.0, 80.0])
@pytest.mark.parametrize("roughness", [0.15, 0.4, 1.0])
def test_rough_metal_scatters_as_its_density_says(tmp_path: Path, roughness: float, degrees: float) -> None:
    arriving = find_arriving(degrees)
    photons = trace_to_shell(tmp_path, make_mirror("metal", (1.0, 1.0, 1.0), roughness), arriving)
    mirrored = np.array([-arriving[0], arriving[1], -arriving[2]])
    check_directions(photons, lambda w: reflect_rough(arriving, w, roughness), mirrored, above=True)
    assert (photons.positions[:, 1] >= 0.0).all()


@pytest.mark.parametrize("from_below", [False, True])
@pytest.mark.parametrize("degrees", [0.0, 35.0, 75.0])
@pytest.mark.parametrize("roughness", [0.15, 0.6])
def test_rough_glass_scatters_as_its_density_says(
    tmp_path: Path, roughness: float, degrees: float, *, from_below: bool
) -> None:
    arriving = find_arriving(degrees, from_below=from_below)
    ratio = IOR if from_below else 1.0 / IOR
    photons = trace_to_shell(tmp_path, make_glass("glass", IOR, 1.0, roughness), arriving)
    turned = np.array([1.0, -1.0 if from_below else 1.0, 1.0])  # the twin's light comes from above

    def density(w: Doubles) -> Doubles:
        return scatter_glass(arriving * turned, w * turned, roughness, ratio)

    mirrored = np.array([-arriving[0], arriving[1], -arriving[2]])
    check_directions(photons, density, mirrored, above=not from_below)
    beyond = -arriving[1] / abs(arriving[1]) * np.sqrt(max(0.0, 1.0 - ratio**2 * (1.0 - arriving[1] ** 2)))
    refracted = np.array([-ratio * arriving[0], beyond, -ratio * arriving[2]])
    check_directions(photons, density, refracted, above=from_below)


@pytest.mark.parametrize("degrees", [0.0, 60.0])
def test_thin_rough_glass_scatters_as_its_density_says(tmp_path: Path, degrees: float) -> None:
    arriving, roughness = find_arriving(degrees), 0.4
    photons = trace_to_shell(tmp_path, make_glass("sheet", IOR, 0.0, roughness), arriving)
    mirrored = np.array([-arriving[0], arriving[1], -arriving[2]])
    for axis, above in ((mirrored, True), (-arriving, False)):
        check_directions(photons, lambda w: scatter_thin(arriving, w, roughness, IOR), axis, above=above)


def look_at_plate(folder: Path, material: dict[str, Any], light: Doubles, eye: Doubles) -> Doubles:
    """Radiance that the plate's middle sends to an eye, of a point light of 1 W/sr at `light`."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("plate", build_quad(PLATE), material)
        writer.add_mesh("elsewhere", build_quad(0.1, -500.0), make_diffuse("black", 0.0))
        writer.add_point_light("lamp", tuple(light), 1.0)

    scene = pl.load_scene(write_without_floor(folder, change))
    camera = pl.Camera(position=tuple(eye), target=(0.0, 0.0, 0.0), yfov=1e-3)
    image = pl.render(scene, mode="direct", camera=camera, width=4, height=4, samples=16, max_bounces=4)
    return np.asarray(image, dtype=np.float64).mean(axis=(0, 1))


@pytest.mark.parametrize("roughness", [0.1, 0.5])
def test_a_light_shines_back_off_rough_metal(tmp_path: Path, roughness: float) -> None:
    light, eye = 3.0 * find_arriving(40.0), 2.0 * normalize(np.array([-0.5, 0.7, -0.4]))
    color = np.array([0.9, 0.6, 0.3])
    seen = look_at_plate(tmp_path, make_mirror("metal", tuple(color), roughness), light, eye)
    to_light, to_eye = normalize(light), normalize(eye)
    m = normalize(to_light + to_eye)
    tint = color + (1.0 - color) * (1.0 - m @ to_eye) ** 5
    np.testing.assert_allclose(seen, tint * reflect_rough(to_eye, to_light, roughness) / 9.0, rtol=3e-3)


@pytest.mark.parametrize("is_behind", [False, True])
def test_a_light_shines_through_rough_glass(tmp_path: Path, *, is_behind: bool) -> None:
    roughness = 0.5
    light, eye = 3.0 * find_arriving(25.0, from_below=is_behind), 2.0 * normalize(np.array([-0.5, 0.7, -0.4]))
    seen = look_at_plate(tmp_path, make_glass("glass", IOR, 1.0, roughness), light, eye)
    truth = float(scatter_glass(normalize(eye), normalize(light), roughness, 1.0 / IOR)) / 9.0
    np.testing.assert_allclose(seen, truth, rtol=3e-3)


def test_roughness_zero_is_the_smooth_surface_bit_for_bit(tmp_path: Path) -> None:
    """A rough object far away compiles the rough lobes in, and changes nothing of smooth ones."""

    def trace(name: str, *, with_rough: bool) -> pl.PhotonMap:
        def change(writer: GltfWriter) -> None:
            writer.add_mesh("mirror", build_quad(0.3, 0.4), make_mirror("mirror", (0.9, 0.8, 0.7)))
            writer.add_mesh("glass", build_ball(0.2, 0.6, 16), make_glass("glass", IOR, 0.4))
            far = make_mirror("far", (1.0, 1.0, 1.0), 0.5 if with_rough else 0.0)
            writer.add_mesh("far", Mesh(build_quad(0.01, -3.0).positions, *far_faces()), far)
            writer.add_point_light("lamp", (0.1, 2.0, 0.2), 1.0)

        return pl.trace_photons(load(tmp_path / name, change), emitted=1 << 15, store="all", seed=3)

    smooth, rough = trace("smooth", with_rough=False), trace("rough", with_rough=True)
    np.testing.assert_array_equal(smooth.positions, rough.positions)
    np.testing.assert_array_equal(smooth.power, rough.power)


def far_faces() -> tuple[Doubles, Any]:
    quad = build_quad(0.01)
    return quad.normals, quad.indices
