# SPDX-License-Identifier: Apache-2.0
"""An X server without a screen, and a mouse that moves on it."""

from __future__ import annotations

import ctypes
import os
import select
import shutil
import subprocess
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

PERIOD = 0.008  # s between two reports of the mouse
_START = 10.0  # s
_LEFT = 1


def find_missing() -> str:
    """Say what is not installed; empty: all is there."""
    if shutil.which("Xvfb") is None:
        return "Xvfb is not installed (apt-get install xvfb)"
    try:
        ctypes.CDLL("libXtst.so.6")
    except OSError:
        return "libXtst is not installed (apt-get install libxtst6)"
    return ""


@contextmanager
def open_screen(width: int, height: int) -> Iterator[None]:
    """Run the server and point DISPLAY to it."""
    read_end, write_end = os.pipe()
    screen = f"{width}x{height}x24"
    command = ["Xvfb", "-displayfd", str(write_end), "-screen", "0", screen, "-nolisten", "tcp"]
    server = subprocess.Popen(command, pass_fds=[write_end], stderr=subprocess.DEVNULL)
    os.close(write_end)
    before = os.environ.get("DISPLAY")
    try:
        if not select.select([read_end], [], [], _START)[0]:
            raise RuntimeError(f"Xvfb did not start within {_START:g} s")
        os.environ["DISPLAY"] = ":" + os.read(read_end, 16).decode().strip()
        yield
    finally:
        os.close(read_end)
        os.environ.pop("DISPLAY", None)
        if before is not None:
            os.environ["DISPLAY"] = before
        server.terminate()
        server.wait(_START)


class Mouse:
    """Moves and presses as the server's own mouse does."""

    def __init__(self) -> None:
        self._x11, self._test = ctypes.CDLL("libX11.so.6"), ctypes.CDLL("libXtst.so.6")
        self._x11.XOpenDisplay.restype = ctypes.c_void_p
        self._display = ctypes.c_void_p(self._x11.XOpenDisplay(None))
        if not self._display:
            raise RuntimeError("there is no X server")

    def move(self, x: float, y: float) -> None:
        """Move to a pixel of the screen."""
        self._test.XTestFakeMotionEvent(self._display, 0, round(x), round(y), ctypes.c_ulong(0))
        self._x11.XFlush(self._display)

    def press(self, down: bool) -> None:
        """Press or let go of the left button."""
        self._test.XTestFakeButtonEvent(self._display, _LEFT, int(down), ctypes.c_ulong(0))
        self._x11.XFlush(self._display)

    @contextmanager
    def follow(self, path: Callable[[int], tuple[float, float]]) -> Iterator[None]:
        """Move along a path, a step each time the mouse reports, until the block ends."""
        done = threading.Event()

        def run() -> None:
            step = 0
            while not done.wait(PERIOD):
                self.move(*path(step))
                step += 1

        thread = threading.Thread(target=run, daemon=True)
        thread.start()
        try:
            yield
        finally:
            done.set()
            thread.join()

    def close(self) -> None:
        """Part from the server."""
        self._x11.XCloseDisplay(self._display)
