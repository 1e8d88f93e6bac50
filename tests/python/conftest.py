# SPDX-License-Identifier: Apache-2.0
"""Fixtures that many tests share: the scenes' files, a ring and its photon map, scenes made on the spot."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest

import generate
from gltf import GltfWriter, build_quad, make_diffuse

if TYPE_CHECKING:
    from photonloupe import PhotonMap, Scene

SCENES = Path(generate.__file__).resolve().parent


def find_scene(name: str) -> Path:
    return SCENES / name / f"{name}.gltf"


@pytest.fixture(autouse=True)
def clean_repository() -> Iterator[None]:
    """Fail a test that leaves something at the repository's root, where tests are started."""
    before = set(os.listdir(SCENES.parent))
    yield
    left = {name for name in set(os.listdir(SCENES.parent)) - before if not name.startswith(".")}
    assert not left, f"left at the repository's root: {', '.join(sorted(left))}; write into tmp_path"


@pytest.fixture(scope="session")
def ring_path() -> Path:
    return find_scene("ring")


@pytest.fixture(scope="session")
def ring(ring_path: Path) -> Scene:
    import photonloupe as pl  # noqa: PLC0415 - the oracles' own tests run without the engine

    return pl.load_scene(ring_path)


@pytest.fixture(scope="session")
def ring_map(ring: Scene) -> PhotonMap:
    import photonloupe as pl  # noqa: PLC0415

    return pl.trace_photons(ring, 200_000, seed=1)


@pytest.fixture(scope="session")
def plate_path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A lamp at height 1 over a square of half side 2, nothing specular."""
    return write_scene(tmp_path_factory.mktemp("plate"), "plate")


def write_scene(
    folder: Path, name: str, change: Callable[[GltfWriter], Any] | None = None, *, lamp: bool = True, floor: bool = True
) -> Path:
    """Write a lamp over a diffuse square, less what is left out, plus what `change` adds."""
    writer = GltfWriter(name)
    if floor:
        writer.add_mesh("floor", build_quad(2.0), make_diffuse("plaster", 0.5))
    if lamp:
        writer.add_point_light("lamp", (0.0, 1.0, 0.0), 10.0)
    if change is not None:
        change(writer)
    writer.write(folder)
    return folder / f"{name}.gltf"


def make_columns(count: int, *, seed: int = 0, paths: bool = True) -> dict[str, np.ndarray]:
    """Valid columns of a made-up map; path i has 2 + i mod 3 vertices."""
    rng = np.random.default_rng(seed)
    normals = rng.normal(size=(count, 3))
    columns = {
        "positions": rng.normal(size=(count, 3)).astype(np.float32),
        "normals": (normals / np.linalg.norm(normals, axis=1, keepdims=True)).astype(np.float32),
        "power": rng.random((count, 3)).astype(np.float32),
        "emitter": rng.integers(0, 3, count).astype(np.int32),
        "emitted_index": np.arange(count, dtype=np.uint64) * 2,
        "object": rng.integers(0, 5, count).astype(np.int32),
    }
    if paths:
        offsets = np.concatenate([[0], np.cumsum(2 + np.arange(count) % 3)]).astype(np.int64)
        vertices = int(offsets[-1])
        interactions = rng.integers(1, 3, vertices).astype(np.uint8)
        interactions[offsets[:-1]] = 0
        interactions[offsets[1:] - 1] = 0
        columns |= {
            "path_offsets": offsets,
            "path_vertices": rng.normal(size=(vertices, 3)).astype(np.float32),
            "path_normals": rng.normal(size=(vertices, 3)).astype(np.float32),
            "path_interactions": interactions,
            "path_objects": rng.integers(0, 5, vertices).astype(np.int32),
            "path_scatter": rng.random(vertices).astype(np.float32),
        }
    return columns
