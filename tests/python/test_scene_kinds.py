# SPDX-License-Identifier: Apache-2.0
"""Compressed, sparse, skinned, morphed and instanced files are scenes like any other."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl

SEEDS = sorted((Path(__file__).parents[1] / "fuzz" / "corpus" / "scene").glob("*.gltf"))
COMPRESSED = [path for path in SEEDS if path.stem.startswith(("draco", "meshopt"))]
# Draco may order vertices and triangles anew; areas and bounds stay to rounding.
ROUNDING = 1e-6


@pytest.mark.parametrize("path", SEEDS, ids=lambda path: path.stem)
def test_photons_are_traced_through_a_file_of_any_kind(path: Path) -> None:
    scene = pl.load_scene(path)
    scene.add_light("auto")
    scene.add_floor()
    photons = pl.trace_photons(scene, 2_000, seed=1, store="all")
    assert np.isfinite(np.asarray(photons.positions)).all()
    assert len(photons) >= 2_000


def test_compressed_files_of_one_mesh_are_one_mesh() -> None:
    scenes = [pl.load_scene(path) for path in COMPRESSED]
    assert {scene.triangle_count for scene in scenes} == {40}
    for scene in scenes[1:]:
        np.testing.assert_allclose(scene.bounds, scenes[0].bounds, atol=ROUNDING)
