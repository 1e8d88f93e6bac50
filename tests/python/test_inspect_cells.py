# SPDX-License-Identifier: Apache-2.0
"""Pictures of cells: each pixel's photon or node is the one of brute force, on every scene's surfaces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from conftest import find_scene, make_columns
from inspect_twins import descend, square_radii

SIZE = {"width": 60, "height": 44}
# Of squared distances of about 1 m², added in another order.
ROUNDING = 1e-5
EVERY = 7


def trace(name: str, store: str = "indirect") -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene(name)), 3_000, seed=1, store=store)


def find_worst(
    photons: pl.PhotonMap, cells: pl.inspect.CellView, view: pl.inspect.SurfaceView, flatness: float
) -> float:
    """How much farther than the nearest photon the cell's is, relative, at worst."""
    worst = 0.0
    for pixel in range(0, cells.ids.size, EVERY):
        at = np.unravel_index(pixel, cells.ids.shape)
        square = square_radii(photons, view.points[at], view.normals[at], flatness)
        if np.isfinite(view.depth[at]) and np.isfinite(square.min()):
            assert cells.ids[at] >= 0, at
            worst = max(worst, square[cells.ids[at]] / square.min() - 1.0)
        else:
            assert cells.ids[at] == -1, at
    return worst


@pytest.mark.parametrize("same_surface", [True, False])
@pytest.mark.parametrize(("scene", "camera"), [("ring", "top"), ("ring", "view"), ("bowl", None), ("prism", None)])
def test_voronoi_cells_are_those_of_brute_force(scene: str, camera: str | None, same_surface: bool) -> None:
    photons = trace(scene)
    cells = pl.inspect.voronoi(photons, None, camera, **SIZE, same_surface=same_surface)
    view = pl.inspect.surfaces(photons.find_surface(), camera, **SIZE)
    np.testing.assert_array_equal(cells.depth, view.depth)
    assert find_worst(photons, cells, view, 0.1 if same_surface else 0.0) <= ROUNDING
    assert len(np.unique(cells.ids)) > 20


def test_cells_under_glass_are_seen_when_asked_for() -> None:
    photons = trace("slab")
    scene = photons.find_surface()
    onto, through = (pl.inspect.surfaces(scene, None, **SIZE, through_glass=flag) for flag in (False, True))
    assert np.nanmax(onto.points[..., 1]) > np.nanmax(through.points[..., 1])
    cells = pl.inspect.voronoi(photons, scene, None, **SIZE, through_glass=True)
    assert find_worst(photons, cells, through, 0.1) <= ROUNDING
    assert len(np.unique(cells.ids)) > 20


def test_borders_are_where_the_next_pixel_is_anothers() -> None:
    cells = pl.inspect.voronoi(trace("ring"), None, "top", **SIZE)
    expected = np.zeros_like(cells.borders)
    expected[:, :-1] |= cells.ids[:, :-1] != cells.ids[:, 1:]
    expected[:-1] |= cells.ids[:-1] != cells.ids[1:]
    np.testing.assert_array_equal(cells.borders, expected)


@pytest.mark.parametrize("depth", [None, 0, 1, 5, 40])
def test_kd_cells_are_those_of_the_tree(depth: int | None) -> None:
    photons = trace("ring")
    cells = pl.inspect.kd_tree(photons, None, "view", **SIZE, depth=depth)
    view = pl.inspect.surfaces(photons.find_surface(), "view", **SIZE)
    tree = photons.tree
    for pixel in range(0, cells.ids.size, EVERY):
        at = np.unravel_index(pixel, cells.ids.shape)
        is_seen = np.isfinite(view.depth[at])
        assert cells.ids[at] == (descend(tree, view.points[at], depth) if is_seen else -1), at
    assert sum(box.photon_count for box in cells.boxes) == len(photons)
    for box in cells.boxes:
        np.testing.assert_array_equal(box.box.ravel(), tree["box"][box.node])
        assert box.photon_count == tree["count"][box.node]


def test_cells_wear_the_scripts_colors_or_a_columns() -> None:
    photons = trace("ring").select(np.arange(60))
    photons.run_script("for (i = 0; i < getNumPhotons(); i++) setPhotonColorEncoding(i, i / 100, 1, 0.25);")
    cells = pl.inspect.voronoi(photons, None, "top", **SIZE)
    pixels = np.asarray(cells.image)
    inside = (cells.ids >= 0) & ~cells.borders
    np.testing.assert_allclose(pixels[inside], photons.colors[cells.ids[inside]], rtol=1e-6)
    by_x = np.asarray(pl.inspect.voronoi(photons, None, "top", **SIZE, color="x").image)
    brightness = by_x[inside].sum(axis=1)
    x = photons.positions[cells.ids[inside], 0]
    assert np.corrcoef(brightness, x)[0, 1] > 0.9  # cividis brightens with x


def test_render_draws_the_same_cells() -> None:
    photons = trace("ring").select(np.arange(200))
    scene = photons.find_surface()
    image = pl.render(scene, photons, camera="close", **SIZE, mode="voronoi")
    np.testing.assert_array_equal(image, pl.inspect.voronoi(photons, scene, "close", **SIZE).image)


def test_render_voronoi_needs_photons(ring: pl.Scene) -> None:
    with pytest.raises(pl.ArgumentError, match="needs a photon map"):
        pl.render(ring, mode="voronoi")


def test_a_photon_keeps_its_color_when_others_go() -> None:
    photons = trace("ring")
    few = np.asarray(pl.inspect.voronoi(photons.select(np.arange(100)), None, "top", **SIZE).image)
    again = np.asarray(pl.inspect.voronoi(photons.select(np.arange(100)), None, "top", **SIZE).image)
    np.testing.assert_array_equal(few, again)
    more = pl.inspect.voronoi(photons.select(np.arange(101)), None, "top", **SIZE)
    cells = pl.inspect.voronoi(photons.select(np.arange(100)), None, "top", **SIZE)
    same = (more.ids == cells.ids) & (cells.ids >= 0) & ~more.borders & ~cells.borders
    assert same.any()
    np.testing.assert_array_equal(np.asarray(more.image)[same], few[same])


@pytest.mark.parametrize("count", [0, 1, 2])
def test_few_photons_share_the_picture(count: int) -> None:
    photons = trace("ring").select(np.arange(count))
    cells = pl.inspect.voronoi(photons, None, "top", **SIZE, same_surface=False)
    seen = np.isfinite(cells.depth)
    assert set(np.unique(cells.ids[seen])) <= (set(range(count)) or {-1})
    nodes = pl.inspect.kd_tree(photons, None, "top", **SIZE)
    assert set(np.unique(nodes.ids[seen])) == {0 if count else -1}
    assert len(nodes.boxes) == min(count, 1)


def test_a_map_without_a_scene_asks_for_one(ring: pl.Scene) -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(50, paths=False))
    for look in (pl.inspect.voronoi, pl.inspect.kd_tree):
        with pytest.raises(pl.ArgumentError, match="say with scene="):
            look(photons)
        assert look(photons, ring, "top", **SIZE).ids.max() >= 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"camera": "side"}, "no camera 'side'"),
        ({"width": 0}, "width"),
        ({"height": 1 << 20}, "height"),
        ({"color": "colour"}, "no column 'colour'"),
    ],
)
def test_wrong_views_are_refused_by_name(ring_map: pl.PhotonMap, arguments: dict, words: str) -> None:
    with pytest.raises(pl.ArgumentError, match=words):
        pl.inspect.voronoi(ring_map, **arguments)


def test_the_command_line_renders_cells(ring_path: Path, tmp_path: Path) -> None:
    from photonloupe.cli import main  # noqa: PLC0415

    output = tmp_path / "cells.png"
    told = ["render", str(ring_path), "-o", str(output), "--mode", "voronoi", "--photons", "5000", "--width", "40"]
    assert main([*told, "--height", "30"]) == 0
    assert np.asarray(pl.load_image(output)).shape == (30, 40, 3)
