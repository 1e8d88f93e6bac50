# SPDX-License-Identifier: Apache-2.0
"""Neighbors in parameter space and in layers are exactly those of brute force, ties by id, padded, over seams."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from layer_search import (
    Cloud,
    find_constrained_neighbors,
    find_layer,
    find_parameter_neighbors,
    keep_only,
    make_cloud,
    square_parameters,
    square_world,
    take_nearest,
)

COUNT = 2_000
# The program is asked of these photons, many enough that it measures the layers of all; brute force of every fifth.
ASKED = np.arange(0, COUNT, 7)
CHECKED = 5
WIDTHS = (1, 2, 3, 5, 13)
KS = (1, 7, 50, 400)
BETAS = (0.0, 1.0, 3.0, 1e6)


@cache
def get_cloud(width: int) -> Cloud:
    """Photons of two emitters with random parameters, the last of which is periodic."""
    return make_cloud(np.random.default_rng(width).random((COUNT, width)), periodic=1)


@cache
def get_signatures() -> Cloud:
    """A parameter of three values, as a signature is: a third of the photons ties with every photon."""
    return make_cloud(np.random.default_rng(4).choice([1.0, 2.0, 5.0], (COUNT, 1)))


def check_parameter_neighbors(cloud: Cloud, k: int) -> None:
    ids, distances = cloud.photons.neighbors(ASKED, k, space="parameter")
    for row in range(0, len(ASKED), CHECKED):
        expected_ids, expected = find_parameter_neighbors(cloud, int(ASKED[row]), k)
        np.testing.assert_array_equal(ids[row], expected_ids, err_msg=f"photon {ASKED[row]}")
        np.testing.assert_allclose(distances[row], expected, rtol=2e-7, err_msg=f"photon {ASKED[row]}")


def check_constrained_neighbors(cloud: Cloud, k: int, beta: float) -> None:
    ids, distances = cloud.photons.neighbors(ASKED, k, space="constrained", beta=beta)
    for row in range(0, len(ASKED), CHECKED):
        expected_ids, expected = find_constrained_neighbors(cloud, int(ASKED[row]), k, beta)
        np.testing.assert_array_equal(ids[row], expected_ids, err_msg=f"photon {ASKED[row]}")
        np.testing.assert_allclose(distances[row], expected, rtol=2e-7, err_msg=f"photon {ASKED[row]}")


# Parameter space


@pytest.mark.parametrize("width", WIDTHS)
def test_parameter_neighbors_equal_brute_force_in_every_dimension(width: int) -> None:
    check_parameter_neighbors(get_cloud(width), 50)


@pytest.mark.parametrize("k", KS)
def test_parameter_neighbors_equal_brute_force_for_every_k(k: int) -> None:
    check_parameter_neighbors(get_cloud(2), k)


@pytest.mark.parametrize("k", KS)
def test_parameter_neighbors_that_tie_come_by_id(k: int) -> None:
    check_parameter_neighbors(get_signatures(), k)


def test_parameter_neighbors_lie_on_both_sides_of_the_seam() -> None:
    cloud = get_cloud(1)
    at_seam = np.flatnonzero(cloud.values[:, 0] > 0.999)
    ids, _ = cloud.photons.neighbors(at_seam, 10, space="parameter")
    values = cloud.values[ids, 0]
    assert (values < 0.1).any()
    assert (values > 0.9).any()


@pytest.mark.parametrize("width", [1, 3])
def test_parameter_neighbors_of_values_equal_brute_force(width: int) -> None:
    cloud = get_cloud(width)
    values = np.random.default_rng(5).random((100, width)).astype(np.float32)
    ids, _ = cloud.photons.neighbors(values.astype(np.float64), 20, space="parameter")
    for row, value in enumerate(values):
        expected, _ = take_nearest(keep_only(square_parameters(cloud, value), cloud.is_set), 20)
        np.testing.assert_array_equal(ids[row], expected)


def test_values_find_photons_of_every_emitter() -> None:
    cloud = get_cloud(1)
    ids, _ = cloud.photons.neighbors([[0.5]], 50, space="parameter")
    assert set(cloud.emitter[ids[0]]) == {0, 1}


def test_unset_photon_has_no_parameter_neighbors() -> None:
    cloud = get_cloud(2)
    ids, distances = cloud.photons.neighbors(np.flatnonzero(~cloud.is_set), 7, space="parameter")
    assert (ids == -1).all()
    assert np.isposinf(distances).all()


def test_fewer_photons_than_asked_for_are_padded_in_parameter_space() -> None:
    cloud = make_cloud(np.random.default_rng(6).random((60, 2)))
    ids, distances = cloud.photons.neighbors(np.arange(60), 50, space="parameter")
    for i in range(60):
        expected_ids, expected = find_parameter_neighbors(cloud, i, 50)
        assert expected_ids[-1] == -1
        np.testing.assert_array_equal(ids[i], expected_ids)
        np.testing.assert_allclose(distances[i], expected, rtol=2e-7)


def test_few_ids_find_what_all_ids_find() -> None:
    photons = get_cloud(2).photons
    every = photons.neighbors(np.arange(COUNT), 50, space="parameter")[0]
    np.testing.assert_array_equal(photons.neighbors([COUNT - 1, 7], 50, space="parameter")[0], every[[COUNT - 1, 7]])


# Layers


@pytest.mark.parametrize("width", WIDTHS)
def test_constrained_neighbors_equal_brute_force_in_every_dimension(width: int) -> None:
    check_constrained_neighbors(get_cloud(width), 50, 1.0)


@pytest.mark.parametrize("beta", BETAS)
@pytest.mark.parametrize("k", KS)
def test_constrained_neighbors_equal_brute_force_for_every_k_and_beta(k: int, beta: float) -> None:
    check_constrained_neighbors(get_cloud(2), k, beta)


@pytest.mark.parametrize("beta", BETAS)
@pytest.mark.parametrize("k", [7, 400])
def test_constrained_neighbors_among_ties_equal_brute_force(k: int, beta: float) -> None:
    check_constrained_neighbors(get_signatures(), k, beta)


def test_layer_of_a_parameter_with_few_values_is_its_own_value() -> None:
    cloud = get_signatures()
    ids, _ = cloud.photons.neighbors([2], 50, space="constrained")
    assert set(cloud.values[ids[0], 0]) == {cloud.values[2, 0]}


def test_layers_of_two_emitters_do_not_mix() -> None:
    cloud = get_cloud(2)
    ids, _ = cloud.photons.neighbors(np.arange(COUNT), 7, space="constrained")
    found = np.where(ids >= 0, cloud.emitter[ids], cloud.emitter[:, None])
    assert (found == cloud.emitter[:, None]).all()


def test_unset_photons_are_a_layer_of_their_own() -> None:
    cloud = get_cloud(2)
    unset = np.flatnonzero(~cloud.is_set)
    ids, _ = cloud.photons.neighbors(unset, 7, space="constrained")
    for row, i in enumerate(unset):
        np.testing.assert_array_equal(ids[row], find_constrained_neighbors(cloud, int(i), 7, 3.0)[0])
    assert not cloud.is_set[ids].any()


def test_few_ids_have_the_layers_that_all_ids_have() -> None:
    photons = get_cloud(3).photons
    every = photons.neighbors(np.arange(COUNT), 50, space="constrained")[0]
    np.testing.assert_array_equal(photons.neighbors([3, 1_999], 50, space="constrained")[0], every[[3, 1_999]])


@pytest.fixture(scope="module")
def caustic(ring: pl.Scene) -> pl.PhotonMap:
    """Photons of a caustic, crowded along its fold, whose parameters are their places."""
    photons = pl.trace_photons(ring, 12_000, seed=7, emission="random", max_bounces=1)
    photons.set_parameters(photons.positions[:, ::2])
    return photons


@pytest.mark.parametrize("k", [6, 20, 50])
def test_layer_of_reach_one_is_the_nearest_in_parameter_space(caustic: pl.PhotonMap, k: int) -> None:
    every = np.arange(len(caustic))
    layer = caustic.neighbors(every, k, space="constrained", beta=1.0)[0]
    np.testing.assert_array_equal(np.sort(layer), np.sort(caustic.neighbors(every, k, space="parameter")[0]))


# Layers that are held while the point moves

POINTS = np.random.default_rng(8).integers(0, 2**10, (40, 3)) / 2.0**10


@pytest.mark.parametrize("center", [7, 50, 51])
@pytest.mark.parametrize("beta", [0.0, 1.0, 3.0])
def test_layer_about_a_photon_is_found_from_any_point(center: int, beta: float) -> None:
    cloud = get_cloud(2)
    ids, _ = cloud.photons.neighbors(POINTS, 20, space="constrained", center=center, beta=beta)
    layer = find_layer(cloud, center, 20, beta)
    for row, point in enumerate(POINTS.astype(np.float32)):
        expected, _ = take_nearest(keep_only(square_world(cloud, point), layer), 20)
        np.testing.assert_array_equal(ids[row], expected)


@pytest.mark.parametrize(
    ("ranges", "bounds"),
    [
        ({"p3": (0.2, 0.3)}, ((0.2, 0.3), (-9.0, 9.0))),
        ({3: (0.2, 0.6), 4: (0.5, 0.9)}, ((0.2, 0.6), (0.5, 0.9))),
        ({"p3": (0.0, 1.0), 4: (0.9, 0.1)}, ((0.0, 1.0), (0.9, 0.1))),
        ({}, ((-9.0, 9.0), (-9.0, 9.0))),
        ({3: (0.4, 0.4)}, ((0.4, 0.4), (-9.0, 9.0))),
    ],
    ids=["one", "both", "over the seam", "all", "none"],
)
def test_layer_by_ranges_is_found_from_any_point(ranges: dict[Any, Any], bounds: Any) -> None:
    cloud = get_cloud(2)
    ids, _ = cloud.photons.neighbors(POINTS, 20, space="constrained", ranges=ranges)
    layer = cloud.is_set.copy()
    for dimension, (low, high) in enumerate(np.array(bounds, dtype=np.float32)):
        values = cloud.values[:, dimension]
        layer &= (values >= low) & (values <= high) if low <= high else (values >= low) | (values <= high)
    for row, point in enumerate(POINTS.astype(np.float32)):
        expected, _ = take_nearest(keep_only(square_world(cloud, point), layer), 20)
        np.testing.assert_array_equal(ids[row], expected)


# Refusals


@pytest.mark.parametrize(
    ("points", "keywords", "message"),
    [
        ([[0.0, 0.0, 0.0]], {"space": "path"}, "space must be one of world, parameter, constrained"),
        ([[0.0, 0.0, 0.0]], {"space": "parameter"}, r"points must have shape \(n, 2\)"),
        ([[0.0, np.nan]], {"space": "parameter"}, r"points\[0\]\[1\] is NaN"),
        ([COUNT], {"space": "parameter"}, r"ids\[0\] = 2000 is not a photon"),
        ([[0.0, 0.0, 0.0]], {"space": "constrained"}, "need either center= or ranges="),
        ([[0.0, 0.0, 0.0]], {"space": "constrained", "center": 1, "ranges": {}}, "need either center= or ranges="),
        ([[0.0, 0.0, 0.0]], {"space": "constrained", "center": COUNT}, "center must be from 0 to 1999"),
        ([[0.0, 0.0, 0.0]], {"space": "world", "center": 1}, "center and ranges lock the layer"),
        ([1], {"space": "constrained", "center": 1}, "photons have layers of their own"),
        ([1], {"space": "constrained", "ranges": {}}, "photons have layers of their own"),
        ([1], {"space": "constrained", "beta": -1.0}, "beta must be from 0"),
        ([1], {"space": "constrained", "beta": np.nan}, "beta must be from 0"),
        ([[0.0, 0.0, 0.0]], {"space": "constrained", "ranges": {"z": (0, 1)}}, "ranges names 'z'.*p3, p4"),
        ([[0.0, 0.0, 0.0]], {"space": "constrained", "ranges": {2: (0, 1)}}, "ranges names 2.*3 to 4"),
        ([[0.0, 0.0, 0.0]], {"space": "constrained", "ranges": {3: (1, 0)}}, "only a periodic parameter"),
        ([[0.0, 0.0, 0.0]], {"space": "constrained", "ranges": {3: (0, np.inf)}}, r"ranges\[3\] must be"),
        ([[0.0, 0.0, 0.0]], {"space": "constrained", "ranges": {3: (0, 1, 2)}}, r"must be \(low, high\)"),
    ],
)
def test_query_that_does_not_fit_is_refused(points: Any, keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        get_cloud(2).photons.neighbors(points, 5, **keywords)


@pytest.mark.parametrize("k", [0, 1001])
@pytest.mark.parametrize("space", ["parameter", "constrained"])
def test_k_out_of_range_is_refused_in_every_space(space: str, k: int) -> None:
    with pytest.raises(pl.ArgumentError, match="k must be from 1 to 1000"):
        get_cloud(2).photons.neighbors([1], k, space=space)


@pytest.mark.parametrize("space", ["parameter", "constrained"])
def test_map_without_parameters_is_refused(space: str) -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.zeros((1, 3)), normals=[[0, 1, 0]], power=np.ones((1, 3)))
    with pytest.raises(pl.ArgumentError, match=rf'space="{space}" needs parameters'):
        photons.neighbors([0], 1, space=space)
