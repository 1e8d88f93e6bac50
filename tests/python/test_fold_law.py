# SPDX-License-Identifier: Apache-2.0
"""Parallel light in a mirror cylinder: its caustic is the nephroid, oracle 3, and grows by the fold law, oracle 6."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import cKDTree

import photonloupe as pl
from conftest import write_scene
from gltf import GltfWriter, build_cylinder, make_mirror
from oracles import fold_flux, nephroid

RADIUS, HEIGHT, SLOPE, IRRADIANCE = 1.0, 0.4, 0.6, 3.0
EMITTED = 1 << 21
STRIP = 1e-3  # m
BLUR = 2e-4  # m
PARTS = 400


@pytest.fixture(scope="module")
def photons(tmp_path_factory: pytest.TempPathFactory) -> pl.PhotonMap:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("wall", build_cylinder(RADIUS, HEIGHT, 6000, 2), make_mirror("mirror", (1.0, 1.0, 1.0)))
        writer.add_directional_light("sun", (1.0, -SLOPE, 0.0), IRRADIANCE)

    scene = pl.load_scene(write_scene(tmp_path_factory.mktemp("nephroid"), "nephroid", change, lamp=False))
    return pl.trace_photons(scene, emitted=EMITTED, emission="random").select(signature="1")


def test_reflected_light_touches_the_nephroid(photons: pl.PhotonMap) -> None:
    starts = photons.path_offsets[:-1]
    wall = photons.path_vertices[starts + 1][:, [0, 2]].astype(np.float64)
    way = photons.positions[:, [0, 2]].astype(np.float64) - wall
    inner = (wall * way).sum(axis=1) < 0.0  # reflected inside
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    away = nephroid(np.arctan2(wall[:, 1], wall[:, 0]), RADIUS) - wall
    off = np.abs(way[:, 0] * away[:, 1] - way[:, 1] * away[:, 0])
    assert np.count_nonzero(inner) > 100_000
    assert np.quantile(off[inner], 0.999) < 2e-3  # within a facet, of 1e-3 radians
    assert off[inner].mean() < 5e-4


def test_flux_beside_the_caustic_follows_the_fold_law(photons: pl.PhotonMap) -> None:
    t = np.linspace(0.4, 0.8, 40_001)
    curve = nephroid(t, RADIUS)
    tangent = np.stack([np.cos(2.0 * t), np.sin(2.0 * t)], axis=1)
    places = photons.positions[:, [0, 2]].astype(np.float64)
    distance, nearest = cKDTree(curve).query(places, distance_upper_bound=2.0 * STRIP)
    found = np.isfinite(distance) & (nearest > 0) & (nearest < len(t) - 1)
    at = nearest[found]
    offset = places[found] - curve[at]
    # Lit is the side where two tangents lie: the curve's hollow faces the other way.
    side = tangent[at, 0] * offset[:, 1] - tangent[at, 1] * offset[:, 0]
    power = photons.power[:, 0].astype(np.float64)[found]
    beside = distance[found]
    # Facets blur the edge a little: what lies just outside belongs inside.
    assert not np.any((side > 0.0) & (beside > BLUR))
    measured = power[beside < STRIP].sum()
    floor = IRRADIANCE * SLOPE / np.hypot(1.0, SLOPE)
    step = (t[-1] - t[0]) / PARTS
    truth = sum(
        fold_flux(STRIP, 1.5 * RADIUS * np.sin(at) * step, 0.5 * RADIUS * np.cos(at), 0.75 * RADIUS * np.sin(at), floor)
        for at in t[0] + step * (np.arange(PARTS) + 0.5)
    )
    assert measured == pytest.approx(truth, rel=0.02)
    # Half of it lies within a quarter of the strip.
    assert power[beside < 0.25 * STRIP].sum() / measured == pytest.approx(0.5, abs=0.02)
