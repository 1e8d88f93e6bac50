# SPDX-License-Identifier: Apache-2.0
"""Drives a studio without a window as a hand would: by the widgets' rectangles, the mouse and the keys."""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from conftest import SCENES, find_scene

SIZE = (1200, 800)
PHOTONS = 5_000
DEADLINE = 60.0  # s; of what another thread does
TRAJECTORY = SCENES / "scripts" / "primal_trajectory.photon"

# Sets one parameter, and colors by a variable that can be moved.
SHADES = """shade = 0.25;
expose shade range 0, 1
declarePhotonParameter(3, -10, 10, "east");
for (i = 0; i < getNumPhotons(); i++) {
  setPhotonParameter(i, 3, getPhotonPosition(i, X));
  setPhotonColorEncoding(i, shade, 0.5, 1 - shade);
}
"""


@contextmanager
def open_ring(
    script: Any = None, *, photons: int = PHOTONS, size: tuple[int, int] = SIZE, **options: Any
) -> Iterator[pl.Studio]:
    """Open a studio on the ring, its first work done."""
    with pl.Studio(
        scene=find_scene("ring"), offscreen=True, size=size, photons=photons, script=script, **options
    ) as studio:
        studio.frame()
        yield studio


@contextmanager
def open_empty(*, size: tuple[int, int] = SIZE, **options: Any) -> Iterator[pl.Studio]:
    """Open a studio on nothing."""
    with pl.Studio(offscreen=True, size=size, **options) as studio:
        studio.frame()
        yield studio


@contextmanager
def borrow(studio: pl.Studio, **parts: dict[str, Any]) -> Iterator[pl.Studio]:
    """Lend a studio to a test and set everything back to where it was: opening one takes longer than most tests."""
    before = studio.state
    if parts:
        change_state(studio, **parts)
    yield studio
    for button in ("left", "right"):
        studio.mouse_button(button, False)
    studio.key("escape")
    if "Keys" in studio.widgets():
        studio.key("?")
    for name in ("Parallel coordinates", "Histogram"):
        show_panel(studio, name)
    studio.mouse_move(1, 1)
    studio.set_state(before)
    studio.frame()
    assert studio.state == before


def read_state(studio: pl.Studio) -> dict[str, Any]:
    return json.loads(studio.state)


def change_state(studio: pl.Studio, **parts: dict[str, Any]) -> None:
    """Set fields of some parts of the state, as one command, and draw."""
    state = read_state(studio)
    for part, fields in parts.items():
        state[part].update(fields)
    studio.set_state(json.dumps(state))
    studio.frame()


def show_panel(studio: pl.Studio, name: str) -> None:
    """Bring a panel to the front by its tab."""
    studio.press(f"Tab/{name}")


def choose(studio: pl.Studio, widget: str, entry: str) -> None:
    """Open a list and click one of its entries, scrolled to where it is out of sight."""
    studio.press(widget)
    studio.mouse_move(*find_middle(studio, next(name for name in studio.widgets() if name.startswith(f"{widget}/"))))
    for _ in range(100):
        if f"{widget}/{entry}" in studio.widgets():
            break
        studio.wheel(-1)
        studio.frame()
    studio.press(f"{widget}/{entry}")


def find_middle(studio: pl.Studio, widget: str) -> tuple[float, float]:
    x, y, width, height = studio.widget(widget)
    return x + width / 2, y + height / 2


def find_place(studio: pl.Studio, widget: str, across: float, down: float) -> tuple[float, float]:
    """Find the pixel at shares of a widget's width and height."""
    x, y, width, height = studio.widget(widget)
    return x + across * width, y + down * height


def move_to(studio: pl.Studio, widget: str, across: float = 0.5, down: float = 0.5) -> None:
    studio.mouse_move(*find_place(studio, widget, across, down))
    studio.frame()


def drag_within(
    studio: pl.Studio,
    widget: str,
    start: tuple[float, float],
    end: tuple[float, float],
    *,
    keys: str = "",
    button: str = "left",
) -> None:
    """Drag between two places given by shares of a widget's width and height."""
    studio.drag(
        *find_place(studio, widget, *start), *find_place(studio, widget, *end), keys=keys, button=button, steps=3
    )


def drag_slider(studio: pl.Studio, widget: str, end: float) -> None:
    """Drag a slider's grab from where it is to a share of its width."""
    drag_within(studio, widget, (0.5, 0.5), (end, 0.5))


def crop(studio: pl.Studio, widget: str) -> NDArray[np.uint8]:
    """Copy a widget's pixels."""
    x, y, width, height = (round(value) for value in studio.widget(widget))
    return studio.image()[y : y + height, x : x + width].copy()


def wait_until(studio: pl.Studio, holds: Callable[[], bool], what: str) -> int:
    """Draw frames until something holds that another thread brings about; return how many."""
    end = time.monotonic() + DEADLINE
    frames = 0
    while not holds():
        assert time.monotonic() < end, f"{what} did not come about within {DEADLINE:.0f} s; it said: {studio.message}"
        studio.frame()
        frames += 1
    return frames


def place_pixel(studio: pl.Studio, point: tuple[float, float, float]) -> tuple[float, float]:
    """Find the pixel of the view that shows a world place, by the camera as the session tells it."""
    camera = read_state(studio)["view"]["camera"]
    yaw, pitch = camera["yaw"], camera["pitch"]
    backward = np.array([np.cos(pitch) * np.sin(yaw), np.sin(pitch), np.cos(pitch) * np.cos(yaw)])
    right = np.array([np.cos(yaw), 0.0, -np.sin(yaw)])
    up = np.cross(backward, right)
    offset = np.asarray(point) - (np.asarray(camera["target"]) + camera["distance"] * backward)
    x, y, width, height = studio.widget("View/Picture")
    width, height = int(width), int(height)
    scale = 0.5 * height / (np.tan(0.5 * camera["yfov"]) * -(offset @ backward))
    return float(x + width / 2 + scale * (offset @ right)), float(y + height / 2 - scale * (offset @ up))


def look_down(studio: pl.Studio, target: tuple[float, float, float], distance: float) -> None:
    """Look straight down on a place of the floor."""
    view = read_state(studio)["view"]
    camera = view["camera"] | {"is_set": True, "target": target, "yaw": 0.0, "pitch": 1.57, "distance": distance}
    change_state(studio, view={"camera": camera})


def aim_loupe(studio: pl.Studio, point: tuple[float, float, float]) -> None:
    """Move the cursor over a world place."""
    studio.mouse_move(*place_pixel(studio, point))
    studio.frame()
