# SPDX-License-Identifier: Apache-2.0
"""The loupe finds exactly the photons of brute force in every space, and describes its center truly."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import photonloupe as pl
import relax_maps
from conftest import make_columns
from inspect_twins import measure_spread
from layer_search import (
    Cloud,
    find_constrained_neighbors,
    find_layer,
    find_parameter_neighbors,
    keep_only,
    make_cloud,
    square_world,
    take_nearest,
)

K = 40
BETA = 3.0
POINTS = np.array([[0.2, 0.0, 0.3], [0.71, 0.01, 0.5], [2.0, 1.0, -1.0]], dtype=np.float32)
SOME = (2, 7, 50, 999)  # the photon 50 is unset
RANGES = {"p3": (0.2, 0.6), "p4": (0.9, 0.2)}  # over the seam


@cache
def get_cloud() -> Cloud:
    return make_cloud(np.random.default_rng(1).random((1_500, 2)), periodic=1)


def trim(found: tuple[np.ndarray, np.ndarray]) -> list[int]:
    return found[0][found[0] >= 0].tolist()


def find_nearest(cloud: Cloud, point: np.ndarray) -> int:
    return int(take_nearest(square_world(cloud, point), 1)[0][0])


@pytest.mark.parametrize("point", POINTS)
def test_around_a_point_are_its_nearest_photons(point: np.ndarray) -> None:
    cloud = get_cloud()
    view = pl.inspect.loupe(cloud.photons, point, K)
    ids, distances = take_nearest(square_world(cloud, point), K)
    assert view.ids.tolist() == ids.tolist()
    np.testing.assert_allclose(view.distances, distances, rtol=2e-7)
    assert view.center == ids[0]
    np.testing.assert_array_equal(view.positions, cloud.positions[ids])
    assert view.radius == pytest.approx(distances[-1], rel=1e-6)


@pytest.mark.parametrize("photon", SOME)
def test_around_a_photon_are_others_in_every_space(photon: int) -> None:
    cloud = get_cloud()
    square = square_world(cloud, cloud.positions[photon])
    square[photon] = np.inf
    for space, expected in (
        ("world", take_nearest(square, K)),
        ("parameter", find_parameter_neighbors(cloud, photon, K)),
        ("constrained", find_constrained_neighbors(cloud, photon, K, BETA)),
    ):
        view = pl.inspect.loupe(cloud.photons, photon, K, space, BETA)
        assert view.ids.tolist() == trim(expected), space
        assert view.center == photon


@pytest.mark.parametrize("point", POINTS)
def test_in_parameter_space_a_point_stands_for_its_nearest_photon(point: np.ndarray) -> None:
    cloud = get_cloud()
    center = find_nearest(cloud, point)
    view = pl.inspect.loupe(cloud.photons, point, K, "parameter")
    assert (view.center, view.ids.tolist()) == (center, trim(find_parameter_neighbors(cloud, center, K)))


@pytest.mark.parametrize("point", POINTS)
@pytest.mark.parametrize("pinned", [None, *SOME])
def test_the_layer_is_the_centers_or_the_pinned_photons(point: np.ndarray, pinned: int | None) -> None:
    cloud = get_cloud()
    layer = find_layer(cloud, find_nearest(cloud, point) if pinned is None else pinned, K, BETA)
    view = pl.inspect.loupe(cloud.photons, point, K, "constrained", BETA, center=pinned)
    assert view.ids.tolist() == trim(take_nearest(keep_only(square_world(cloud, point), layer), K))
    assert view.center == find_nearest(cloud, point)


@pytest.mark.parametrize("point", POINTS)
def test_ranges_lock_the_layer(point: np.ndarray) -> None:
    cloud = get_cloud()
    first, second = cloud.values.T
    inside = cloud.is_set & (first >= 0.2) & (first <= 0.6) & ((second >= 0.9) | (second <= 0.2))
    view = pl.inspect.loupe(cloud.photons, point, K, "constrained", ranges=RANGES)
    assert view.ids.tolist() == trim(take_nearest(keep_only(square_world(cloud, point), inside), K))
    assert len(view.ids) == K


@pytest.mark.parametrize("space", ["world", "parameter", "constrained"])
def test_changed_parameters_change_what_is_found(space: str) -> None:
    cloud = make_cloud(np.random.default_rng(2).random((400, 1)))
    before = pl.inspect.loupe(cloud.photons, 7, 20, space, 1.0).ids.tolist()
    cloud.photons.set_parameters(np.random.default_rng(3).random(400))
    after = pl.inspect.loupe(cloud.photons, 7, 20, space, 1.0).ids.tolist()
    assert (before == after) == (space == "world")
    assert after == cloud.photons.neighbors([7], 20, space=space, beta=1.0)[0][0].tolist()


def test_a_normal_keeps_the_center_on_its_side() -> None:
    places = [[0, 0, 0], [0, 0.01, 0], [0, 0.02, 0]]
    normals = [[0, 1, 0], [1, 0, 0], [0, 1, 0]]
    photons = pl.PhotonMap.from_arrays(positions=places, normals=normals, power=np.ones((3, 3)))
    point = [0.0, 0.011, 0.0]
    assert pl.inspect.loupe(photons, point, 3).center == 1
    assert pl.inspect.loupe(photons, point, 3, normal=(0, 2, 0)).center == 2
    assert pl.inspect.loupe(photons, point, 3, normal=(0, -1, 0)).center == 1  # no side: the nearest


@pytest.mark.parametrize("seed", range(4))
def test_the_spread_is_numpys(seed: int) -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(400, seed=seed))
    view = pl.inspect.loupe(photons, photons.positions[seed], 60)
    assert view.center is not None
    values, vectors = measure_spread(view.positions, photons.normals[view.center])
    np.testing.assert_allclose(view.eigenvalues, values, rtol=1e-4)
    np.testing.assert_allclose(np.abs(np.sum(view.eigenvectors * vectors, axis=1)), 1.0, atol=1e-4)
    assert view.isotropy == pytest.approx(np.sqrt(values[1] / values[0]), rel=1e-4)
    assert not view.has_constraint
    np.testing.assert_array_equal(view.basis, view.eigenvectors)
    assert view.freedom == (1.0, 1.0)
    assert len(view.ellipse_axes) == len(view.ellipse_half_axes) == 0


def test_a_relaxed_map_shows_its_constraint_and_drift() -> None:
    relaxed = relax_maps.build().relax(steps=3, descriptor="pca")
    view = pl.inspect.loupe(relaxed, 17, 30)
    assert view.has_constraint
    np.testing.assert_array_equal(view.basis, relaxed.constraint_basis[17])
    np.testing.assert_allclose(view.freedom, 1.0 - relaxed.constraint_weights[17], rtol=1e-6)
    bases = relaxed.constraint_basis[view.ids]
    np.testing.assert_array_equal(view.ellipse_axes, bases)
    along = np.abs(np.einsum("ia,ija->ij", relaxed.drift[view.ids].astype(np.float64), bases))
    np.testing.assert_allclose(view.ellipse_half_axes, along, atol=1e-8)
    assert view.ellipse_half_axes.max() > 0.0
    numbers = view.numbers
    assert numbers.drift == pytest.approx(np.linalg.norm(relaxed.drift[17]), rel=1e-6)
    assert (numbers.pressure, numbers.one_sidedness) == (relaxed.pressure[17], relaxed.one_sidedness[17])


def test_numbers_are_those_of_the_columns(ring_map: pl.PhotonMap) -> None:
    photons = ring_map.select(np.arange(0, len(ring_map), 50))
    photons.set_parameters(photons.positions[:, [0, 2]], ["east", "south"])
    view = pl.inspect.loupe(photons, 100, 20, paths=3)
    numbers = view.numbers
    np.testing.assert_array_equal(numbers.position.astype(np.float32), photons.positions[100])
    np.testing.assert_array_equal(numbers.power, photons.power[100])
    assert numbers.parameters == {"east": photons.parameters[100, 0], "south": photons.parameters[100, 1]}
    for name in ("signature", "tortuosity", "path_length"):
        assert getattr(numbers, name) == pytest.approx(pl.inspect.column(photons, name).values[100], rel=1e-6)
    first, last = photons.path_offsets[100], photons.path_offsets[101]
    letters = {1: "R", 2: "T"}
    assert numbers.interactions == "".join(letters[i] for i in photons.path_interactions[first + 1 : last - 1].tolist())
    assert [line.photon for line in view.paths] == view.ids[:3].tolist()
    for line in view.paths:
        rows = slice(photons.path_offsets[line.photon], photons.path_offsets[line.photon + 1])
        np.testing.assert_array_equal(line.vertices, photons.path_vertices[rows])
        np.testing.assert_array_equal(line.interactions, photons.path_interactions[rows])


def test_colors_are_the_scripts(ring_map: pl.PhotonMap) -> None:
    photons = ring_map.select(np.arange(100))
    assert pl.inspect.loupe(photons, 3, 5).colors is None
    photons.run_script("for (i = 0; i < getNumPhotons(); i++) setPhotonColorEncoding(i, i / 100, 0.5, 0);")
    view = pl.inspect.loupe(photons, 3, 5)
    np.testing.assert_array_equal(view.colors, photons.colors[view.ids])


@pytest.mark.parametrize("count", [0, 1, 2])
def test_few_photons_are_all_found(count: int) -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(count))
    view = pl.inspect.loupe(photons, (0, 0, 0), 250)
    assert sorted(view.ids.tolist()) == list(range(count))
    assert (view.center is None) == (count == 0)
    assert np.isfinite(view.isotropy) == (count == 2)


def test_photons_in_one_place_have_no_direction() -> None:
    columns = make_columns(100)
    columns["positions"] = np.tile(np.float32([0.1, 0.2, 0.3]), (100, 1))
    view = pl.inspect.loupe(pl.PhotonMap.from_arrays(**columns), (0, 0, 0), 30)
    assert view.ids.tolist() == list(range(30))
    assert np.isnan(view.isotropy)
    assert view.eigenvalues == (0.0, 0.0)


@pytest.mark.parametrize("scale", [2.0**-20, 2.0**20])
def test_a_scaled_map_looks_the_same(scale: float) -> None:
    columns = make_columns(300, seed=5)
    here = pl.inspect.loupe(pl.PhotonMap.from_arrays(**columns), 10, 50)
    columns["positions"] *= np.float32(scale)
    columns["path_vertices"] *= np.float32(scale)
    there = pl.inspect.loupe(pl.PhotonMap.from_arrays(**columns), 10, 50)
    assert there.ids.tolist() == here.ids.tolist()
    assert there.isotropy == here.isotropy
    assert there.eigenvalues[0] == here.eigenvalues[0] * scale * scale
    assert there.numbers.tortuosity == here.numbers.tortuosity


def test_photons_without_parameters_have_no_neighbors_there() -> None:
    photons = make_cloud(np.random.default_rng(1).random((200, 1))).photons
    view = pl.inspect.loupe(photons, 0, 20, "parameter")
    assert len(view.ids) == 0
    assert np.isnan(view.numbers.parameters["p3"])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"point": (0, 0)}, r"point must be three numbers"),
        ({"point": (0, np.nan, 0)}, "point"),
        ({"point": 1_500}, "point"),
        ({"point": -1}, "point"),
        ({"point": 0, "k": 0}, "k"),
        ({"point": 0, "k": 1001}, "k"),
        ({"point": 0, "space": "here"}, "space"),
        ({"point": 0, "center": 1}, "center and ranges lock"),
        ({"point": 0, "space": "constrained", "center": 1}, "layers of their own"),
        ({"point": (0, 0, 0), "space": "constrained", "center": 1_500}, "center"),
        ({"point": (0, 0, 0), "space": "constrained", "center": 1, "ranges": RANGES}, "give one of them"),
        ({"point": (0, 0, 0), "space": "constrained", "ranges": {"phi": (0, 1)}}, "ranges names 'phi'"),
        ({"point": (0, 0, 0), "space": "constrained", "beta": -1.0}, "beta"),
        ({"point": (0, 0, 0), "normal": (0, 0, 0)}, "normal is zero"),
        ({"point": 0, "paths": 3}, "no paths"),
    ],
)
def test_wrong_questions_are_refused_by_name(arguments: dict, words: str) -> None:
    with pytest.raises(pl.ArgumentError, match=words):
        pl.inspect.loupe(get_cloud().photons, **arguments)


def test_spaces_need_parameters() -> None:
    with pytest.raises(pl.ArgumentError, match="needs parameters"):
        pl.inspect.loupe(pl.PhotonMap.from_arrays(**make_columns(5)), 0, space="parameter")
