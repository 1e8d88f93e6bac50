# SPDX-License-Identifier: Apache-2.0
"""Gloss and clear coats: what a layer reflects, what lies under it gets, and that the two are all that arrives."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from gltf import GltfWriter, add_coat, build_quad, make_diffuse, make_glass, make_mirror
from microfacet_twin import Doubles, normalize, reflect_fresnel, reflect_rough
from shell_plates import (
    PHOTONS,
    PLATE,
    check_flux,
    find_arriving,
    integrate_density,
    look_at_plate,
    trace_to_shell,
    write_without_floor,
)
from statistics_checks import Z_LIMIT

COAT_F0 = 0.04  # of index 1.5
ANGLES = [0.0, 45.0, 75.0]
WHITE = (1.0, 1.0, 1.0)


def reflect_schlick(f0: Any, cosine: Any, f90: float = 1.0) -> Any:
    return f0 + (f90 - f0) * (1.0 - cosine) ** 5


def make_glossy(base: float, roughness: float, ior: float = 1.5, **specular: Any) -> dict[str, Any]:
    material = make_diffuse("glossy", base)
    material["pbrMetallicRoughness"]["roughnessFactor"] = roughness
    extensions = {"KHR_materials_specular": specular, "KHR_materials_ior": {"ior": ior}}
    return {**material, "extensions": extensions}


def find_mirrored(arriving: Doubles) -> Doubles:
    return np.array([-arriving[0], arriving[1], -arriving[2]])


def split_by_lobe(photons: pl.PhotonMap, arriving: Doubles) -> tuple[float, float]:
    """Share of the emitted flux that left in the mirrored direction, and that left in any other."""
    directions = normalize(photons.positions.astype(np.float64))
    is_mirrored = directions @ find_mirrored(arriving) > np.cos(5e-3)
    power = photons.power[:, 1].astype(np.float64) / photons.report["flux"]["emitted"][1]
    return float(power[is_mirrored].sum()), float(power[~is_mirrored].sum())


def allow(share: float) -> float:
    return Z_LIMIT * np.sqrt(share * (1.0 - share) / PHOTONS) + 1e-4


@pytest.mark.parametrize("degrees", ANGLES)
def test_a_white_base_under_a_smooth_coat_gets_what_the_coat_lets_through(tmp_path: Path, degrees: float) -> None:
    """F at the plate's normal is mirrored, 1 − F scattered by the cosine: together all of it."""
    arriving = find_arriving(degrees)
    photons = trace_to_shell(tmp_path, add_coat(make_diffuse("white", 1.0), 1.0), arriving, store="indirect")
    fresnel = reflect_schlick(COAT_F0, arriving[1])
    mirrored, scattered = split_by_lobe(photons, arriving)
    stray = (1.0 - fresnel) * (5e-3) ** 2 * arriving[1]  # of the cosine's, into the mirrored direction's cone
    assert abs(mirrored - fresnel - stray) < allow(fresnel)
    assert abs(mirrored + scattered - 1.0) < 1e-5
    far = normalize(photons.positions.astype(np.float64)) @ find_mirrored(arriving) < np.cos(5e-3)
    heights = normalize(photons.positions[far].astype(np.float64))[:, 1]
    assert abs(heights.mean() - 2.0 / 3.0) < Z_LIMIT * np.sqrt(1.0 / 18.0 / far.sum()) + 1e-4


@pytest.mark.parametrize("factor", [0.0, 0.4])
def test_a_coat_in_part_reflects_its_part(tmp_path: Path, factor: float) -> None:
    arriving = find_arriving(60.0)
    photons = trace_to_shell(tmp_path, add_coat(make_diffuse("half", 0.5), factor), arriving, store="indirect")
    fresnel = factor * reflect_schlick(COAT_F0, arriving[1])
    mirrored, scattered = split_by_lobe(photons, arriving)
    assert abs(mirrored - fresnel) < allow(fresnel) + 3e-5
    assert abs(scattered - 0.5 * (1.0 - fresnel)) < 2.0 * allow(0.5)


@pytest.mark.parametrize("degrees", ANGLES)
def test_metal_under_a_coat_reflects_what_the_coat_lets_through(tmp_path: Path, degrees: float) -> None:
    arriving, color = find_arriving(degrees), np.array([0.9, 0.6, 0.3])
    material = add_coat(make_mirror("metal", tuple(color)), 1.0)
    photons = trace_to_shell(tmp_path, material, arriving, store="caustic")
    coat, metal = reflect_schlick(COAT_F0, arriving[1]), reflect_schlick(color, arriving[1])
    landed = photons.power.astype(np.float64).sum(axis=0) / photons.report["flux"]["emitted"]
    np.testing.assert_allclose(landed, coat + (1.0 - coat) * metal, atol=2.0 * allow(0.5))


def test_glass_under_a_coat_passes_on_all_light(tmp_path: Path) -> None:
    arriving = find_arriving(70.0)
    photons = trace_to_shell(tmp_path, add_coat(make_glass("glass", 1.3, 1.0), 1.0), arriving, store="caustic")
    landed = photons.power[:, 0].astype(np.float64) / photons.report["flux"]["emitted"][0]
    coat = reflect_schlick(COAT_F0, arriving[1])
    reflected = coat + (1.0 - coat) * float(reflect_fresnel(np.asarray(arriving[1]), 1.0 / 1.3))
    assert abs(landed.sum() - 1.0) < 1e-5
    assert abs(landed[photons.positions[:, 1] > 0.0].sum() - reflected) < allow(reflected)


@pytest.mark.parametrize("degrees", ANGLES)
@pytest.mark.parametrize("ior", [1.5, 2.2])
def test_a_smooth_gloss_and_its_base_share_what_arrives(tmp_path: Path, ior: float, degrees: float) -> None:
    arriving, factor = find_arriving(degrees), 0.7
    photons = trace_to_shell(tmp_path, make_glossy(1.0, 0.0, ior, specularFactor=factor), arriving, store="indirect")
    fresnel = factor * reflect_schlick(((ior - 1.0) / (ior + 1.0)) ** 2, arriving[1])
    mirrored, scattered = split_by_lobe(photons, arriving)
    assert abs(mirrored - fresnel) < allow(fresnel) + 3e-5
    assert abs(mirrored + scattered - 1.0) < 1e-5


def test_a_gloss_has_the_color_that_its_extension_says(tmp_path: Path) -> None:
    """Straight on its color counts, capped at 1; at grazing angles less and less of it."""
    arriving, color, ior = find_arriving(30.0), np.array([2.0, 1.0, 0.5]), 1.8
    material = make_glossy(0.0, 0.0, ior, specularColorFactor=list(color))
    photons = trace_to_shell(tmp_path, material, arriving, store="indirect")
    landed = photons.power.astype(np.float64).sum(axis=0) / photons.report["flux"]["emitted"]
    f0 = np.minimum(((ior - 1.0) / (ior + 1.0)) ** 2 * color, 1.0)
    np.testing.assert_allclose(landed, reflect_schlick(f0, arriving[1]), rtol=0.02)


@pytest.mark.parametrize("degrees", [0.0, 60.0])
@pytest.mark.parametrize("roughness", [0.3, 0.8])
def test_a_rough_coat_scatters_as_its_density_says(tmp_path: Path, roughness: float, degrees: float) -> None:
    """Fresnel of the facet times the density of perfect mirrors; the base takes nothing here, being black."""
    arriving = find_arriving(degrees)
    material = add_coat(make_diffuse("black", 0.0), 1.0, roughness)
    photons = trace_to_shell(tmp_path, material, arriving, store="indirect")
    check_flux(photons, lambda w: reflect_layer(arriving, w, roughness), find_mirrored(arriving))


@pytest.mark.parametrize("degrees", [0.0, 60.0])
def test_a_rough_gloss_scatters_as_its_density_says(tmp_path: Path, degrees: float) -> None:
    arriving, roughness = find_arriving(degrees), 0.5
    material = make_glossy(0.0, roughness, 1.5, specularFactor=1.0)
    photons = trace_to_shell(tmp_path, material, arriving, store="indirect")
    check_flux(photons, lambda w: reflect_layer(arriving, w, roughness), find_mirrored(arriving))


def reflect_layer(arriving: Doubles, leaving: Doubles, roughness: float) -> Doubles:
    m = normalize(arriving + leaving)
    return reflect_schlick(COAT_F0, m @ arriving) * reflect_rough(arriving, leaving, roughness)


@pytest.mark.parametrize("roughness", [0.2, 0.6])
def test_a_white_base_under_a_rough_coat_gets_what_a_smooth_one_lets_through(tmp_path: Path, roughness: float) -> None:
    """The two together are 1 but for what facets of other slopes reflect more, or block: so many hundredths."""
    arriving = find_arriving(60.0)
    material = add_coat(make_diffuse("white", 1.0), 1.0, roughness)
    photons = trace_to_shell(tmp_path, material, arriving, store="indirect")
    landed = float(photons.power[:, 0].astype(np.float64).sum() / photons.report["flux"]["emitted"][0])
    coat = integrate_density(
        lambda w: np.where(w[..., 1] > 0.0, reflect_layer(arriving, w, roughness), 0.0), find_mirrored(arriving)
    ).sum()
    base = 1.0 - reflect_schlick(COAT_F0, arriving[1])
    assert abs(landed - base - coat) < Z_LIMIT * np.sqrt(coat / PHOTONS) + 1e-3
    assert abs(base + coat - 1.0) < 0.03


COVERED: dict[str, dict[str, Any]] = {
    "coat over white": add_coat(make_diffuse("white", 1.0), 1.0),
    "coat in part": add_coat(make_diffuse("white", 1.0), 0.5),
    "coat over mirror": add_coat(make_mirror("metal", WHITE), 1.0),
    "coat over glass": add_coat(make_glass("thin", 1.5, 0.0), 1.0),
    "gloss": make_glossy(1.0, 0.0, 1.8),
    "coat over gloss": add_coat(make_glossy(1.0, 0.0, 1.8), 1.0),
}


@pytest.mark.parametrize("name", list(COVERED))
@pytest.mark.parametrize("degrees", [5.0, 60.0, 80.0])
def test_white_layers_in_a_white_sky_are_as_bright_as_the_sky(tmp_path: Path, name: str, degrees: float) -> None:
    scene = pl.load_scene(
        write_without_floor(tmp_path, lambda writer: writer.add_mesh("plate", build_quad(PLATE), COVERED[name]))
    )
    scene.add_light("environment", intensity=1.0)
    camera = pl.Camera(position=tuple(2.0 * find_arriving(degrees)), target=(0.0, 0.0, 0.0), yfov=0.05)
    image = pl.render(scene, mode="direct", camera=camera, width=4, height=4, samples=64)
    np.testing.assert_allclose(np.asarray(image), 1.0, rtol=1e-3)


@pytest.mark.parametrize("degrees", [20.0, 70.0])
def test_a_picture_of_a_coated_base_is_dimmed_by_what_the_coat_reflects(tmp_path: Path, degrees: float) -> None:
    """(1 − F(eye)) · E · base / π: a point light does not shine back off a smooth coat."""
    light, eye = 3.0 * find_arriving(40.0), 2.0 * find_arriving(degrees)
    seen = look_at_plate(tmp_path, add_coat(make_diffuse("gray", 0.6), 1.0), light, eye)
    truth = (1.0 - reflect_schlick(COAT_F0, normalize(eye)[1])) * np.cos(np.radians(40.0)) / 9.0 * 0.6 / np.pi
    np.testing.assert_allclose(seen, truth, rtol=2e-3)


@pytest.mark.parametrize("roughness", [0.2, 0.6])
@pytest.mark.parametrize("kind", ["coat", "gloss"])
def test_a_light_shines_back_off_a_rough_layer(tmp_path: Path, kind: str, roughness: float) -> None:
    light, eye = 3.0 * find_arriving(40.0), 2.0 * normalize(np.array([-0.5, 0.7, -0.4]))
    is_coat = kind == "coat"
    material = add_coat(make_diffuse("b", 0.5), 1.0, roughness) if is_coat else make_glossy(0.5, roughness)
    seen = look_at_plate(tmp_path, material, light, eye)
    to_light, to_eye = normalize(light), normalize(eye)
    base = (1.0 - reflect_schlick(COAT_F0, to_eye[1])) * 0.5 / np.pi * to_light[1]
    truth = (float(reflect_layer(to_eye, to_light, roughness)) + base) / 9.0
    np.testing.assert_allclose(seen, truth, rtol=4e-3)


@pytest.mark.parametrize("coat_roughness", [0.0, 0.4])
def test_a_light_shines_back_off_rough_metal_through_its_coat(tmp_path: Path, coat_roughness: float) -> None:
    """What the metal shows is dimmed by the coat's reflectance towards the eye; a rough coat adds its own."""
    light, eye = 3.0 * find_arriving(40.0), 2.0 * normalize(np.array([-0.9, 0.3, -0.6]))
    seen = look_at_plate(tmp_path, add_coat(make_mirror("metal", WHITE, 0.5), 1.0, coat_roughness), light, eye)
    to_light, to_eye = normalize(light), normalize(eye)
    truth = (1.0 - reflect_schlick(COAT_F0, to_eye[1])) * float(reflect_rough(to_eye, to_light, 0.5))
    if coat_roughness > 0.0:
        truth += float(reflect_layer(to_eye, to_light, coat_roughness))
    np.testing.assert_allclose(seen, truth / 9.0, rtol=4e-3)


def test_layers_nothing_has_cost_nothing(tmp_path: Path) -> None:
    def write(name: str, material: dict[str, Any]) -> pl.Scene:
        def change(writer: GltfWriter) -> None:
            writer.add_mesh("plate", build_quad(PLATE), material)
            writer.add_point_light("lamp", (0.0, 1.0, 0.0), 1.0)

        return pl.load_scene(write_without_floor(tmp_path / name, change))

    assert "gloss and coats" in write("bare", make_diffuse("d", 0.5)).report["left_out"]
    assert "gloss and coats" in write("zero", add_coat(make_diffuse("d", 0.5), 0.0)).report["left_out"]
    assert "gloss and coats" in write("coated", add_coat(make_diffuse("d", 0.5), 0.1)).report["requires"]
