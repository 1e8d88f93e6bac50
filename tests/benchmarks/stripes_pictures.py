# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of scenes/prism and scenes/lightguide: the stripes relaxed in several spaces, and the spaces."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from scene_data import SCENES, UP, load_scene
from stripes_kept import MAIN, SETTERS, Way, trace

import photonloupe as pl

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))

from stripes import REFERENCE_PHOTONS, RELAXATION, load_stripe

Doubles = NDArray[np.float64]

FOLDER = SCENES.parent / "docs" / "pictures"
EMISSION, SEED = "random", 1
REFERENCE_K = 128
PIXELS = 320
# Center along x and side of the square of floor that is drawn, m; irradiance that is white, W/m².
WINDOWS = {"prism": (0.36, 0.16, 4.0), "lightguide": (0.066, 0.1, 2.4)}
FILES = {"no constraint": "none", "primal trajectory": "primal"}
# Smallest and largest coordinates of a space that are drawn.
SPACE_SHARE = (0.002, 0.998)
AXIS = 20  # pixels left free around a plot


def draw_floor(photons: pl.PhotonMap, name: str, k: int) -> Doubles:
    """Irradiance of a square of floor from above, x to the right, z downward, white at the scene's limit."""
    center, side, white = WINDOWS[name]
    steps = ((np.arange(PIXELS) + 0.5) / PIXELS - 0.5) * side
    x, z = np.meshgrid(center + steps, steps)
    points = np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)
    found = photons.irradiance(points, UP, k=k)[:, 0].astype(np.float64)
    return np.repeat((found / white).reshape(PIXELS, PIXELS, 1), 3, axis=2)


def relax(name: str, way: Way | None, count: int) -> pl.PhotonMap:
    """Trace a map and relax it one way."""
    photons = trace(name, count, EMISSION, SEED)
    if way is None:
        return photons
    SETTERS[way[0]](photons)
    return photons.relax(**{**RELAXATION, **way[1]})


def plot_points(across: Doubles, up: Doubles, colors: Doubles) -> Doubles:
    """Scatter plot, white on black: the mean color of a pixel's points, brighter where there are many."""
    places = []
    for values in (across, -up):
        low, high = np.quantile(values, SPACE_SHARE)
        share = (values - low) / (high - low)
        places.append(np.round(AXIS + share * (PIXELS - 1 - 2 * AXIS)).astype(int))
    column, row = places
    inside = (column >= 0) & (column < PIXELS) & (row >= 0) & (row < PIXELS)
    pixel = row[inside] * PIXELS + column[inside]
    count = np.bincount(pixel, minlength=PIXELS**2)
    sums = np.stack([np.bincount(pixel, colors[inside, c], minlength=PIXELS**2) for c in range(3)], axis=1)
    shade = np.log1p(count) / np.log1p(np.quantile(count[count > 0], 0.98))
    mean = sums / np.maximum(count, 1)[:, None]
    return (mean * np.minimum(shade, 1.0)[:, None]).reshape(PIXELS, PIXELS, 3)


def find_side_colors(photons: pl.PhotonMap, faces: tuple[int, ...]) -> Doubles:
    """Colors by how the faces met lean: flat faces gray to white, what is curved orange, other ways blue."""
    colors = np.full((len(photons), 3), (0.1, 0.25, 0.9))
    offsets = photons.path_offsets
    twice = np.flatnonzero(np.diff(offsets) == 4)
    lean = np.degrees(np.arcsin(np.clip(photons.path_normals[offsets[twice] + 2, 1].astype(np.float64), -1.0, 1.0)))
    flat = np.min(np.abs(np.abs(lean)[:, None] - np.array(faces, dtype=np.float64)), axis=1) < 1e-3
    colors[twice] = np.where(flat[:, None], (0.6, 0.6, 0.6), (1.0, 0.4, 0.05))
    return colors


def draw_spaces() -> None:
    """The prism's photons in both spaces; what crossed a curved part is orange, what went another way than 22 blue."""
    for parameters in ("primal", "ppca"):
        photons = trace("prism", load_stripe("prism").photons, EMISSION, SEED)
        SETTERS[parameters](photons)
        u, v = photons.parameters.astype(np.float64).T
        save(plot_points(u, v, find_side_colors(photons, (4, 15))), f"prism_space_{parameters}")


def draw_normals() -> None:
    """The slope of the strip's upper side where a photon crossed it, over the place where it landed."""
    photons = trace("lightguide", load_stripe("lightguide").photons, EMISSION, SEED).select(signature="22")
    normals = photons.path_normals.reshape(-1, 4, 3).astype(np.float64)
    straight = np.abs(normals[:, 1:3, 2]).max(axis=1) < 1e-5
    slope = np.degrees(np.arctan2(normals[straight, 1, 0], normals[straight, 1, 1]))
    x = photons.positions[straight, 0].astype(np.float64)
    drawn = (np.abs(x) < 0.15) & (np.abs(slope) < 20.0)
    save(plot_points(x[drawn], slope[drawn], np.ones((int(drawn.sum()), 3))), "lightguide_normals")


def save(pixels: Doubles, name: str) -> None:
    """Write a PNG without what made it in the header: this script is that."""
    path = FOLDER / f"{name}.png"
    pl.Image(pixels).save(path, exposure=0.0)
    print(f"  {path.name}: {path.stat().st_size / 1e3:.0f} kB", flush=True)


def draw_scene(name: str, camera: str) -> None:
    """The picture at the head of the scene's README."""
    photons = trace(name, 200_000, "sobol", SEED)
    image = pl.render(load_scene(name), photons, camera=camera, width=512, height=512, samples=16, k=50)
    pl.Image(np.asarray(image)).save(SCENES / name / f"{name}.png", exposure=0.5)


def main() -> None:
    """Draw all."""
    for name in WINDOWS:
        stripe = load_stripe(name)
        draw_scene(name, "view")
        save(draw_floor(trace(name, REFERENCE_PHOTONS, "sobol", SEED), name, REFERENCE_K), f"{name}_reference")
        for label, way in MAIN.items():
            file = f"{name}_{FILES.get(label, label.lower())}"
            save(draw_floor(relax(name, way, stripe.photons), name, stripe.k), file)
    draw_spaces()
    draw_normals()


if __name__ == "__main__":
    main()
