# SPDX-License-Identifier: Apache-2.0
"""Dispersion: indices of glasses at their spectral lines, what a prism does with them, and that all of it is white."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from gltf import GltfWriter, Mesh, add_dispersion, build_box, build_quad, make_diffuse, make_glass
from lit_scenes import build_ball, build_panel
from microfacet_twin import Doubles, normalize, reflect_fresnel
from shell_plates import SHELL, find_arriving, trace_to_shell, write_without_floor
from statistics_checks import compute_chi_square_p

APEX = np.radians(40.0)  # between the two faces
ARRIVAL = np.radians(35.0)  # from the first face's normal
COUNT = 1 << 17


@dataclass(frozen=True)
class Glass:
    """Catalog indices at the lines F, d and C (486.1, 587.6 and 656.3 nm), and how far Cauchy's formula is off them."""

    blue: float
    yellow: float
    red: float
    abbe: float
    tolerance: float


GLASSES = {
    "BK7": Glass(1.52238, 1.51680, 1.51432, 64.17, 1e-4),
    "SF10": Glass(1.74648, 1.72825, 1.72085, 28.41, 5e-4),
}
LINES = np.array([486.1, 587.6, 656.3])  # nm


def find_index(nanometers: Doubles, glass: Glass) -> Doubles:
    """Cauchy's n = A + B/λ² through n_d with the Abbe number (n_d − 1)/(n_F − n_C)."""
    blue, yellow, red = 1.0 / LINES**2
    slope = (glass.yellow - 1.0) / glass.abbe / (blue - red)
    return glass.yellow + slope * (1.0 / nanometers**2 - yellow)


def find_color(nanometers: Doubles) -> Doubles:
    """Of white light, the part at a wavelength: linear ramps over 400 to 700 nm, each of mean 1."""
    place = (nanometers - 400.0) / 300.0
    return np.stack([np.interp(place, x, y) for x, y in RAMPS], axis=-1)


RAMPS = (
    ([0.5, 5.0 / 6.0], [0.0, 3.0]),
    ([1.0 / 6.0, 0.5, 5.0 / 6.0], [0.0, 3.0, 0.0]),
    ([1.0 / 6.0, 0.5], [3.0, 0.0]),
)


def make_flint(glass: Glass) -> dict[str, Any]:
    return add_dispersion(make_glass("glass", glass.yellow, 1.0), glass.abbe)


def build_wedge() -> Mesh:
    """A bar along z with its first face in the plane x = 0, the second one leaning over the apex at the top."""
    low, high = np.array([np.tan(APEX), -1.0]), np.array([0.0, 0.0])
    profile = np.array([high, [0.0, -1.0], low])
    positions, normals, indices = [], [], []
    for a, b in ((0, 1), (1, 2), (2, 0)):
        (xa, ya), (xb, yb) = profile[a], profile[b]
        outward = normalize(np.array([yb - ya, xa - xb, 0.0]))
        first = 4 * len(normals)
        positions += [[xa, ya, -1.0], [xb, yb, -1.0], [xb, yb, 1.0], [xa, ya, 1.0]]
        normals.append(np.tile(outward, (4, 1)))
        indices += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    first = len(positions)
    for z in (-1.0, 1.0):
        positions += [[x, y, z] for x, y in profile]
        normals.append(np.tile([0.0, 0.0, z], (3, 1)))
    indices += [[first, first + 2, first + 1], [first + 3, first + 4, first + 5]]
    faces = np.array(indices)
    points, towards = np.array(positions), np.concatenate(normals)
    across = np.cross(points[faces[:, 1]] - points[faces[:, 0]], points[faces[:, 2]] - points[faces[:, 0]])
    flipped = np.einsum("ij,ij->i", across, towards[faces[:, 0]]) < 0.0
    faces[flipped] = faces[flipped][:, ::-1]
    return Mesh(points, towards, faces)


def trace_wedge(folder: Path, glass: Glass, emission: str = "random") -> pl.PhotonMap:
    """A thin beam through the wedge onto a black ball far around."""
    target = np.array([0.0, -0.5, 0.0])
    start = target + 2.0 * np.array([-np.cos(ARRIVAL), -np.sin(ARRIVAL), 0.0])

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("wedge", build_wedge(), make_flint(glass))
        ball = build_ball(SHELL, 0.0, 64)
        writer.add_mesh("shell", Mesh(ball.positions, -ball.normals, ball.indices[:, ::-1]), make_diffuse("black", 0.0))
        writer.add_spot_light("beam", tuple(start), tuple(target), 1.0, 1e-4, 1e-4)

    return pl.trace_photons(pl.load_scene(write_without_floor(folder, change)), emitted=COUNT, emission=emission)


def find_straight(photons: pl.PhotonMap) -> tuple[Doubles, Doubles]:
    """Vertices (n, 4, 3) and flux over emitted (n, 3) of the paths that only passed the two faces."""
    starts, lengths = photons.path_offsets[:-1], np.diff(photons.path_offsets)
    passed = lengths == 4
    passed &= (photons.path_interactions[starts + 1] == 2) & (photons.path_interactions[starts + 2] == 2)
    vertices = photons.path_vertices[starts[passed][:, None] + np.arange(4)].astype(np.float64)
    flux = photons.power[passed].astype(np.float64) / np.asarray(photons.report["flux"]["emitted"]) * COUNT
    return vertices, flux


def measure_index(vertices: Doubles) -> Doubles:
    """Snell's law at the first face, the plane x = 0."""
    outside, inside = (normalize(vertices[:, i + 1] - vertices[:, i]) for i in (0, 1))
    return np.hypot(outside[:, 1], outside[:, 2]) / np.hypot(inside[:, 1], inside[:, 2])


def find_deviation(index: Doubles) -> Doubles:
    """Of a prism: i₁ + i₂ − apex, sin i₂ = sin apex √(n² − sin² i₁) − cos apex sin i₁."""
    leaving = np.sin(APEX) * np.sqrt(index**2 - np.sin(ARRIVAL) ** 2) - np.cos(APEX) * np.sin(ARRIVAL)
    return ARRIVAL + np.arcsin(leaving) - APEX


@pytest.mark.parametrize("name", list(GLASSES))
def test_indices_at_the_lines_are_the_glasss(tmp_path: Path, name: str) -> None:
    """Wavelengths are uniform over 400 to 700 nm, so that a quantile of the measured indices tells that of its line."""
    glass = GLASSES[name]
    vertices, _ = find_straight(trace_wedge(tmp_path, glass))
    measured = np.quantile(measure_index(vertices), 1.0 - (LINES - 400.0) / 300.0)
    np.testing.assert_allclose(measured, [glass.blue, glass.yellow, glass.red], atol=glass.tolerance)
    np.testing.assert_allclose(measured, find_index(LINES, glass), atol=2e-4)


@pytest.mark.parametrize("name", list(GLASSES))
def test_a_prism_turns_each_line_by_its_index(tmp_path: Path, name: str) -> None:
    glass = GLASSES[name]
    vertices, _ = find_straight(trace_wedge(tmp_path, glass))
    arriving, leaving = normalize(vertices[:, 1] - vertices[:, 0]), normalize(vertices[:, 3] - vertices[:, 2])
    turned = np.arccos(np.clip(np.einsum("ij,ij->i", arriving, leaving), -1.0, 1.0))
    index = measure_index(vertices)
    np.testing.assert_allclose(turned, find_deviation(index), atol=3e-4)
    for line, truth in zip(LINES, (glass.blue, glass.yellow, glass.red), strict=True):
        near = np.abs(index - find_index(line, glass)) < 1e-4
        assert near.sum() > 50
        np.testing.assert_allclose(turned[near].mean(), find_deviation(np.array(truth)), atol=2.0 * glass.tolerance)


def test_photons_have_the_color_of_their_wavelength_and_wavelengths_are_uniform(tmp_path: Path) -> None:
    glass = GLASSES["SF10"]
    vertices, flux = find_straight(trace_wedge(tmp_path, glass))
    index = measure_index(vertices)
    yellow, slope = 1.0 / LINES[1] ** 2, find_index(np.array(1.0), glass) - find_index(np.array(1e9), glass)
    nanometers = 1.0 / np.sqrt((index - glass.yellow) / slope + yellow)
    np.testing.assert_allclose(flux, find_color(nanometers), atol=0.02)
    edges = np.linspace(400.0, 700.0, 31)
    middles = find_index(0.5 * (edges[1:] + edges[:-1]), glass)
    inner = np.arcsin(np.sin(ARRIVAL) / middles)
    passing = (1.0 - reflect_fresnel(np.cos(np.full_like(middles, ARRIVAL)), 1.0 / middles)) * (
        1.0 - reflect_fresnel(np.cos(APEX - inner), middles)
    )
    counts = np.histogram(nanometers, edges)[0].astype(np.float64)
    assert compute_chi_square_p(counts, COUNT * passing / 30.0) > 1e-4


def test_red_bends_least_and_blue_most(tmp_path: Path) -> None:
    vertices, flux = find_straight(trace_wedge(tmp_path, GLASSES["SF10"], emission="sobol"))
    downward = vertices[:, 3, 1] / SHELL  # the wedge widens downward, and light is turned there
    red, green, blue = (float((downward * flux[:, i]).sum() / flux[:, i].sum()) for i in range(3))
    assert red > green + 1e-3
    assert green > blue + 1e-3
    assert np.corrcoef(downward, flux[:, 0] - flux[:, 2])[0, 1] > 0.9


@pytest.mark.parametrize("emission", ["random", "sobol"])
def test_all_that_leaves_a_prism_is_white(tmp_path: Path, emission: str) -> None:
    photons = trace_wedge(tmp_path, GLASSES["SF10"], emission)
    landed = photons.power.astype(np.float64).sum(axis=0) / photons.report["flux"]["emitted"]
    np.testing.assert_allclose(landed, 1.0, atol=4.0 / np.sqrt(COUNT) if emission == "random" else 1e-3)


def test_the_mean_over_the_spectrum_is_white() -> None:
    colors = find_color(np.linspace(400.0, 700.0, 30_001))
    np.testing.assert_allclose(colors.mean(axis=0), 1.0, atol=1e-4)
    assert (colors >= 0.0).all()


def test_glass_without_dispersion_keeps_white_light_white(tmp_path: Path) -> None:
    photons = trace_to_shell(tmp_path, make_glass("glass", 1.5, 1.0), find_arriving(40.0))
    np.testing.assert_array_equal(photons.power, photons.power[:, :1].repeat(3, axis=1))


@pytest.mark.parametrize("kind", ["area", "environment", "point", "directional"])
def test_light_of_every_kind_stays_white_on_the_whole(tmp_path: Path, kind: str) -> None:
    """What arrives on a ball around a dispersing one; what an environment sends is not all met, but evenly so."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("ball", build_ball(0.3, 0.0, 64), make_flint(GLASSES["SF10"]))
        floor = build_quad(40.0, -1.0)
        writer.add_mesh("floor", floor, make_diffuse("black", 0.0))

    scene = pl.load_scene(write_without_floor(tmp_path, change))
    place = {"position": (0.0, 2.0, 0.0)} if kind in ("area", "point") else {}
    scene.add_light(kind, **place)
    photons = pl.trace_photons(scene, emitted=COUNT, emission="random")
    power = photons.power.astype(np.float64)
    sums, deviations = power.sum(axis=0), np.sqrt((power**2).sum(axis=0))
    # All that passed has a wavelength; the channels differ by chance alone.
    assert len(photons) > 1000
    assert np.ptp(sums) < 8.0 * deviations.max()
    assert np.ptp(power, axis=1).max() > 0.0


def test_a_slab_straight_on_shows_a_white_lamp_white(tmp_path: Path) -> None:
    """(1 − R)/(1 + R) of it, R the reflectance at each wavelength."""
    glass, radiance = GLASSES["SF10"], 2.0

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("slab", build_box((-1.0, 0.0, -1.0), (1.0, 0.2, 1.0)), make_flint(glass))
        lamp = {**make_diffuse("lamp", 0.0), "emissiveFactor": [1.0, 1.0, 1.0]}
        lamp["extensions"] = {"KHR_materials_emissive_strength": {"emissiveStrength": radiance}}
        writer.add_mesh("lamp", build_panel(1.0, -0.2, faces_up=True), lamp)

    scene = pl.load_scene(write_without_floor(tmp_path, change))
    camera = pl.Camera(position=(0.0, 1.0, 0.0), target=(0.0, 0.0, 0.0), up=(0.0, 0.0, -1.0), yfov=1e-3)
    image = pl.render(scene, mode="direct", camera=camera, width=8, height=8, samples=256, max_bounces=16)
    nanometers = 400.0 + 300.0 * (np.arange(3000) + 0.5) / 3000
    index = find_index(nanometers, glass)
    once = ((index - 1.0) / (index + 1.0)) ** 2
    truth = (find_color(nanometers) * ((1.0 - once) / (1.0 + once))[:, None]).mean(axis=0) * radiance
    np.testing.assert_allclose(np.asarray(image).mean(axis=(0, 1)), truth, rtol=2e-3)
