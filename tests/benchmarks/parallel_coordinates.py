# SPDX-License-Identifier: Apache-2.0
"""Times parallel coordinates of 250 and 100,000 curves across six axes, against matplotlib and NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np
from measure import (
    Round,
    Row,
    Subject,
    compare_speed,
    find_median,
    format_seconds,
    is_installed,
    print_subject,
    time_in_turn,
)
from numpy.typing import NDArray

import photonloupe as pl

AXIS_COUNT = 6
SIZE = (900, 360)
GATES = {250: 0.010, 100_000: 0.150}  # s, ours
PAIRS = {250: 15, 100_000: 5}
# Lines that matplotlib draws in some seconds.
MATPLOTLIB_MOST = 2000
# Pixels between the axes in which one sees curves and the other none: where rounding decides about the row.
DISAGREEMENT = 1e-3
# Pixels beside an axis that its line, ticks and labels take.
AXIS_REACH = 6


def make_data(count: int) -> dict[str, NDArray[np.float32]]:
    """Three clusters, as a caustic's strands are."""
    rng = np.random.default_rng(1)
    strand, middles = rng.integers(0, 3, count), rng.random((3, AXIS_COUNT))
    columns = middles[strand] + 0.06 * rng.normal(size=(count, AXIS_COUNT))
    return {f"c{i}": np.ascontiguousarray(columns[:, i], dtype=np.float32) for i in range(AXIS_COUNT)}


def count_with_numpy(plot: pl.inspect.ParallelCoordinates) -> NDArray[np.int64]:
    """Count the curves in every pixel column by column: where each enters and leaves it, then a running sum."""
    width, height = SIZE
    counts = np.zeros((height + 1, width), np.int64)
    for gap in range(AXIS_COUNT - 1):
        (x0, x1), (y0, y1) = plot.points[0, gap : gap + 2, 0], plot.points[:, gap : gap + 2, 1].T
        span = x1 - x0
        m0, m1 = span * plot.tangents[:, gap].T
        before = y0
        for column in range(round(float(x0)), round(float(x1))):
            t = np.float32((column + 1 - x0) / span)
            after = y0 + t * (m0 + t * (3 * (y1 - y0) - 2 * m0 - m1 + t * (m0 + m1 - 2 * (y1 - y0))))
            low, high = np.minimum(before, after).astype(np.int64), np.maximum(before, after).astype(np.int64)
            counts[:, column] += np.bincount(np.clip(low, 0, height), minlength=height + 1)
            counts[:, column] -= np.bincount(np.clip(high + 1, 0, height), minlength=height + 1)
            before = after
    return np.cumsum(counts, axis=0)[:height]


class MatplotlibCurves:
    """The same cubics as Bézier paths, drawn by Agg."""

    def __init__(self, plot: pl.inspect.ParallelCoordinates) -> None:
        from matplotlib.path import Path  # noqa: PLC0415 - an optional peer

        steps = np.diff(plot.points, axis=1) / 3
        ones = np.ones_like(plot.tangents[..., 0])
        starts = plot.points[:, :-1] + steps[..., :1] * np.stack([ones, plot.tangents[..., 0]], axis=-1)
        ends = plot.points[:, 1:] - steps[..., :1] * np.stack([ones, plot.tangents[..., 1]], axis=-1)
        gaps = np.stack([starts, ends, plot.points[:, 1:]], axis=2).reshape(len(plot.points), -1, 2)
        vertices = np.concatenate([plot.points[:, :1], gaps], axis=1)
        codes = [Path.MOVETO] + [Path.CURVE4] * (vertices.shape[1] - 1)
        self.paths = [Path(row, codes) for row in vertices]

    def draw(self, _: int) -> None:
        """One figure."""
        from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: PLC0415
        from matplotlib.collections import PathCollection  # noqa: PLC0415
        from matplotlib.figure import Figure  # noqa: PLC0415

        figure = Figure(figsize=(SIZE[0] / 100, SIZE[1] / 100), dpi=100)
        axes = figure.add_axes((0, 0, 1, 1))
        axes.set(xlim=(0, SIZE[0]), ylim=(SIZE[1], 0))
        axes.add_collection(PathCollection(self.paths, facecolors="none", edgecolors="#225588", alpha=0.7))
        canvas = FigureCanvasAgg(figure)
        canvas.draw()
        np.asarray(canvas.buffer_rgba())


def compare_pixels(subject: Subject, work: str, plot: pl.inspect.ParallelCoordinates) -> None:
    """Tell where ours shows curves and NumPy counts none, or the other way round."""
    is_between = np.ones(SIZE[0], bool)
    for x in plot.points[0, :, 0]:
        is_between[max(int(x) - AXIS_REACH, 0) : int(x) + AXIS_REACH] = False
    shown = (np.asarray(plot.image) < 0.999).any(axis=2)[:, is_between]
    counted = (count_with_numpy(plot) > 0)[:, is_between]
    rows = slice(int(plot.points[..., 1].min()), int(plot.points[..., 1].max()) + 1)
    share = float(np.mean(shown[rows] != counted[rows]))
    if share > DISAGREEMENT:
        subject.failed.append(f"{work}: {share:.2%} of the pixels differ from NumPy's counts")


def measure_one(subject: Subject, count: int) -> None:
    """Measure one number of curves."""
    data = make_data(count)
    found: dict[str, Any] = {}

    def run_ours(_: int) -> None:
        found["plot"] = pl.inspect.parallel_coordinates(data, list(data), size=SIZE)

    run_ours(0)
    plot = found["plot"]
    peers: dict[str, Round] = {}
    if count > MATPLOTLIB_MOST:
        peers["NumPy, a column of pixels at a time"] = lambda _: count_with_numpy(plot)
        bare = pl.inspect.parallel_coordinates(data, list(data), size=SIZE, density=False)
        compare_pixels(subject, f"{count:,} curves", bare)
    elif is_installed("matplotlib"):
        peers["matplotlib (Agg)"] = MatplotlibCurves(plot).draw
    seconds = time_in_turn({**peers, "ours": run_ours}, PAIRS[count])
    own = find_median(seconds["ours"])
    work, gate = f"{count:,} curves, {AXIS_COUNT} axes, {SIZE[0]} × {SIZE[1]} pixels", GATES[count]
    limit = f"< {gate * 1e3:g} ms"
    if not peers:
        subject.rows.append(Row(work, "—", "—", format_seconds(own), "—", limit, own < gate))
    for name in peers:
        ratio = str(compare_speed(seconds[name], seconds["ours"]))
        peer = format_seconds(find_median(seconds[name]))
        subject.rows.append(Row(work, name, peer, format_seconds(own), ratio, limit, own < gate))


def measure() -> Subject:
    """Every number of `GATES`."""
    subject = Subject("Parallel coordinates, from arrays to the picture")
    subject.notes.append(
        "Three clusters of made-up photons, warm. Ours is the whole call: curves, densities of the axes, labels and "
        "the image in NumPy. The peers draw, or only count, the curves that ours has computed. At 100,000 the pixels "
        f"with curves must be those that NumPy counts, but for {DISAGREEMENT:.1%}."
    )
    if not is_installed("matplotlib"):
        subject.skipped.append("matplotlib: the package is not installed (pip install '.[bench]')")
    for count in GATES:
        measure_one(subject, count)
    return subject


if __name__ == "__main__":
    print_subject(measure())
