# SPDX-License-Identifier: Apache-2.0
"""The interactive tool: a window, or the same interface drawn into an image."""

from __future__ import annotations

import functools
import os
import weakref
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_number, check_rows, check_size, check_vector
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.image import Image
from photonloupe.photons import PhotonMap
from photonloupe.scene import Scene
from photonloupe.scripting import Script
from photonloupe.studio.autosave import Autosave
from photonloupe.studio.examples import find_examples
from photonloupe.studio.hosting import compare_with_file, load_map
from photonloupe.studio.pictures import encode_pixels, write_pixels
from photonloupe.studio.requests import Requests
from photonloupe.studio.results import Results

SMALLEST_SIDE, LARGEST_SIDE = 64, 8192
# Of one frame() without a window: each may ask for the next.
_MOST_JOBS = 16
_MOUSE_BUTTONS = {"left": 0, "right": 1, "middle": 2}

SelectionWatcher = Callable[["NDArray[np.uint32] | None"], None]


class Studio:
    """The studio: script, view, loupe, parallel coordinates, parameter space, histograms, relaxation, image.

    Without a window it draws the same interface into an image, with a fixed clock: the same input gives the same bytes.

    Parameters
    ----------
    scene
        A scene or its path; None: begin empty.
    offscreen
        Draw into an image; else open a window.
    size
        Width and height in pixels, 64 to 8192 each.
    photons
        How many to trace.
    script
        A script to begin with: a path, a text, or what `compile_script` made; it is run.
    scale
        Of fonts and widgets, 0.5 to 4; in a window times the monitor's.
    background
        Without a window too, do the work in a thread while frames go on; by default a frame waits for it.
    device
        A `Device`, its name or index; default the best there is.

    Raises
    ------
    ArgumentError
        If a setting is out of its range.
    DeviceError
        If the device cannot draw, or no window can be opened.

    Examples
    --------
    >>> import photonloupe as pl
    >>> studio = pl.Studio(scene="scenes/ring/ring.gltf", offscreen=True, size=(800, 600), photons=10_000)
    >>> studio.frame()
    >>> studio.image().shape, len(studio.photons) >= 10_000
    ((600, 800, 3), True)
    >>> studio.close()
    """

    def __init__(
        self,
        *,
        scene: Scene | str | os.PathLike[str] | None = None,
        offscreen: bool = False,
        size: Sequence[int] = (1600, 900),
        photons: int | None = None,
        script: str | os.PathLike[str] | Script | None = None,
        scale: float = 1.0,
        background: bool = False,
        device: Device | int | str | None = None,
    ) -> None:
        width, height = check_size(size, SMALLEST_SIDE, LARGEST_SIDE)
        scale = check_number("scale", scale, 0.5, 4.0)
        self._device = open_device(device)
        self._native = _engine.open_studio(
            self._device._native,
            (width, height),
            scale,
            offscreen,
            background or not offscreen,
            functools.partial(load_map, device=self._device),
            compare_with_file,
        )
        self._is_open = True
        self._results = Results(self._native, self._device)
        self._requests = Requests(self._native, self._results, weakref.WeakMethod(self.export_panel))
        self._watchers: list[SelectionWatcher] = []
        self._seen_version = self._native.version()
        self._told_selection: NDArray[np.uint32] | None = None
        self._native.deliver_examples(find_examples())
        self._autosave = None if offscreen else Autosave(self._native)
        left = None if self._autosave is None else self._autosave.find_left()
        if left is not None:
            self._native.offer_restore(str(left))
        if scene is not None:
            self._requests.open_scene(scene, photons)
        if script is not None:
            self._requests.open_script(script, runs=True)

    def frame(self) -> None:
        """Take input, draw, and do or begin the work that follows from it.

        Without a window and without ``background`` all work is done when it returns.
        """
        self._require_open()
        self._native.frame()
        for _ in range(_MOST_JOBS):
            if not self._take_turn():
                break
            self._native.frame()
        self._tell_watchers()

    def _take_turn(self) -> bool:
        """Serve requests and the next job; True: another frame should follow."""
        served = self._requests.serve()
        return self._native.take_turn() or served

    def open(self, path: str | os.PathLike[str]) -> None:
        """Open a scene, photon map, script, session or reference image, by its suffix; its work follows with frames.

        Raises
        ------
        PhotonLoupeError
            If it is none of those, or cannot be read.
        """
        self._requests.open_file(os.fspath(path))

    def watch_files(self) -> None:
        """Open the scene and the script again if their files changed on the disk; a window does so by itself.

        What is wrong with a file is said in the status line; the last good state stays.
        """
        if self._requests.watch_files():
            self.frame()

    def run(self, frames: int | None = None) -> None:
        """Draw frames until the window is closed, or so many."""
        drawn = 0
        changed = True
        while not self.should_close and (frames is None or drawn < frames):
            if changed or frames is not None:
                self.frame()
                drawn += 1
            self.watch_files()
            if self._autosave is not None:
                self._autosave.save_when_due()
            changed = self._native.wait(0.05 if self.is_busy else 0.5)

    @property
    def should_close(self) -> bool:
        """Whether the user closed the window."""
        return bool(self._native.should_close)

    @property
    def is_busy(self) -> bool:
        """Whether work is running in the background."""
        return bool(self._native.is_busy)

    def close(self, *, keeps_autosave: bool = False) -> None:
        """Stop the work and free the window; closing twice is fine.

        Parameters
        ----------
        keeps_autosave
            Leave the session that was saved aside, to be offered by the next window: after an error.
        """
        if self._is_open:
            self._is_open = False
            self._native.close()
            self._native.hide()
            if self._autosave is not None and not keeps_autosave:
                self._autosave.clear()

    def __enter__(self) -> Studio:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close(keeps_autosave=kind is not None and not issubclass(kind, KeyboardInterrupt))

    # Pictures

    def image(self) -> NDArray[np.uint8]:
        """Return the interface as last drawn, (height, width, 3) sRGB, row 0 at the top."""
        return np.asarray(self._native.image())

    def save_image(self, path: str | os.PathLike[str]) -> None:
        """Write the interface as last drawn as a PNG."""
        write_pixels(path, self.image())

    def panel(self, name: str, size: Sequence[int] = (800, 600), scale: float = 1.0) -> NDArray[np.uint8]:
        """Draw one panel alone at a size and scale of its own, (height, width, 3).

        Raises
        ------
        PhotonLoupeError
            Naming the panels there are.
        """
        width, height = check_size(size, SMALLEST_SIDE, LARGEST_SIDE)
        return np.asarray(self._native.panel(name, width, height, check_number("scale", scale, 0.5, 4.0)))

    def export_panel(
        self, name: str, path: str | os.PathLike[str], size: Sequence[int] = (800, 600), scale: float = 1.0
    ) -> None:
        """Write one panel as a PNG; parallel coordinates as an SVG too, by the path's suffix."""
        if Path(path).suffix.lower() == ".svg":
            self._requests.write_svg(name, path, check_size(size, SMALLEST_SIDE, LARGEST_SIDE))
            return
        write_pixels(path, self.panel(name, size, scale))

    def _repr_png_(self) -> bytes:
        return encode_pixels(self.image())

    # Input

    def mouse_move(self, x: float, y: float) -> None:
        """Move the mouse to a pixel of the interface."""
        self._native.move_mouse(x, y)

    def mouse_button(self, button: str, down: bool) -> None:
        """Press or let go of ``"left"``, ``"right"`` or ``"middle"``."""
        if button not in _MOUSE_BUTTONS:
            raise ArgumentError(f"button must be left, right or middle, not {button!r}")
        self._native.press_mouse(_MOUSE_BUTTONS[button], down)

    def click(self, x: float, y: float, button: str = "left") -> None:
        """Move there and click; takes the frames it needs."""
        self.mouse_move(x, y)
        self.frame()
        self.mouse_button(button, True)
        self.frame()
        self.mouse_button(button, False)
        self.frame()

    def drag(
        self, x0: float, y0: float, x1: float, y1: float, *, button: str = "left", steps: int = 4, keys: str = ""
    ) -> None:
        """Drag from one pixel to another, modifiers such as ``"ctrl"`` held; takes the frames it needs."""
        modifiers = [key for key in keys.split("+") if key]
        self.mouse_move(x0, y0)
        self.frame()
        for key in modifiers:
            self._native.hold_key(key, True)
        self.mouse_button(button, True)
        self.frame()
        for i in range(1, check_count("steps", steps, 1, 1000) + 1):
            share = i / steps
            self.mouse_move(x0 + (x1 - x0) * share, y0 + (y1 - y0) * share)
            self.frame()
        self.mouse_button(button, False)
        for key in modifiers:
            self._native.hold_key(key, False)
        self.frame()

    def look_at(self, point: Sequence[float]) -> None:
        """Move the loupe to a point (3,), m, as the mouse over the view would."""
        self._native.look_at(check_vector("point", point))
        self.frame()

    def wheel(self, steps: float) -> None:
        """Turn the wheel; positive: away from the user."""
        self._native.turn_wheel(steps)

    def key(self, chord: str) -> None:
        """Press keys such as ``"ctrl+enter"``, ``"tab"`` or ``"4"``."""
        self._native.press_key(chord)
        self.frame()

    def type(self, text: str) -> None:
        """Type a text; line breaks are Enter."""
        self._native.type_text(text)
        self.frame()

    def drop(self, path: str | os.PathLike[str]) -> None:
        """Drop a file on the window: a scene, script, map, session or EXR."""
        self._native.drop_file(os.fspath(path))
        self.frame()

    def widget(self, name: str) -> tuple[float, float, float, float]:
        """Return a widget's rectangle as last drawn: x, y, width, height.

        Raises
        ------
        ArgumentError
            If it was not drawn.
        """
        box = self._native.widget(name)
        if box is None:
            raise ArgumentError(f"there is no widget {name!r} on the screen; widgets() lists those there are")
        x, y, width, height = box
        return float(x), float(y), float(width), float(height)

    def widgets(self) -> list[str]:
        """Return the names of all widgets drawn."""
        return list(self._native.widgets())

    def press(self, name: str) -> None:
        """Click the middle of a widget."""
        x, y, width, height = self.widget(name)
        self.click(x + width / 2, y + height / 2)

    def command(self, name: str) -> None:
        """Run a command such as ``"loupe.pin"``; `commands` lists them.

        Raises
        ------
        PhotonLoupeError
            Naming the commands there are.
        """
        self._native.command(name)
        self.frame()

    @staticmethod
    def commands() -> list[tuple[str, str, str]]:
        """List all commands: name, keys, what they do."""
        return [tuple(row) for row in _engine.list_studio_commands()]

    # State

    @property
    def state(self) -> str:
        """Everything that was chosen, as JSON: what a session holds."""
        return str(self._native.state())

    def set_state(self, state: str, name: str = "set state") -> None:
        """Take a state as a whole; undo goes back to the one before.

        Raises
        ------
        PhotonLoupeError
            Naming the field that is wrong; the state stays.
        """
        self._native.set_state(name, state)

    def save_session(self, path: str | os.PathLike[str]) -> None:
        """Write a ``.loupe`` session; a killed save leaves the old one or the new one."""
        self._native.save_session(os.fspath(path))

    def load_session(self, path: str | os.PathLike[str]) -> None:
        """Take the state of a session; its work follows with the next frames."""
        self._native.load_session(os.fspath(path))

    def python(self) -> str:
        """Return the Python program that makes what is shown."""
        return str(self._native.python())

    @property
    def message(self) -> str:
        """The last thing the status line said."""
        return str(self._native.message()[0])

    @property
    def has_failed(self) -> bool:
        """Whether `message` tells of something that went wrong."""
        return bool(self._native.message()[1])

    @property
    def photons(self) -> PhotonMap:
        """The photons with what the script gave them.

        Raises
        ------
        ArgumentError
            If there are none yet.
        """
        photons = self._results.photons
        if photons is None:
            raise ArgumentError("the studio has no photons yet; open a scene and draw a frame")
        return photons

    @property
    def relaxed(self) -> PhotonMap | None:
        """The relaxed photons, if any."""
        return self._results.relaxed if self._native.has_relaxed() else None

    @property
    def scene(self) -> Scene | None:
        """The scene the photons lie in."""
        return self._results.scene

    @property
    def rendered(self) -> Image | None:
        """The last rendered view, linear."""
        return self._results.image

    @property
    def loupe_ids(self) -> NDArray[np.uint32]:
        """Photons the loupe has found, nearest first."""
        return np.asarray(self._native.loupe_ids())

    @property
    def selection(self) -> NDArray[np.uint32] | None:
        """Selected photons by id, ascending; None: nothing is selected."""
        found = self._native.selection()
        return None if found is None else np.asarray(found)

    @selection.setter
    def selection(self, ids: ArrayLike | None) -> None:
        chosen = None if ids is None else np.unique(check_rows(ids, len(self.photons)))
        self._native.select(None if chosen is None else [int(i) for i in chosen])

    def watch_selection(self, watcher: SelectionWatcher) -> None:
        """Call a function with the selection whenever it has changed."""
        self._watchers.append(watcher)

    def statistics(self) -> dict[str, NDArray[np.float64]]:
        """Take the milliseconds of frames, loupe queries and plots since the last call."""
        return {name: np.asarray(values) for name, values in self._native.statistics().items()}

    def _tell_watchers(self) -> None:
        version = self._native.version()
        if version == self._seen_version:
            return
        self._seen_version = version
        selection = self.selection
        if _are_alike(selection, self._told_selection):
            return
        self._told_selection = selection
        for watcher in self._watchers:
            watcher(selection)

    def _require_open(self) -> None:
        if not self._is_open:
            raise ArgumentError("this studio was closed; open another")

    def __repr__(self) -> str:
        photons = self._results.photons
        count = 0 if photons is None else len(photons)
        return f"<Studio {self._native.size[0]} × {self._native.size[1]}, {count:,} photons>"


def _are_alike(first: NDArray[np.uint32] | None, second: NDArray[np.uint32] | None) -> bool:
    if first is None or second is None:
        return first is second
    return np.array_equal(first, second)
