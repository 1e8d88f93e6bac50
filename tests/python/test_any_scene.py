# SPDX-License-Identifier: Apache-2.0
"""Irradiance is the naive twin's whatever receivers lie near each other, and wherever it is asked."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import photonloupe as pl
from any_surfaces import FAR, KINDS, QUESTIONS, UP, ask_at_edges, ask_between_surfaces, ask_on_surfaces, build_map
from conftest import find_scene
from photonloupe.settings import list_settings
from raised_scenes import HEIGHTS, SLAB_HEIGHTS, WALL_X, WINDOWS, raise_receivers
from surface_twin import check_irradiance, estimate_irradiance

SMALL, LARGE = 5_000, 50_000
KERNELS = list_settings("irradiance")["kernel"].choices
K = 50
# Along the axes the k of a query are the same photons in 32 bits as in 64; far away rounding chooses among them.
ROUNDED = ("far away",)
# Kinds in which many photons tie, or whose tree has much to leave out.
HARD = ("stairs", "two-sided sheet", "wide floor", "noise normals")


@cache
def get_map(name: str, count: int = SMALL) -> pl.PhotonMap:
    return build_map(name, count)


@pytest.fixture(scope="module")
def raised(tmp_path_factory: pytest.TempPathFactory) -> dict[str, pl.Scene]:
    return {name: raise_receivers(name, tmp_path_factory.mktemp(name)) for name in WINDOWS}


@cache
def trace(scene: pl.Scene, count: int, store: str) -> pl.PhotonMap:
    photons = pl.trace_photons(scene, count, seed=3, store=store)
    return photons.select(np.arange(min(count, len(photons))))


def check_question(photons: pl.PhotonMap, name: str, question: str, k: int = K, kernel: str = "epanechnikov") -> None:
    exact = KINDS[name].along_axes and question not in ROUNDED
    check_irradiance(photons, *QUESTIONS[question](photons, 40), k, kernel, exact=exact)


# Made maps


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("name", KINDS)
def test_irradiance_of_a_made_map_is_the_twins(name: str, question: str) -> None:
    check_question(get_map(name), name, question)


@pytest.mark.parametrize("kernel", KERNELS)
@pytest.mark.parametrize("k", [1, 50, 362])
@pytest.mark.parametrize("name", HARD)
def test_irradiance_is_the_twins_for_every_kernel_and_k(name: str, k: int, kernel: str) -> None:
    check_question(get_map(name), name, "on the surfaces", k, kernel)


@pytest.mark.parametrize("kernel", KERNELS)
def test_irradiance_between_surfaces_is_the_twins_for_every_kernel(kernel: str) -> None:
    check_question(get_map("stairs"), "stairs", "between the surfaces", 362, kernel)


@pytest.mark.parametrize("question", ["on the surfaces", "between the surfaces"])
@pytest.mark.parametrize("name", ["stairs", "corner", "stacked planes", "two-sided sheet", "wide floor", "sphere"])
def test_irradiance_of_many_photons_is_the_twins(name: str, question: str) -> None:
    check_question(get_map(name, LARGE), name, question)


@pytest.mark.parametrize("name", KINDS)
def test_fewer_photons_than_asked_for_are_all_used(name: str) -> None:
    photons = build_map(name, 20)
    few = photons.select(np.arange(min(3, len(photons))))
    check_irradiance(few, *ask_between_surfaces(few, 8), K, exact=False)


def test_a_photon_among_ten_thousand_that_face_away_is_found() -> None:
    places = np.random.default_rng(0).random((10_001, 3)) * (1.0, 0.0, 1.0)
    normals = np.tile(-UP, (10_001, 1))
    normals[7] = UP
    photons = pl.PhotonMap.from_arrays(positions=places, normals=normals, power=np.ones((10_001, 3)))
    point = [[0.5, 0.0, 0.5]]
    assert estimate_irradiance(photons, point, UP, K, "disc").flat[0, 0] > 0.0
    check_irradiance(photons, point, UP, K, "gaussian")


def test_ties_in_measure_are_broken_by_distance() -> None:
    # 0.2 m above a floor 1 m wide every photon within 2 m has the same measure.
    places = np.random.default_rng(1).random((SMALL, 3)) * (1.0, 0.0, 1.0)
    photons = pl.PhotonMap.from_arrays(
        positions=places, normals=np.tile(UP, (SMALL, 1)), power=np.random.default_rng(2).random((SMALL, 3))
    )
    points = np.array([[0.2, 0.2, 0.2], [0.5, 0.2, 0.5], [0.9, 0.2, 0.4]])
    for kernel in KERNELS:
        check_irradiance(photons, points, UP, K, kernel)


def test_a_second_surface_changes_nothing_on_the_first() -> None:
    floor = get_map("two-sided sheet")
    columns = {name: getattr(floor, name) for name in ("positions", "normals", "power")}
    above = {**columns, "positions": columns["positions"] + np.float32([0.0, 0.3, 0.0])}
    both = pl.PhotonMap.from_arrays(**{name: np.concatenate([columns[name], above[name]]) for name in columns})
    points, normals = ask_on_surfaces(floor, 100)
    upward = normals[:, 1] > 0.0
    np.testing.assert_allclose(
        both.irradiance(points[upward], UP, k=K), floor.irradiance(points[upward], UP, k=K), rtol=1e-5
    )


# Scenes


@pytest.mark.parametrize("question", QUESTIONS)
@pytest.mark.parametrize("store", ["caustic", "all"])
@pytest.mark.parametrize("name", WINDOWS)
def test_irradiance_of_a_raised_scene_is_the_twins(
    raised: dict[str, pl.Scene], name: str, store: str, question: str
) -> None:
    photons = trace(raised[name], SMALL, store)
    check_irradiance(photons, *QUESTIONS[question](photons, 40), K, exact=False)


@pytest.mark.parametrize("k", [1, 362])
@pytest.mark.parametrize("name", WINDOWS)
def test_irradiance_of_a_raised_scene_is_the_twins_for_every_k(raised: dict[str, pl.Scene], name: str, k: int) -> None:
    photons = trace(raised[name], SMALL, "all")
    check_irradiance(photons, *ask_on_surfaces(photons, 40), k, exact=False)


@pytest.mark.parametrize("name", ["ring", "prism"])
def test_irradiance_of_many_photons_of_a_raised_scene_is_the_twins(raised: dict[str, pl.Scene], name: str) -> None:
    photons = trace(raised[name], LARGE, "caustic")
    check_irradiance(photons, *ask_on_surfaces(photons, 40), K, exact=False)


@pytest.mark.parametrize("name", WINDOWS)
def test_irradiance_where_no_photon_is_near_is_the_twins(raised: dict[str, pl.Scene], name: str) -> None:
    # A grid over everything, half of it in shadow, on the floor, at the squares and at the wall.
    photons, half = trace(raised[name], SMALL, "caustic"), WINDOWS[name]
    steps = np.linspace(-2.0 * half, 2.0 * half, 7)
    x, z = np.meshgrid(steps, steps)
    for height in (0.0, *(SLAB_HEIGHTS if name == "slab" else HEIGHTS)):
        points = np.stack([x.ravel(), np.full(x.size, height), z.ravel()], axis=1)
        check_irradiance(photons, points, UP, K, exact=False)
    wall = np.stack([np.full(x.size, WALL_X * half), np.abs(x).ravel(), z.ravel()], axis=1)
    check_irradiance(photons, wall, (-1.0, 0.0, 0.0), K, exact=False)


@pytest.mark.parametrize("name", WINDOWS)
def test_every_receiver_of_a_raised_scene_is_lit(raised: dict[str, pl.Scene], name: str) -> None:
    photons = trace(raised[name], SMALL, "all")
    assert len(np.unique(photons.object)) == 4


def test_irradiance_of_the_table_is_the_twins_everywhere() -> None:
    photons = trace(pl.load_scene(find_scene("table")), LARGE, "caustic")
    for ask in (ask_on_surfaces, ask_between_surfaces, ask_at_edges):
        check_irradiance(photons, *ask(photons, 60), K, exact=False)


def test_a_query_far_away_does_not_touch_its_neighbors_answer() -> None:
    photons = get_map("corner")
    points, normals = ask_on_surfaces(photons, 64)
    alone = photons.irradiance(points, normals, k=K)
    points[1::2] *= FAR
    np.testing.assert_allclose(photons.irradiance(points, normals, k=K)[::2], alone[::2], rtol=1e-5)
