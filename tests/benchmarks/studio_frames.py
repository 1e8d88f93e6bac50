# SPDX-License-Identifier: Apache-2.0
"""Measures the studio in a real window under Xvfb: frames while one works with it, loupe queries, plots."""

from __future__ import annotations

import gc
import json
import os
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from measure import Row, Subject, print_subject
from numpy.typing import NDArray
from scene_data import SCENES
from screen import PERIOD, Mouse, find_missing, open_screen

import photonloupe as pl

Doubles = NDArray[np.float64]
Place = tuple[float, float]

PHOTONS = 200_000
SIZE = (1600, 900)
FRAMES = 150  # of each measurement at least
WARM = 15
PATIENCE = 120.0  # s that the background work is waited for
PLOTS, STEPS = 20, 20
FEW, MANY = 250, 100_000  # curves
TURN = 400  # reports of the mouse that bring it round
# Goals: share of frames under 100 ms; queries; plots.
FRAME_LIMIT, FRAME_SHARE, QUERY_LIMIT = 100.0, 0.95, 50.0
PLOT_LIMITS = {FEW: 10.0, MANY: 150.0}


class Bench:
    """A studio in a window, the mouse over it, and what is done with them."""

    def __init__(self) -> None:
        self.mouse = Mouse()
        self.studio = pl.Studio(
            scene=SCENES / "ring" / "ring.gltf",
            script=SCENES / "scripts" / "primal_trajectory.photon",
            photons=PHOTONS,
            size=SIZE,
        )
        self.rest()
        self.studio.command("view.straight")
        self.rest()

    def close(self) -> None:
        """Close both."""
        self.studio.close()
        self.mouse.close()

    def rest(self) -> None:
        """Draw until no work is left."""
        end, quiet = time.monotonic() + PATIENCE, 0
        while quiet < 5:
            if time.monotonic() > end:
                raise RuntimeError(f"the work took more than {PATIENCE:g} s")
            self.studio.frame()
            time.sleep(PERIOD)
            quiet = 0 if self.studio.is_busy else quiet + 1

    def read(self) -> dict[str, Any]:
        """Return the state."""
        return json.loads(self.studio.state)

    def change(self, part: str, **fields: Any) -> None:
        """Set fields of the state."""
        state = self.read()
        state[part].update(fields)
        self.studio.set_state(json.dumps(state))

    def circle(self, step: int) -> Place:
        """A place on a way round the view, over most of the caustic."""
        x, y, width, height = self.studio.widget("View/Picture")
        angle, reach = 2 * np.pi * step / TURN, 0.3 * min(width, height)
        return (x + 0.5 * width + reach * np.cos(angle), y + 0.5 * height + reach * np.sin(angle))

    def hold(self, path: Callable[[int], Place], count: int) -> None:
        """Press the button at a path's begin, follow it for so many frames, let go."""
        self.mouse.move(*path(0))
        self.studio.run(3)
        self.mouse.press(True)
        with self.mouse.follow(path):
            self.studio.run(count)
        self.mouse.press(False)
        self.studio.run(3)

    def move_loupe(self, count: int) -> None:
        """Go round in the view."""
        place = self.read()["loupe"]["point"]
        with self.mouse.follow(self.make_round()):
            self.studio.run(count)
        require(self.read()["loupe"]["point"] != place, "the loupe did not move")

    def make_round(self) -> Callable[[int], Place]:
        """The way round, its places known: other threads do not ask the studio."""
        places = [self.circle(step) for step in range(TURN)]
        return lambda step: places[step % TURN]

    def orbit(self, count: int) -> None:
        """Drag in the view."""
        yaw = self.read()["view"]["camera"]["yaw"]
        self.hold(self.make_round(), count)
        require(self.read()["view"]["camera"]["yaw"] != yaw, "the camera did not move")
        self.studio.command("view.straight")
        self.rest()

    def drag_slider(self, count: int) -> None:
        """Drag the script's slider to and fro; the values run the script over all photons."""
        x, y, width, height = self.studio.widget("Script/zoom")
        self.hold(lambda step: (x + width * (0.5 - 0.3 * np.cos(0.01 * step)), y + 0.5 * height), count)
        require("zoom" in self.read()["script"]["values"], "the slider did not move")
        self.rest()

    def relax(self, count: int) -> None:
        """Move the loupe while steps of relaxation are made: all of them, or of a few frames."""
        self.studio.command("relax.reset")
        self.change("relax", choices=self.read()["relax"]["choices"] | {"steps": STEPS})
        self.rest()
        self.studio.statistics()
        self.studio.command("relax.run")
        end = time.monotonic() + PATIENCE
        with self.mouse.follow(self.make_round()):
            self.studio.run(WARM)
            quiet = 0  # between two pieces of work nothing is busy for a moment
            while quiet < 3 and time.monotonic() < end and count > WARM:
                self.studio.run(1)
                quiet = 0 if self.studio.is_busy else quiet + 1
        require(count <= WARM or self.studio.relaxed is not None, "nothing was relaxed")

    def plot(self, ids: NDArray[np.int64] | None, count: int) -> None:
        """Draw the curves again and again, of other tension each time."""
        if ids is not None:
            self.studio.selection = ids
        self.change("parallel", source="loupe" if ids is None else "selection")
        self.studio.frame()
        for step in range(count):
            self.change("parallel", tension=0.5 + 0.5 * step / count)
            self.studio.frame()

    def measure(self, work: Callable[[int], None]) -> dict[str, Doubles]:
        """Do it briefly to warm up, then long enough, and take the studio's own times, ms."""
        work(WARM)
        self.studio.statistics()
        work(FRAMES)
        return self.studio.statistics()


def require(is_so: bool, what: str) -> None:
    """Refuse figures of something that did not happen."""
    if not is_so:
        raise RuntimeError(what)


def read_busy() -> tuple[float, float]:
    """Seconds that all processors have worked, and those of this process and its ended children."""
    fields = [int(field) for field in Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:]]
    idle = fields[3] + fields[4]
    return (sum(fields[:8]) - idle) / os.sysconf("SC_CLK_TCK"), sum(os.times()[:4])


def describe(times: Doubles) -> str:
    """Median, 95 % and most."""
    return f"median {np.median(times):.3g} ms, 95 % {np.quantile(times, 0.95):.3g} ms, most {times.max():.3g} ms"


def add_frames(subject: Subject, name: str, times: dict[str, Doubles]) -> None:
    """One row of frames, and of loupe queries where there were some."""
    frames = times["frames"]
    share = float(np.mean(frames < FRAME_LIMIT))
    figure = f"{describe(frames)}; {share:.1%} of {len(frames)} under {FRAME_LIMIT:g} ms"
    gate = f"{FRAME_SHARE:.0%} under {FRAME_LIMIT:g} ms"
    subject.rows.append(Row(f"frames, {name}", "—", "—", figure, gate=gate, met=share >= FRAME_SHARE))
    if len(times["loupe"]) > len(frames) // 3:
        queries = times["loupe"]
        limit = f"most < {QUERY_LIMIT:g} ms"
        met = bool(queries.max() < QUERY_LIMIT)
        subject.rows.append(Row(f"loupe queries, {name}", "—", "—", describe(queries), gate=limit, met=met))


def add_plots(subject: Subject, bench: Bench) -> None:
    """Rows of the curves of the loupe and of many photons."""
    few = bench.measure(lambda count: bench.plot(None, min(count, PLOTS)))
    many = bench.measure(lambda count: bench.plot(np.arange(MANY), min(count, PLOTS)))
    for count, times in ((FEW, few), (MANY, many)):
        limit, plots = PLOT_LIMITS[count], times["plots"]
        met = bool(np.median(plots) < limit)
        work = f"parallel coordinates, {count:,} curves, 7 axes, with densities"
        subject.rows.append(Row(work, "—", "—", describe(plots), gate=f"median < {limit:g} ms", met=met))


def add_rows(subject: Subject) -> None:
    """Open the window and measure."""
    bench = Bench()
    try:
        works: dict[str, Callable[[int], None]] = {
            "moving the loupe": bench.move_loupe,
            "orbiting the camera": bench.orbit,
            "dragging a slider of the script, which runs behind": bench.drag_slider,
            f"moving the loupe while {STEPS} steps of relaxation are made behind": bench.relax,
        }
        for name, work in works.items():
            add_frames(subject, name, bench.measure(work))
        bench.studio.command("relax.reset")
        bench.rest()
        add_plots(subject, bench)
    finally:
        bench.close()


def measure() -> Subject:
    """Frames at four kinds of work, then plots."""
    subject = Subject(f"The studio in a window, {PHOTONS:,} photons of the ring")
    subject.notes.append(
        f"A window of {SIZE[0]} × {SIZE[1]} pixels under Xvfb, all panels as they open: points, loupe of {FEW}, its "
        "curves, relaxation. The times are the program's own (`studio.statistics()`): a frame from taking input to the "
        "presented image, a query from the move to its answer, a plot from columns to its image. The server's mouse "
        f"reports every {PERIOD * 1e3:g} ms. Everything was done once before: no kernel is compiled. There is no peer."
    )
    missing = find_missing()
    if missing:
        subject.skipped.append(f"the window: {missing}")
        return subject
    before = read_busy()
    with open_screen(*SIZE):
        add_rows(subject)
        gc.collect()  # the window goes before the screen does
    everyone, own = np.subtract(read_busy(), before)
    subject.notes.append(f"Other programs took {max(1.0 - own / everyone, 0.0):.0%} of the processor time used.")
    return subject


if __name__ == "__main__":
    print_subject(measure())
