# SPDX-License-Identifier: Apache-2.0
"""Diffuse transmission: how much light a thin translucent surface passes, where it goes, and what either side shows."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from gltf import GltfWriter, build_quad, make_glass, make_translucent
from lit_scenes import build_ball
from microfacet_twin import Doubles
from shell_plates import (
    PHOTONS,
    check_directions,
    find_arriving,
    integrate_density,
    look_at_plate,
    trace_to_shell,
    write_without_floor,
)
from test_textures import COORDINATES, decode_srgb, encode

UP = np.array([0.0, 1.0, 0.0])
FACTOR = 0.3
COLOR = np.array([0.2, 0.6, 0.9])
BASE = np.array([0.8, 0.5, 0.1])


def send_cosine(w: Doubles) -> Doubles:
    return np.abs(w[..., 1]) / np.pi


@pytest.mark.parametrize("from_below", [False, True])
def test_light_leaves_either_side_by_the_cosine(tmp_path: Path, *, from_below: bool) -> None:
    """White on both sides, so that each photon keeps its flux; the side decides how many there are."""
    material = make_translucent("leaf", (1.0, 1.0, 1.0), FACTOR, (1.0, 1.0, 1.0))
    arriving = find_arriving(50.0, from_below=from_below)
    photons = trace_to_shell(tmp_path, material, arriving, store="indirect")
    for above in (True, False):
        share = FACTOR if above == from_below else 1.0 - FACTOR
        check_directions(photons, lambda w, share=share: share * send_cosine(w), UP if above else -UP, above=above)
    assert len(photons) == PHOTONS


def test_twins_of_the_density_hold_all_light() -> None:
    np.testing.assert_allclose(integrate_density(send_cosine, UP).sum(), 2.0, rtol=1e-4)


@pytest.mark.parametrize("from_below", [False, True])
def test_either_side_gets_its_share_in_its_color(tmp_path: Path, *, from_below: bool) -> None:
    material = make_translucent("leaf", tuple(BASE), FACTOR, tuple(COLOR))
    photons = trace_to_shell(tmp_path, material, find_arriving(20.0, from_below=from_below), store="indirect")
    emitted = np.asarray(photons.report["flux"]["emitted"])
    is_above = photons.positions[:, 1] > 0.0
    for above in (True, False):
        share = FACTOR * COLOR if above == from_below else (1.0 - FACTOR) * BASE
        landed = photons.power[is_above == above].astype(np.float64).sum(axis=0) / emitted
        np.testing.assert_allclose(landed, share, atol=4.0 * 0.5 / np.sqrt(PHOTONS))


@pytest.mark.parametrize("is_lit_from_below", [False, True])
@pytest.mark.parametrize("is_seen_from_below", [False, True])
def test_a_picture_of_either_side_follows_the_closed_form(
    tmp_path: Path, *, is_seen_from_below: bool, is_lit_from_below: bool
) -> None:
    """E · color · factor / π of light from behind, E · base · (1 − factor)/π of light from the eye's side."""
    material = make_translucent("leaf", tuple(BASE), FACTOR, tuple(COLOR))
    light = 3.0 * find_arriving(40.0, from_below=is_lit_from_below)
    eye = 2.0 * find_arriving(25.0, from_below=is_seen_from_below)
    seen = look_at_plate(tmp_path, material, light, eye)
    share = (1.0 - FACTOR) * BASE if is_seen_from_below == is_lit_from_below else FACTOR * COLOR
    np.testing.assert_allclose(seen, np.cos(np.radians(40.0)) / 9.0 * share / np.pi, rtol=2e-3)


@pytest.mark.parametrize("is_seen_from_below", [False, True])
def test_a_translucent_sheet_in_a_white_sky_is_as_bright_as_the_sky(
    tmp_path: Path, *, is_seen_from_below: bool
) -> None:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("leaf", build_quad(1.0), make_translucent("leaf", (1.0, 1.0, 1.0), FACTOR, (1.0, 1.0, 1.0)))

    scene = pl.load_scene(write_without_floor(tmp_path, change))
    scene.add_light("environment", intensity=1.0)
    eye = 2.0 * find_arriving(35.0, from_below=is_seen_from_below)
    camera = pl.Camera(position=tuple(eye), target=(0.0, 0.0, 0.0), yfov=0.05)
    image = pl.render(scene, mode="direct", camera=camera, width=4, height=4, samples=16)
    np.testing.assert_allclose(np.asarray(image), 1.0, rtol=1e-4)


def test_textures_say_where_and_in_which_color_light_passes(tmp_path: Path) -> None:
    """The factor's alpha on the left half, the color's codes on the right; seen from behind under light of π W/m²."""
    alpha = np.zeros((8, 8, 4), dtype=np.uint8)
    alpha[:, :4, 3], alpha[:, 4:, 3] = 51, 255
    colors = np.full((8, 8, 3), 255, dtype=np.uint8)
    colors[:, 4:] = (200, 120, 40)

    def change(writer: GltfWriter) -> None:
        leaf = make_translucent("leaf", (1.0, 1.0, 1.0), 0.5, (1.0, 0.5, 1.0))
        passing = leaf["extensions"]["KHR_materials_diffuse_transmission"]
        passing["diffuseTransmissionTexture"] = {"index": writer.add_texture(encode(alpha), magFilter=9728)}
        passing["diffuseTransmissionColorTexture"] = {"index": writer.add_texture(encode(colors), magFilter=9728)}
        writer.add_mesh("leaf", build_quad(1.0), leaf, coordinates=[COORDINATES])
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), np.pi)

    scene = pl.load_scene(write_without_floor(tmp_path, change))
    expected = {-0.5: 0.5 * 0.2 * np.array([1.0, 0.5, 1.0]), 0.5: 0.5 * decode_srgb(colors[0, 4]) * [1.0, 0.5, 1.0]}
    for x, truth in expected.items():
        camera = pl.Camera(position=(x, -1.0, 0.1), target=(x, 0.0, 0.1), up=(0.0, 0.0, -1.0), yfov=1e-3)
        image = pl.render(scene, mode="direct", camera=camera, width=2, height=2, samples=1)
        np.testing.assert_allclose(np.asarray(image).mean(axis=(0, 1)), truth, rtol=1e-4)


def test_a_caustic_on_a_leaf_is_seen_from_below_in_its_own_measure(tmp_path: Path) -> None:
    """Either side of the leaf shows the same photons: the two pictures differ by the ratio of their shares."""
    factor, color, base = 0.4, 0.5, 0.8

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("marble", build_ball(0.2, 0.3, 64), make_glass("glass", 1.5, 0.4))
        leaf = make_translucent("leaf", (base,) * 3, factor, (color,) * 3)
        writer.add_mesh("leaf", build_quad(1.0), leaf)
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), 1.0)

    scene = pl.load_scene(write_without_floor(tmp_path, change))
    photons = pl.trace_photons(scene, 100_000, seed=1)
    views: list[Any] = []
    for side in (1.0, -1.0):
        camera = pl.Camera(position=(0.0, side * 0.09, 0.0), target=(0.0, 0.0, 0.0), up=(0.0, 0.0, -1.0), yfov=0.8)
        image = pl.render(scene, photons, mode="caustic", camera=camera, width=16, height=16, samples=16)
        views.append(np.asarray(image, dtype=np.float64))
    # From below the picture's left and right change places.
    ratio = views[1][:, ::-1].mean() / views[0].mean()
    np.testing.assert_allclose(ratio, factor * color / ((1.0 - factor) * base), rtol=0.01)
    assert views[0].mean() > 0.1


def test_light_that_passed_a_leaf_is_indirect_and_lands_beyond(tmp_path: Path) -> None:
    """What lies below a wide leaf gets the share that passed: a floor so near that next to nothing goes by it."""
    gap = 0.01

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("leaf", build_quad(1.0, gap), make_translucent("leaf", (0.0, 0.0, 0.0), FACTOR, tuple(COLOR)))
        writer.add_mesh("floor", build_quad(1.0), make_translucent("black", (0.0, 0.0, 0.0), 0.0, (1.0, 1.0, 1.0)))
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), 1.0)

    scene = pl.load_scene(write_without_floor(tmp_path, change))
    photons = pl.trace_photons(scene, emitted=1 << 18, store="indirect", emission="random")
    assert (photons.object == 1).all()
    inner = np.abs(photons.positions[:, [0, 2]]).max(axis=1) < 0.7
    irradiance = photons.power[inner].astype(np.float64).sum(axis=0) / 1.4**2
    np.testing.assert_allclose(irradiance, FACTOR * COLOR, rtol=0.02)
    assert (photons.path_interactions[photons.path_offsets[:-1] + 1] == 2).all()
