# SPDX-License-Identifier: Apache-2.0
"""Draws the pictures of docs/studio.md with the studio itself, without a window."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image as Pillow
from scene_data import SCENES

import photonloupe as pl

Pixels = NDArray[np.uint8]

FOLDER = SCENES.parent / "docs" / "pictures"
SCRIPTS = SCENES / "scripts"
LARGEST = 300_000  # bytes of a picture
GAP = 4  # pixels between panels that stand side by side
GAP_COLOR = 60

# Straight down, north (-z) up.
DOWN = {"yaw": 0.0, "pitch": 1.5707, "is_set": True}
YFOV = 0.7

RING_COUNT, CLOSE_COUNT, PRISM_COUNT = 200_000, 1_000_000, 50_000
# Where the light of both halves of the wall begins: the edges of the two sheets cross on the axis, over a third.
CROSSING = (0.0, 0.0, -0.908)
# On the fold beside the cusp, where photons are held across it.
FOLD = (0.0052, 0.0, -0.4069)
# Within the light of the prism's foot.
PRISM_PLACE = (0.25, 0.0, 0.1)

# Figure 9 f: how far the surface a photon met first leans from level, over the place where it landed.
SLOPE = """// How far the surface that a photon met first leans, over the place where the photon landed.
declarePhotonParameter(3, -0.15, 0.15, "landing x [m]");
declarePhotonParameter(4, -0.3, 0.3, "lean [rad]");
for (i = 0; i < getNumPhotons(); i++) {
    if (getNumPathVertices(i) != 4) continue;
    setPhotonParameter(i, 3, getPhotonPosition(i, X));
    setPhotonParameter(i, 4, atan2(getPathNormal(i, 1, X), getPathNormal(i, 1, Y)));
}
"""
# What the script ppca is given so that its space can be drawn on polar axes.
POLAR_PPCA = """
declarePhotonParameter(5, -Pi, Pi, "principal angle", true);
declarePhotonParameter(6, 0, 2, "principal length");
"""


class Scene:
    """A studio on a scene of the repository, whose state is changed field by field."""

    def __init__(self, name: str, script: str, count: int, size: tuple[int, int] = (1600, 900)) -> None:
        scene = SCENES / name / f"{name}.gltf"
        self.studio = pl.Studio(scene=scene, offscreen=True, size=size, photons=count, script=script)
        self.studio.frame()

    def __enter__(self) -> Scene:
        return self

    def __exit__(self, *_: object) -> None:
        self.studio.close()

    def change(self, **parts: Mapping[str, Any]) -> None:
        """Set fields of the state, by part, and draw."""
        state = json.loads(self.studio.state)
        for name, fields in parts.items():
            state[name].update(fields)
        self.studio.set_state(json.dumps(state))
        self.studio.frame()
        self.studio.frame()

    def look_down(self, x: float, z: float, height: float, y: float = 0.0) -> None:
        """Look straight down at a place; `height` metres of floor fill the view from top to bottom."""
        distance = 0.5 * height / np.tan(0.5 * YFOV)
        self.change(view={"camera": {**DOWN, "target": [x, y, z], "distance": distance, "yfov": YFOV}})

    def look_through(self, point: tuple[float, float, float], **fields: Any) -> None:
        """Put the loupe at a place."""
        self.change(loupe={"has_point": True, "point": list(point), **fields})

    def panel(self, name: str, width: int, height: int, scale: float = 1.0) -> Pixels:
        """Draw one panel."""
        return self.studio.panel(name, (width, height), scale)


def put_beside(*panels: Pixels) -> Pixels:
    """Join panels of one height from left to right."""
    gap = np.full((panels[0].shape[0], GAP, 3), GAP_COLOR, np.uint8)
    parts = [part for panel in panels for part in (gap, panel)]
    return np.concatenate(parts[1:], axis=1)


def save(pixels: Pixels, name: str) -> None:
    """Write a PNG, of 256 colors where all would be too large; the same bytes in every run."""
    path = FOLDER / f"studio_{name}.png"
    picture = Pillow.fromarray(pixels)
    picture.save(path, optimize=True)
    if path.stat().st_size > LARGEST:
        picture.quantize(256, Pillow.Quantize.FASTOCTREE, kmeans=2, dither=Pillow.Dither.NONE).save(path, optimize=True)
    print(f"  {path.name}: {path.stat().st_size / 1e3:.0f} kB", flush=True)


def read_script(name: str) -> str:
    """Return a script of the repository from its first statement on."""
    lines = (SCRIPTS / f"{name}.photon").read_text(encoding="utf-8").splitlines()
    return "\n".join(line for line in lines if not line.startswith("//")).strip() + "\n"


def draw_interface() -> None:
    """Figure 5: script, cells and curves in false color; and the colors over the render."""
    with Scene("ring", read_script("tortuosity"), 50_000) as scene:
        scene.look_down(0.0, -0.42, 0.5)
        scene.change(view={"mode": "voronoi"})
        scene.look_through((0.0, 0.0, -0.5))
        save(scene.studio.image(), "interface")
    with Scene("ring", read_script("tortuosity"), RING_COUNT) as scene:
        camera = {"is_set": True, "target": [0.0, 0.1, -0.1], "yaw": 0.75, "pitch": 0.7, "distance": 3.6, "yfov": YFOV}
        scene.change(
            view={"camera": camera, "mode": "colored_render"},
            image={"samples": 4, "exposure": 0.5, "k": 30, "overlay": 0.8},
        )
        save(scene.panel("Image", 640, 600), "render")


def draw_loupe() -> None:
    """Figure 6 a: basis, drift and numbers at the cusp."""
    with Scene("ring", read_script("primal_trajectory"), 100_000) as scene:
        scene.look_down(FOLD[0], FOLD[2], 0.055)
        scene.change(relax={"choices": json.loads(scene.studio.state)["relax"]["choices"] | {"steps": 5}})
        scene.studio.command("relax.run")
        scene.studio.frame()
        numbers = ["position", "parameters", "tortuosity", "eigenvalues", "eigenvector 2", "w_v", "drift"]
        scene.look_through(FOLD, numbers=numbers)
        save(put_beside(scene.panel("View", 620, 520), scene.panel("Loupe", 400, 520)), "loupe")


def draw_nearest() -> None:
    """Figure 6 b: primal and incident trajectories of the 250 nearest, and their vertices."""
    axes = [axis(name, is_closed=True) for name in ("primal_theta", "primal_phi", "incident_theta", "incident_phi")]
    with Scene("ring", read_script("primal_trajectory"), RING_COUNT) as scene:
        scene.look_through((0.0, 0.0, -0.7))
        scene.change(parallel={"axes": [*axes, axis("vertices", low=2.0, high=6.0)], "color": "primal_phi"})
        save(scene.panel("Parallel coordinates", 900, 380), "nearest")


def draw_cells() -> None:
    """Figures 6 c and d: Voronoi cells, partition of the tree."""
    with Scene("ring", read_script("primal_trajectory"), 50_000) as scene:
        scene.look_down(0.0, -0.42, 0.22)
        scene.change(view={"mode": "voronoi"})
        cells = scene.panel("View", 560, 460)
        scene.change(view={"mode": "kd_tree"})
        save(put_beside(cells, scene.panel("View", 560, 460)), "cells")


def draw_crossing() -> None:
    """Figures 7 d, f, h, i: the crossing, its photons, their clusters, each filament alone."""
    with Scene("ring", read_script("primal_trajectory"), CLOSE_COUNT) as scene:
        scene.look_down(0.0, -0.8, 0.5)
        scene.change(view={"point_size": 1.0, "brightness": 1.5})
        plain = scene.panel("View", 620, 520)
        scene.look_through(CROSSING, k=1000)
        save(put_beside(plain, scene.panel("View", 620, 520)), "crossing")
    with Scene("ring", read_script("primal_trajectory"), RING_COUNT) as scene:
        scene.look_down(0.0, -0.9, 0.28)
        scene.look_through(CROSSING)
        axes = [axis(name) for name in ("x", "y", "z", "primal_theta")]
        axes += [axis("primal_phi", is_closed=True), axis("tortuosity")]
        scene.change(parallel={"axes": axes, "color": "primal_phi"})
        save(scene.panel("Parallel coordinates", 900, 380), "clusters")
        found = scene.studio.loupe_ids
        right = scene.studio.photons.parameters[found, 0]
        views = []
        for pin in (found[right < -0.2][0], found[right > 0.2][0]):
            scene.change(loupe={"space": "constrained", "lock": "pin", "pins": [int(pin)], "beta": 3.0})
            views.append(scene.panel("View", 620, 520))
        save(put_beside(*views), "filaments")


def draw_disc() -> None:
    """Figures 8 a to e: a disc of the world in parameter space, and what a range of parameters cuts of it."""
    with Scene("prism", read_script("primal_trajectory"), PRISM_COUNT) as scene:
        scene.look_through(PRISM_PLACE, k=250)
        scene.change(scatter={"x": "right", "y": "up", "source": "loupe", "shows_pair": True})
        save(scene.panel("Parameter space", 900, 460), "disc")
        scene.look_down(PRISM_PLACE[0], PRISM_PLACE[2], 0.1)
        views = []
        for beta in (1.0, 5.0):
            scene.change(loupe={"space": "constrained", "beta": beta})
            views.append(scene.panel("View", 620, 460))
        save(put_beside(*views), "beta")


def draw_isotropy() -> None:
    """Figures 8 f and g: how often each isotropy occurs, the share below, and β."""
    with Scene("prism", read_script("primal_trajectory"), PRISM_COUNT) as scene:
        # The view asks for the isotropy; measured, it draws the threshold where t_β is.
        scene.change(view={"mode": "map", "map_column": "isotropy"}, histogram={"column": "isotropy", "bins": 100})
        save(scene.panel("Histogram", 800, 460), "isotropy")


def draw_normals() -> None:
    """Figure 9 f: the lean of the strip's normal over the place where its light lands."""
    with Scene("lightguide", SLOPE, PRISM_COUNT) as scene:
        scene.change(scatter={"x": "landing x [m]", "y": "lean [rad]"})
        save(scene.panel("Parameter space", 800, 460), "normals")


def draw_spaces() -> None:
    """Figures 10 a and b: primal trajectory and PPCA of the prism, on polar axes."""
    with Scene("prism", read_script("primal_trajectory"), PRISM_COUNT) as scene:
        scene.change(scatter={"x": "primal_phi", "y": "primal_theta", "is_polar": True})
        primal = scene.panel("Parameter space", 620, 560)
    text = read_script("ppca").replace("\nfunction", POLAR_PPCA + "\nfunction", 1)
    sets = "    setPhotonParameter(i, 4, v);\n"
    added = "    setPhotonParameter(i, 5, atan2(u, v));\n    setPhotonParameter(i, 6, deviation);\n"
    with Scene("prism", text.replace(sets, sets + added), PRISM_COUNT) as scene:
        scene.change(scatter={"x": "principal angle", "y": "principal length", "is_polar": True})
        save(put_beside(primal, scene.panel("Parameter space", 620, 560)), "spaces")


def draw_incidence() -> None:
    """Figure 11 a: two sets of photons in one place, told apart by where they came from."""
    with Scene("ring", read_script("incidence"), RING_COUNT) as scene:
        scene.look_down(0.0, -0.55, 1.0)
        scene.change(view={"mode": "colored_points", "brightness": -1.0})
        scene.look_through((0.4, 0.0, -0.75))
        names = ("x", "y", "z", "incidence x", "incidence y", "incidence z")
        scene.change(parallel={"axes": [axis(name) for name in names]})
        save(scene.studio.image(), "incidence")


def axis(name: str, **fields: Any) -> dict[str, Any]:
    """An axis as the state has it."""
    common = {"low": 0.0, "high": 0.0, "is_flipped": False, "is_closed": False, "periods": 1, "brushes": []}
    return {"name": name, **common, **fields}


FIGURES: dict[str, Callable[[], None]] = {
    "interface": draw_interface,
    "loupe": draw_loupe,
    "nearest": draw_nearest,
    "cells": draw_cells,
    "crossing": draw_crossing,
    "disc": draw_disc,
    "isotropy": draw_isotropy,
    "normals": draw_normals,
    "spaces": draw_spaces,
    "incidence": draw_incidence,
}


def main() -> None:
    """Draw all, or those named."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("figures", nargs="*", help=f"of {', '.join(FIGURES)}; default: all")
    for name in parser.parse_args().figures or FIGURES:
        FIGURES[name]()


if __name__ == "__main__":
    main()
