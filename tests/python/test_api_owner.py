# SPDX-License-Identifier: Apache-2.0
"""The engine owns a map: columns are read-only, remembered results follow what was recorded since, threads may ask."""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl

RING = Path(__file__).resolve().parents[2] / "scenes" / "ring" / "ring.gltf"


def trace() -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(RING), count=2_000, seed=3)


def make_far() -> pl.PhotonMap:
    """A map whose origin is not the world's."""
    places = np.random.default_rng(0).random((500, 3)) + 1_000.0
    return pl.PhotonMap.from_arrays(positions=places, normals=[[0, 1, 0]] * 500, power=np.ones((500, 3)))


@pytest.mark.parametrize("make", [trace, make_far])
def test_columns_are_read_only(make: Callable[[], pl.PhotonMap]) -> None:
    photons = make()
    for name in photons.recorded:
        assert not getattr(photons, name).flags.writeable, name


def test_paths_recorded_since_are_in_what_was_remembered() -> None:
    photons = trace()
    before = photons.relax(steps=1)
    assert "path_offsets" not in before.recorded
    photons.record_paths()
    after = photons.relax(steps=1)
    assert "path_offsets" in after.recorded
    np.testing.assert_array_equal(after.positions, before.positions)


def test_map_that_was_saved_without_a_number_of_emitted_photons_records_paths(tmp_path: Path) -> None:
    trace().save(tmp_path / "old.zarr")
    store = tmp_path / "old.zarr" / "zarr.json"
    text = store.read_text()
    meta = json.loads(text)

    def set_zero(node: object) -> None:
        if isinstance(node, dict):
            for key, value in node.items():
                if key == "settings" and isinstance(value, dict):
                    value["emitted"] = 0
                set_zero(value)

    set_zero(meta)
    assert json.dumps(meta) != json.dumps(json.loads(text))
    store.write_text(json.dumps(meta))
    assert len(pl.load_photons(tmp_path / "old.zarr").path_vertices) > 0


def test_threads_ask_while_parameters_are_replaced() -> None:
    photons = make_far()
    values = np.random.default_rng(1).random((500, 2))
    photons.set_parameters(values)
    failures: list[Exception] = []

    def ask() -> None:
        try:
            for _ in range(100):
                assert photons.recorded
                photons.neighbors([1, 2, 3], 5, space="parameter")
        except Exception as error:
            failures.append(error)

    threads = [threading.Thread(target=ask) for _ in range(2)]
    for thread in threads:
        thread.start()
    while any(thread.is_alive() for thread in threads):
        photons.set_parameters(values)
    assert not failures


@pytest.mark.parametrize(
    ("name", "what"), [("steps", "a whole number"), ("limit", "a number"), ("thresholds", "2 numbers")]
)
def test_text_for_a_number_is_refused_by_what_it_must_be(name: str, what: str) -> None:
    with pytest.raises(pl.ArgumentError, match=f"{name} must be {what} or"):
        make_far().relax(**{name: "three"})


def test_numpy_scalars_count_as_numbers() -> None:
    relaxation = pl.Relaxation(make_far(), steps=1, descriptor="none", over_relaxation=np.float32(1.5))
    assert relaxation.settings["over_relaxation"] == [1.5, 1.5]
