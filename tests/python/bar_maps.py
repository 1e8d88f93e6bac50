# SPDX-License-Identifier: Apache-2.0
"""What the tests of `prism` and `lightguide` share: maps, oracles, and photons that only crossed the bar's sides."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from bar_oracle import GlassBar
from conftest import SCENES, find_scene
from generate import LIGHTGUIDE, PRISM
from statistics_checks import compute_chi_square_p
from stripes import RELAXATION, load_stripe

Doubles = NDArray[np.float64]

# Photons this near the middle plane land as its rays do: the next term is the square of this over the lamp's distance.
MIDDLE = 0.02  # m
CELLS = 40
# Normals on the straight part of a bar have no component along it, but for the rounding of the file's floats.
STRAIGHT = 1e-5


@cache
def build_bar_oracle(name: str) -> GlassBar:
    if name == "prism":
        return GlassBar(PRISM.list_corners(), PRISM.ior, PRISM.light[:2], PRISM.intensity)
    return GlassBar(LIGHTGUIDE.list_corners(), LIGHTGUIDE.ior, (0.0, LIGHTGUIDE.light_height), LIGHTGUIDE.intensity)


@cache
def trace_bar(name: str, count: int, emission: str, seed: int = 1) -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene(name)), count, seed=seed, emission=emission)


@cache
def select_straight(name: str, count: int) -> tuple[pl.PhotonMap, Doubles, Doubles]:
    """Photons refracted twice at the bar's straight part: their map, vertices (n, 4, 3) and normals (n, 4, 3)."""
    twice = trace_bar(name, count, "random").select(signature="22")
    normals = twice.path_normals.astype(np.float64).reshape(-1, 4, 3)
    mask = (np.abs(normals[:, 1:3, 2]) < STRAIGHT).all(axis=1)
    vertices = twice.path_vertices.astype(np.float64).reshape(-1, 4, 3)
    return twice.select(mask), vertices[mask], normals[mask]


def compare_cells(name: str, count: int, low: float, high: float, angles: tuple[float, float]) -> float:
    """χ² probability that photons near the middle plane fall into cells of x as the oracle says."""
    photons = select_straight(name, count)[0]
    edges = np.linspace(low, high, CELLS + 1)
    near = np.abs(photons.positions[:, 2]) < MIDDLE
    found = np.histogram(photons.positions[near, 0], edges)[0]
    irradiance = build_bar_oracle(name).find_cell_irradiance(edges, angles)
    expected = irradiance * np.diff(edges) * 2.0 * MIDDLE / float(photons.power[0, 0])
    return compute_chi_square_p(found, expected)


@cache
def measure_kept(name: str, emission: str, parameters: str) -> float:
    """Share of the stripe's contrast in the raw map, or after relaxing with the parameters of a script."""
    stripe = load_stripe(name)
    photons = pl.trace_photons(pl.load_scene(find_scene(name)), stripe.photons, seed=1, emission=emission)
    if parameters == "raw":
        return stripe.measure_share(photons)
    photons.run_script(SCENES / "scripts" / f"{parameters}.photon")
    return stripe.measure_share(photons.relax(**RELAXATION))
