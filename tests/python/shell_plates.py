# SPDX-License-Identifier: Apache-2.0
"""A small plate that throws light on a black ball around it: directions held against densities integrated over bins."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import photonloupe as pl
from gltf import GltfWriter, Mesh, build_quad, make_diffuse
from lit_scenes import build_ball
from microfacet_twin import Doubles, normalize
from statistics_checks import compute_chi_square_p

P_LIMIT = 1e-4
PHOTONS = 1 << 19
SHELL = 1000.0  # metres: seen from there the plate is a point
PLATE = 0.5
Density = Callable[[Doubles], Doubles]


def find_arriving(degrees: float, *, from_below: bool = False) -> Doubles:
    """Unit vector towards the light, out of every plane of symmetry."""
    angle, azimuth = np.radians(degrees), 0.7
    up = -np.cos(angle) if from_below else np.cos(angle)
    return np.array([np.sin(angle) * np.cos(azimuth), up, np.sin(angle) * np.sin(azimuth)])


def trace_to_shell(folder: Path, material: dict[str, Any], arriving: Doubles, **settings: Any) -> pl.PhotonMap:
    """Light on a small plate in the middle of a black ball, stored where it lands."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("plate", build_quad(PLATE), material)
        ball = build_ball(SHELL, 0.0, 64)
        writer.add_mesh("shell", Mesh(ball.positions, -ball.normals, ball.indices[:, ::-1]), make_diffuse("black", 0.0))
        writer.add_spot_light("spot", tuple(100.0 * arriving), (0.0, 0.0, 0.0), 1.0, 1e-3, 1e-3)

    scene = pl.load_scene(write_without_floor(folder, change))
    return pl.trace_photons(scene, **{"emitted": PHOTONS, "store": "caustic", "emission": "random", **settings})


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


def count_directions(directions: Doubles, axis: Doubles, weights: Doubles | None = None) -> Doubles:
    polar, azimuth, u, v = build_bins(axis)
    angle = np.arccos(np.clip(directions @ axis, -1.0, 1.0))
    turn = np.arctan2(directions @ v, directions @ u)
    return np.histogram2d(angle, turn, [polar, azimuth], weights=weights)[0]


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
    """Every photon carries the same flux, so that counts tell where it goes; `density` is of all that was emitted."""
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


def check_flux(photons: pl.PhotonMap, density: Density, axis: Doubles) -> None:
    """The same where photons carry different flux, of the first channel and above the plate."""
    weights = photons.power[:, 0].astype(np.float64) / photons.report["flux"]["emitted"][0] * PHOTONS
    directions, axis = normalize(photons.positions.astype(np.float64)), normalize(axis)
    expected = PHOTONS * integrate_density(lambda w: np.where(w[..., 1] > 0.0, density(w), 0.0), axis)
    sums, squares = (count_directions(directions, axis, weights**power) for power in (1, 2))
    assert abs(sums.sum() - expected.sum()) < 4.0 * np.sqrt(squares.sum()) + 1e-3 * expected.sum()
    # In units of what one photon carries there, so that the sums are as spread as counts.
    unit = np.divide(squares, sums, where=sums > 0.0, out=np.ones_like(sums))
    assert compute_chi_square_p((sums / unit).ravel(), (expected / unit).ravel()) > P_LIMIT


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
