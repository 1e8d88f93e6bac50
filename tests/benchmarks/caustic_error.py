# SPDX-License-Identifier: Apache-2.0
"""Measures the ring caustic's error against wall time, tracing included, and a SciPy photon map beside it."""

from __future__ import annotations

from typing import Any

import numpy as np
from caustic_truth import PATHS_PER_SET, RED, SETS, Truth, bin_photons, load_truth
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
from scene_data import RING, UP, WINDOW_CELLS, build_cell_centers, load_scene
from scipy_map import build_scipy_tree, estimate_with_scipy

import photonloupe as pl

# (photons, k, emission); the first is the peer's own setting.
WORK = ((1_000_000, 50, "random"), (200_000, 20, "sobol"), (200_000, 50, "sobol"), (1_000_000, 50, "sobol"))
ERROR_GATE, TIME_GATE = 0.052, 3.0  # units of the mean, s: our gate
CELL_AREA = (2.0 * RING.window_half / WINDOW_CELLS) ** 2  # m²


class Caustic:
    """One setting: trace, estimate, average over the cells; a new seed each round."""

    def __init__(self, count: int, k: int, emission: str) -> None:
        self.count, self.k, self.emission = count, k, emission
        self.points = build_cell_centers()
        self.photons: pl.PhotonMap | None = None
        self.middles: dict[str, NDArray[np.float32]] = {}  # estimate at the middle of each cell, red
        self.cells: dict[str, NDArray[np.floating]] = {}

    def run_ours(self, number: int) -> None:
        """From the scene to irradiance: trace, build, estimate."""
        scene = load_scene("ring")
        self.photons = pl.trace_photons(scene, self.count, seed=300 + number, emission=self.emission)
        self.finish("ours", self.photons, self.photons.irradiance(self.points, UP, k=self.k))

    def run_scipy(self, _: int) -> None:
        """From photons to irradiance: build, estimate."""
        if self.photons is None:
            raise RuntimeError("ours runs first and leaves its photons")
        power = np.ascontiguousarray(self.photons.power)
        tree = build_scipy_tree(np.ascontiguousarray(self.photons.positions))
        self.finish("scipy", self.photons, estimate_with_scipy(tree, power, self.points, self.k))

    def finish(self, name: str, photons: pl.PhotonMap, irradiance: NDArray[np.float32]) -> None:
        """Average: where more than k photons lie in a cell its support is smaller than the cell, so count them."""
        self.middles[name] = irradiance[:, RED]
        counted = bin_photons(photons)
        crowded = counted * CELL_AREA > self.k * photons.power[:, RED].max()
        self.cells[name] = np.where(crowded, counted, irradiance[:, RED])

    def format_errors(self, truth: Truth, name: str) -> str:
        """Error of the averaged cells, and of the bare estimate at their middles."""
        cells, middles = (truth.find_error(values[name]) for values in (self.cells, self.middles))
        return f"{cells:.3f} ({middles:.3f} at the middles)"


def measure_one(subject: Subject, truth: Truth, setting: tuple[int, int, str], *, with_peer: bool) -> dict[str, Any]:
    """One setting, the errors of its last round; returns errors and seconds of each."""
    caustic = Caustic(*setting)
    rounds: dict[str, Round] = {"ours": caustic.run_ours}
    if with_peer:
        rounds["scipy"] = caustic.run_scipy
    seconds = time_in_turn(rounds)
    found = {name: (truth.find_error(caustic.cells[name]), values) for name, values in seconds.items()}
    figures = {
        name: f"{caustic.format_errors(truth, name)} in {format_seconds(find_median(values))}"
        for name, values in seconds.items()
    }
    error, own = found["ours"][0], find_median(seconds["ours"])
    count, k, emission = setting
    subject.rows.append(
        Row(
            f"{count:,} photons, k = {k}, {emission} emission",
            "SciPy photon map, tracing not counted" if with_peer else "—",
            figures.get("scipy", "—"),
            figures["ours"],
            str(compare_speed(seconds["scipy"], seconds["ours"])) if with_peer else "—",
            f"{ERROR_GATE} in ≤ {TIME_GATE:g} s",
            error <= ERROR_GATE and own <= TIME_GATE,
        )
    )
    return found


def add_equal_error(subject: Subject, found: list[dict[str, Any]]) -> None:
    """Row for the fastest of our settings that is no worse than the peer in this run."""
    error, theirs = found[0]["scipy"]
    good = [
        (find_median(each["ours"][1]), each["ours"], row)
        for each, row in zip(found, subject.rows, strict=True)
        if each["ours"][0] <= error
    ]
    gate = f"the peer's error in ≤ {TIME_GATE:g} s"
    peer = f"{error:.3f} in {format_seconds(find_median(theirs))}"
    if not good:
        subject.rows.append(
            Row("fastest of ours at the peer's error", "SciPy photon map", peer, "none", "—", gate, False)
        )
        return
    own, (ours_error, _), row = min(good, key=lambda each: each[0])
    figure = f"{ours_error:.3f} in {format_seconds(own)} ({row.work})"
    work = "fastest of ours at the peer's error"
    subject.rows.append(Row(work, "SciPy photon map", peer, figure, "—", gate, own <= TIME_GATE))


def measure() -> Subject:
    """Every setting of `WORK`, the first against SciPy on the same photons."""
    truth = load_truth()
    subject = Subject("Caustic on a plane, 512² cells, error against time")
    subject.notes += [
        "The scene ring, red channel. Ours: trace, tree, irradiance at the middle of each cell, average; a new seed "
        "each round, wall time of all. Error: RMSE over the cells in units of the window's mean irradiance. A cell "
        "with more than k photons is counted instead of estimated, on both sides (its support is smaller than the "
        "cell); in brackets the error without that.",
        f"Truth: {SETS * PATHS_PER_SET:,} Sobol paths of our own tracer in {SETS} scramblings, binned; its own error, "
        f"from the spread of the {SETS}, is {truth.noise / truth.cells.mean():.4f} of the mean. "
        "The peer estimates from the photons ours traced in that round. In the last row the emissions differ: random "
        "for the peer, ours as named.",
        f"Of {ERROR_GATE} in units of the mean: a bare Epanechnikov estimate of k = 50 random photons has a noise of "
        "about 1/√48 = 0.144 of the local value or more (METHODS §8.8), so its RMSE in units of the mean lies above "
        "that; the gate is therefore taken to be in another unit, which it does not name. The last row "
        "puts the peer's own error in this run in its place: our reading, not the gate as written. It picks the "
        "fastest of our settings, which ran after the peer and not in turn with it, hence no ratio.",
    ]
    peer = is_installed("scipy")
    if not peer:
        subject.skipped.append("SciPy: the package scipy is not installed (pip install '.[bench]')")
    subject.skipped.append("Mitsuba ptracer, LuxCore, PhotonGI: not run here; only the SciPy photon map is the gate")
    found = [measure_one(subject, truth, setting, with_peer=peer and setting == WORK[0]) for setting in WORK]
    if peer:
        add_equal_error(subject, found)
    return subject


if __name__ == "__main__":
    print_subject(measure())
