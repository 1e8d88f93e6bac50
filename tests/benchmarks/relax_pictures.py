# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of docs/relaxation.md: the ring's inner band relaxed in every way, and where photons are held."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from photon_parameters import set_trajectory
from relax_error import trace_once_reflected
from relax_methods import (
    ALIKE,
    LAYER_PCA,
    LAYER_TENSOR,
    UNCONSTRAINED_WIDE,
    WORLD_PCA_WIDE,
    WORLD_SPLIT,
    WORLD_TENSOR,
)
from scene_data import load_scene

import photonloupe as pl

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "pictures"
COUNT, SEED, STEPS = 100_000, 1, 20
K = 20
SIDE, SAMPLES, EXPOSURE = 512, 1, 0.3
# Of the picture's height: the far rim to below the cusp, with the band between where light crosses itself.
BAND = (0.06, 0.5)

WAYS: dict[str, dict[str, Any] | None] = {
    "raw": None,
    "none": UNCONSTRAINED_WIDE,
    "world_pca": WORLD_PCA_WIDE,
    "world_tensor": WORLD_TENSOR,
    "world_split": WORLD_SPLIT,
    "parameter_pca": {**LAYER_PCA, **ALIKE},
    "parameter_tensor": {**LAYER_TENSOR, **ALIKE},
}

# The floor within the far half of the ring, seen from above; z grows downward.
X_RANGE, Z_RANGE = (-0.8, 0.8), (-1.0, -0.2)  # m
PIXEL = 1.0 / 320.0  # m
FREE, HELD = np.array([0.02, 0.10, 0.45]), np.array([1.0, 0.42, 0.02])  # linear; black: no photon
WEIGHTED: dict[str, dict[str, Any]] = {
    "world_pca": {"constraint": "world", "descriptor": "pca"},
    "world_tensor": {"constraint": "world", "descriptor": "tensor"},
    "world_split": {"constraint": "world", "descriptor": "split"},
    "parameter_pca": {"constraint": "parameter", "descriptor": "pca", "beta": 3.0},
    "parameter_tensor": {"constraint": "parameter", "descriptor": "tensor", "beta": 10.0},
}


def draw_band(photons: pl.PhotonMap, name: str) -> None:
    """Render the caustic and keep the band."""
    image = pl.render(
        load_scene("ring"),
        photons,
        camera="close",
        width=SIDE,
        height=SIDE,
        samples=SAMPLES,
        mode="caustic",
        k=K,
    )
    top, bottom = (round(share * SIDE) for share in BAND)
    save(np.asarray(image)[top:bottom], f"relax_{name}", EXPOSURE)


def draw_weights(photons: pl.PhotonMap, name: str) -> None:
    """Color the photons by the mean w_v of each pixel's: 0 free, 1 held across the structure."""
    weights = photons.constraint_weights[:, 1].astype(np.float64)
    width, height = (round((high - low) / PIXEL) for low, high in (X_RANGE, Z_RANGE))
    column = np.floor((photons.positions[:, 0] - X_RANGE[0]) / PIXEL).astype(int)
    row = np.floor((photons.positions[:, 2] - Z_RANGE[0]) / PIXEL).astype(int)
    inside = (column >= 0) & (column < width) & (row >= 0) & (row < height)
    pixel = row[inside] * width + column[inside]
    counts = np.bincount(pixel, minlength=width * height)
    sums = np.bincount(pixel, weights[inside], minlength=width * height)
    mean = (sums / np.maximum(counts, 1))[:, None]
    colors = np.where(counts[:, None] > 0, FREE + (HELD - FREE) * mean, 0.0)
    save(colors.reshape(height, width, 3), f"weights_{name}", 0.0)
    print(f"  weights_{name}: mean w_v {weights.mean():.3f}, {np.mean(weights > 0.5):.1%} of photons above 0.5")


def save(pixels: NDArray[np.floating], name: str, exposure: float) -> None:
    """Write a PNG without what made it in the header: this script is that."""
    path = FOLDER / f"{name}.png"
    pl.Image(pixels).save(path, exposure=exposure)
    print(f"  {path.name}: {path.stat().st_size / 1e3:.0f} kB", flush=True)


def main() -> None:
    """Draw all."""
    FOLDER.mkdir(exist_ok=True)
    photons, _ = trace_once_reflected(COUNT, "random", SEED)
    set_trajectory(photons)
    for name, keywords in WAYS.items():
        draw_band(photons if keywords is None else photons.relax(steps=STEPS, **keywords), name)
    for name, keywords in WEIGHTED.items():
        draw_weights(photons.constrain(**keywords), name)


if __name__ == "__main__":
    main()
