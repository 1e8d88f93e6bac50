# SPDX-License-Identifier: Apache-2.0
"""The committed scenes are what the generator writes, and small."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from conftest import SCENES, find_scene
from generate import SCENES as BUILDERS

MAX_BYTES = 1_000_000


@pytest.mark.parametrize("name", BUILDERS)
def test_committed_document_is_what_the_generator_writes(name: str, tmp_path: Path) -> None:
    BUILDERS[name]().write(tmp_path)
    assert json.loads((tmp_path / f"{name}.gltf").read_text()) == json.loads(find_scene(name).read_text())


@pytest.mark.parametrize("name", BUILDERS)
def test_committed_buffer_is_what_the_generator_writes(name: str) -> None:
    # Sines may differ in the last bit from one NumPy to the next; all else is the same bytes.
    committed = (SCENES / name / f"{name}.bin").read_bytes()
    written = bytes(BUILDERS[name]().buffer)
    document = json.loads(find_scene(name).read_text())
    for accessor in document["accessors"]:
        view = document["bufferViews"][accessor["bufferView"]]
        kind = {5126: "<f4", 5123: "<u2", 5125: "<u4"}[accessor["componentType"]]
        part = slice(view["byteOffset"], view["byteOffset"] + view["byteLength"])
        np.testing.assert_allclose(np.frombuffer(written[part], kind), np.frombuffer(committed[part], kind), atol=1e-7)


@pytest.mark.parametrize("name", BUILDERS)
def test_scene_files_are_under_a_megabyte(name: str) -> None:
    assert max(path.stat().st_size for path in (SCENES / name).glob(f"{name}.[gb]*")) < MAX_BYTES


@pytest.mark.parametrize("name", ["ring", "bowl"])
def test_curved_wall_has_enough_triangles(name: str) -> None:
    assert len(BUILDERS[name]().buffer) > 0
    document = json.loads(find_scene(name).read_text())
    wall = document["meshes"][0]["primitives"][0]["indices"]
    assert document["accessors"][wall]["count"] / 3 >= 20_000
