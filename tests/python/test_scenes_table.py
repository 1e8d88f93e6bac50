# SPDX-License-Identifier: Apache-2.0
"""The table's glass is a closed solid with exact normals; its caustic lies on every receiver and crosses the edge."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from conftest import find_scene
from gltf import Mesh
from laid_table import TABLE

RECEIVERS = {"table": 2, "floor": 3, "wall": 4, "shelf": 5}
EDGE = TABLE.table.high[0]
NEAR_EDGE = 0.01  # m


@pytest.fixture(scope="module")
def glass() -> Mesh:
    return TABLE.glass.build_mesh()


@pytest.fixture(scope="module")
def photons() -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene("table")), 50_000, seed=1)


def find_facets(mesh: Mesh) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Twice the area times the normal of every triangle, and the middle of its vertices."""
    a, b, c = (mesh.positions[mesh.indices[:, i]] for i in range(3))
    return np.cross(b - a, c - a), (a + b + c) / 3.0


def test_curved_parts_have_enough_triangles(glass: Mesh) -> None:
    assert len(glass.indices) + 2 * TABLE.ring_segments >= 20_000


def test_glass_is_closed(glass: Mesh) -> None:
    edges = np.sort(glass.indices[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    _, counts = np.unique(edges, axis=0, return_counts=True)
    assert (counts == 2).all()


def test_facets_of_the_glass_face_outward(glass: Mesh) -> None:
    areas, middles = find_facets(glass)
    assert np.einsum("ij,ij->", areas, middles - TABLE.glass.place) > 0.0


def test_normals_of_the_glass_agree_with_its_facets(glass: Mesh) -> None:
    areas, _ = find_facets(glass)
    unit = areas / np.linalg.norm(areas, axis=1, keepdims=True)
    for corner in range(3):
        # A facet of the finest arc turns by 15°; its corners lean half of that away from it.
        assert (np.sum(unit * glass.normals[glass.indices[:, corner]], axis=1) > np.cos(np.radians(12.0))).all()


def test_glass_stands_on_the_table_without_touching_it(glass: Mesh) -> None:
    assert 0.0 < glass.positions[:, 1].min() - TABLE.table.high[1] < 0.002


@pytest.mark.parametrize("name", RECEIVERS)
def test_every_receiver_holds_photons(photons: pl.PhotonMap, name: str) -> None:
    assert np.count_nonzero(photons.object == RECEIVERS[name]) > 300


@pytest.mark.parametrize("normal", [(0, 1, 0), (0, -1, 0), (0, 0, 1)])
def test_shelf_is_lit_from_above_from_below_and_on_its_edge(photons: pl.PhotonMap, normal: tuple[int, ...]) -> None:
    on_side = photons.normals[photons.object == RECEIVERS["shelf"]] @ np.array(normal) > 0.9
    assert np.count_nonzero(on_side) > 20


def test_caustic_reaches_the_tables_edge(photons: pl.PhotonMap) -> None:
    on_table = photons.positions[photons.object == RECEIVERS["table"]]
    assert np.count_nonzero(on_table[:, 0] > EDGE - NEAR_EDGE) > 300


def test_caustic_goes_on_on_the_floor_beyond_the_edge(photons: pl.PhotonMap) -> None:
    on_floor = photons.positions[photons.object == RECEIVERS["floor"]]
    assert np.count_nonzero((on_floor[:, 0] > EDGE) & (np.abs(on_floor[:, 2] + 0.1) < 0.1)) > 3_000
