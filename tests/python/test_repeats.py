# SPDX-License-Identifier: Apache-2.0
"""Two runs of the program, in processes of their own, give the same bits."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from conftest import find_scene

PROGRAM = """
import hashlib, sys
import numpy as np
import photonloupe as pl

scene = pl.load_scene(sys.argv[1])
photons = pl.trace_photons(scene, 30_000, seed=7, emission=sys.argv[2], columns=["path_vertices"])
points = photons.positions[::100] + np.float32(0.001)
image = pl.render(scene, photons, width=64, height=48, samples=2, k=30)
arrays = [
    photons.positions, photons.normals, photons.power, photons.emitted_index, photons.path_vertices,
    photons.path_interactions, *photons.neighbors(points, 40), photons.irradiance(points, [0, 1, 0], k=30),
    *photons.tree.values(), np.asarray(image),
    pl.measure_blue_noise(photons.positions[:, ::2], frequencies=0.1).power,
]
for array in arrays:
    print(hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest())
"""

# Layers of a parameter hold and repel photons, photons return to their floor, fluxes even out, radii are carried.
RELAXATION = """
import hashlib, sys
import numpy as np
import photonloupe as pl

scene = pl.load_scene(sys.argv[1])
photons = pl.trace_photons(scene, 8_000, seed=7, emission=sys.argv[2], max_bounces=1)
photons.set_parameters(photons.positions[:, ::2])
every = np.arange(0, len(photons), 10)
layered = {"constraint": "parameter", "repel": "parameter", "beta": 3.0, "neighbors": 6}
maps = [
    photons.relax(2, descriptor="tensor", diffuse_flux=True, **layered),
    photons.relax(2, descriptor="split", constraint="world", neighbors=6),
    photons.relax(3, descriptor="pca", constraint="world", search="carried"),
]
arrays = [
    *(array for relaxed in maps for array in relaxed.read_columns().values()),
    *photons.neighbors(every, 40, space="parameter"), *photons.neighbors(every, 40, space="constrained"),
    pl.optimal_beta(photons).isotropy.values,
]
for array in arrays:
    print(hashlib.sha256(np.ascontiguousarray(array).tobytes()).hexdigest())
"""


def run_program(scene: str, emission: str, program: str = PROGRAM, **environment: str) -> str:
    result = subprocess.run(
        [sys.executable, "-c", program, str(find_scene(scene)), emission],
        capture_output=True,
        text=True,
        timeout=120,
        check=True,
        env={**os.environ, **environment},
    )
    return result.stdout


@pytest.mark.parametrize(("scene", "emission"), [("ring", "sobol"), ("slab", "random")])
def test_two_runs_give_the_same_bits(scene: str, emission: str) -> None:
    assert run_program(scene, emission) == run_program(scene, emission)


def test_staging_copies_give_the_same_bits() -> None:
    assert run_program("ring", "sobol", PHOTONLOUPE_FORCE_STAGING="1") == run_program("ring", "sobol")


def test_buffers_by_address_give_the_same_bits() -> None:
    # Most columns exceed this range, as large maps exceed a real device's.
    assert run_program("ring", "sobol", PHOTONLOUPE_STORAGE_RANGE="100000") == run_program("ring", "sobol")


@pytest.fixture(scope="module")
def relaxation() -> str:
    return run_program("ring", "random", RELAXATION)


@pytest.mark.parametrize(
    "environment",
    [{}, {"PHOTONLOUPE_FORCE_STAGING": "1"}, {"PHOTONLOUPE_STORAGE_RANGE": "100000"}],
    ids=["again", "staging", "by address"],
)
def test_relaxation_gives_the_same_bits(relaxation: str, environment: dict[str, str]) -> None:
    assert len(relaxation.split()) > 40
    assert run_program("ring", "random", RELAXATION, **environment) == relaxation
