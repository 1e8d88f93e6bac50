# SPDX-License-Identifier: Apache-2.0
"""The lamp's power is what its shade shows and its bulb sends; its bowl is closed, and frosted."""

from __future__ import annotations

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene
from shaded_lamp import LAMP, paint_shade
from test_textures import decode_srgb
from turning import build_profile, turn_profile


@pytest.fixture(scope="module")
def scene() -> pl.Scene:
    return pl.load_scene(find_scene("lamp"))


def test_lamp_loads_with_nothing_left_out_but_specular_lobes(scene: pl.Scene) -> None:
    assert [line for line in scene.report["ignored"] if "lobe" not in line] == []


def test_bowl_is_closed_and_faces_outward() -> None:
    mesh = turn_profile(build_profile(LAMP.list_corners()), 24)
    edges = np.sort(mesh.indices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    a, b, c = (mesh.positions[mesh.indices[:, i]] for i in range(3))
    assert np.einsum("ij,ij->", np.cross(b - a, c - a), a) > 0.0  # six times the volume


def test_bowl_has_enough_triangles(scene: pl.Scene) -> None:
    assert next(each["triangle_count"] for each in scene.objects if each["name"] == "bowl") >= 20_000


def test_lamps_send_what_texture_and_bulb_say(scene: pl.Scene) -> None:
    """π times radiance times area, of the shade on both sides and each ring of it by its width."""
    photons = pl.trace_photons(scene, emitted=1 << 12, store="all", max_bounces=1)
    radius = np.linspace(LAMP.shade_neck, LAMP.shade_radius, LAMP.texture_height + 1)
    slant = np.hypot(LAMP.shade_high - LAMP.shade_low, LAMP.shade_radius - LAMP.shade_neck)
    rings = np.pi * (radius[1:] + radius[:-1]) * slant / LAMP.texture_height
    shown = decode_srgb(paint_shade(LAMP)).mean(axis=1) * LAMP.radiance
    shade = 2.0 * np.pi * (rings[:, None] * shown).sum(axis=0)
    bulb = np.pi * 4.0 * np.pi * LAMP.bulb_radius**2 * LAMP.bulb_radiance * np.array(LAMP.glow)
    # Facets of the bulb lie within its ball, its area is the smaller by so much.
    np.testing.assert_allclose(photons.report["flux"]["emitted"], shade + bulb, rtol=0.01)


def test_frost_spreads_what_smooth_glass_would_focus(scene: pl.Scene) -> None:
    """No spot of the table within the bowl's shadow is lit ten times as brightly as the rest of it."""
    photons = pl.trace_photons(scene, 100_000, seed=1)
    assert (np.unique(photons.path_scatter[photons.path_offsets[:-1] + 1].round(3)) == round(LAMP.roughness, 3)).all()
    turn, radius = np.meshgrid(np.linspace(0.0, 2.0 * np.pi, 48), np.linspace(0.01, 0.1, 24))
    points = np.stack([radius * np.cos(turn), 0.0 * turn, radius * np.sin(turn)], axis=2).reshape(-1, 3)
    seen = photons.irradiance(points, [0, 1, 0], k=250)[:, 1]
    assert seen.max() < 10.0 * np.median(seen)
