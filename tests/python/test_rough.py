# SPDX-License-Identifier: Apache-2.0
"""Rough metal and glass: where light goes and how much, against the textbook's density integrated over bins."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from gltf import GltfWriter, Mesh, build_quad, make_glass, make_mirror
from lit_scenes import build_ball, load
from microfacet_twin import Doubles, normalize, reflect_rough, scatter_glass, scatter_thin
from shell_plates import check_directions, find_arriving, look_at_plate, trace_to_shell

IOR = 1.5


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


def far_faces() -> tuple[Doubles, NDArray[np.int64]]:
    quad = build_quad(0.01)
    return quad.normals, quad.indices
