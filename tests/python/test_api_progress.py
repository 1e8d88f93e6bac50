# SPDX-License-Identifier: Apache-2.0
"""Long work tells how far it is and stops when asked to."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading

import numpy as np
import pytest

import photonloupe as pl
from photonloupe.progress import ProgressBar

# Says when tracing is under way, so that the interrupt arrives in the middle of it.
# Who starts the tests in the background passes on that interrupts are ignored.
INTERRUPTED = """
import signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
import photonloupe as pl
said = False
def progress(stage, fraction):
    global said
    if not said:
        print("tracing", flush=True)
        said = True
try:
    pl.trace_photons(pl.load_scene(sys.argv[1]), 20_000_000, progress=progress)
except (KeyboardInterrupt, pl.Cancelled):
    print("interrupted")
"""


def test_callback_hears_of_the_stage(ring: pl.Scene) -> None:
    heard: list[tuple[str, float]] = []
    pl.trace_photons(ring, 50_000, progress=lambda stage, fraction: heard.append((stage, fraction)))
    assert heard
    assert all(0.0 <= fraction <= 1.0 for _, fraction in heard)


def test_false_stops_tracing(ring: pl.Scene) -> None:
    with pytest.raises(pl.Cancelled):
        pl.trace_photons(ring, 5_000_000, progress=lambda stage, fraction: False)


def test_error_in_the_callback_comes_through(ring: pl.Scene) -> None:
    def fail(stage: str, fraction: float) -> None:
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        pl.trace_photons(ring, 5_000_000, progress=fail)


def test_false_stops_rendering(ring: pl.Scene, ring_map: pl.PhotonMap) -> None:
    with pytest.raises(pl.Cancelled):
        pl.render(ring, ring_map, width=512, height=512, samples=64, progress=lambda stage, fraction: False)


def test_work_after_a_stop_is_whole(ring: pl.Scene) -> None:
    whole = pl.trace_photons(ring, 10_000, seed=9)
    with pytest.raises(pl.Cancelled):
        pl.trace_photons(ring, 10_000_000, seed=9, progress=lambda stage, fraction: False)
    np.testing.assert_array_equal(pl.trace_photons(ring, 10_000, seed=9).positions, whole.positions)


def test_interrupt_stops_tracing(ring_path: os.PathLike[str]) -> None:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    command = [sys.executable, "-c", INTERRUPTED, os.fspath(ring_path)]
    pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "env": environment}
    with subprocess.Popen(command, **pipes) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "tracing\n"
        process.send_signal(signal.SIGINT)
        rest, errors = process.communicate(timeout=60)
        assert (rest, process.returncode) == ("interrupted\n", 0), errors


def test_bar_never_asks_to_stop(capsys: pytest.CaptureFixture[str]) -> None:
    bar = ProgressBar()
    assert bar("trace", 0.5)
    bar.close()
    assert "trace" in capsys.readouterr().err


def test_true_shows_a_bar(ring: pl.Scene, capsys: pytest.CaptureFixture[str]) -> None:
    pl.trace_photons(ring, 10_000, progress=True)
    assert "left" in capsys.readouterr().err


def test_render_reports_between_the_estimates_of_one_chunk(ring: pl.Scene) -> None:
    photons = pl.trace_photons(ring, 50_000)
    fractions: list[float] = []
    pl.render(ring, photons, width=128, height=128, samples=4, k=100, progress=lambda _, done: fractions.append(done))
    # 65,536 samples fit one chunk of eye paths; Ctrl-C must not wait for all their estimates.
    assert len({done for done in fractions if 0.0 < done < 1.0}) >= 3


@pytest.mark.parametrize("work", ["neighbors", "set_parameters", "share"])
def test_threads_wait_for_each_others_tree_without_the_lock_of_python(work: str) -> None:
    rng = np.random.default_rng(0)
    photons = pl.PhotonMap.from_arrays(
        positions=rng.random((100_000, 3)), normals=[[0, 1, 0]] * 100_000, power=np.ones((100_000, 3))
    )
    works = {
        "neighbors": lambda: photons.neighbors([0], 1),
        "set_parameters": lambda: photons.set_parameters(photons.positions[:, 0]),
        "share": photons.share,
    }
    others: list[threading.Thread] = []

    def start_other(stage: str, fraction: float) -> None:
        if not others:
            others.append(threading.Thread(target=works[work]))
            others[0].start()
            others[0].join(0.05)  # it cannot end before the tree is there, and must not keep us from going on

    found = photons.neighbors([0], 1, progress=start_other)[0]
    others[0].join()
    np.testing.assert_array_equal(photons.neighbors([0], 1)[0], found)
