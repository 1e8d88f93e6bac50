# SPDX-License-Identifier: Apache-2.0
"""Extremes of a user's own photons and arguments: few, coincident, not finite, too many."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
import twins
from conftest import make_columns
from extremes_scenes import load_lit_floor
from extremes_table import add_row, show

UP = np.array([0.0, 1.0, 0.0])
POINTS = np.array([[0.5, 0.0, 0.5], [0.2, 0.0, 0.9], [0.0, 0.0, 0.0]])
# As in the tests of irradiance itself.
TOLERANCE = 2e-4
NOT_FINITE = (np.nan, np.inf, -np.inf)


def build(positions: NDArray[np.float64], power: float = 1.0) -> pl.PhotonMap:
    count = len(positions)
    return pl.PhotonMap.from_arrays(
        positions=positions, normals=np.tile(UP, (count, 1)), power=np.full((count, 3), power)
    )


def make_floor(count: int) -> NDArray[np.float64]:
    return np.random.default_rng(1).random((count, 3)) * (1.0, 0.0, 1.0)


def measure_irradiance(positions: NDArray[np.float64], k: int, points: NDArray[np.float64] = POINTS) -> float:
    """Largest error against the twin, as a share of the photons' flux over their disc: their weights may cancel."""
    photons = build(positions)
    found = photons.irradiance(points, UP, k=k)
    assert np.isfinite(found).all()
    facing = np.tile(UP, (len(points), 1))
    exact = photons.positions.astype(float)
    truth = twins.estimate_irradiance(exact, photons.normals, photons.power, points.astype(np.float32), facing, k)
    used = min(k, len(positions))
    radius = twins.find_neighbors(exact, points, used)[1][:, -1:]
    return float((np.abs(found - truth) * np.pi * radius**2 / used).max())


def test_no_photons_give_no_light_and_no_neighbors() -> None:
    photons = build(make_floor(0))
    assert not photons.irradiance(POINTS, UP, k=10).any()
    ids, distances = photons.neighbors(POINTS, 10)
    assert (ids == -1).all()
    assert np.isposinf(distances).all()
    add_row("photons-0", "checked")


def test_few_photons_give_the_twins_irradiance() -> None:
    error = max(measure_irradiance(make_floor(count), 10) for count in (1, 2, 10, 11))
    add_row("photons-few", f"error {show(error)}")
    assert error < TOLERANCE


def test_photons_at_one_point_tie_by_id_and_stay_finite() -> None:
    photons = build(np.tile([0.5, 0.0, 0.5], (1000, 1)))
    ids, distances = photons.neighbors(POINTS[:1], 1000)
    np.testing.assert_array_equal(ids[0], np.arange(1000))
    assert not distances.any()
    for k in (1, 10, 1000):
        estimate = photons.irradiance(POINTS, UP, k=k)
        assert np.isfinite(estimate).all()
        assert (estimate[0] > 0.0).all()
    add_row("one-point", f"{show(float(estimate[0, 0]))} W/m² there, {show(float(estimate[1, 0]))} beside")


def test_photons_on_one_line_give_the_twins_irradiance() -> None:
    line = make_floor(1000)
    line[:, 2] = 0.5
    points = np.array([[0.5, 0.0, 0.5], [0.3, 0.0, 0.52], [-1.0, 0.0, 0.5]])
    error = max(measure_irradiance(line, k, points) for k in (1, 10, 100))
    add_row("one-line", f"error {show(error)}")
    assert error < TOLERANCE


@pytest.mark.parametrize(("case", "count", "k"), [("k-1", 3000, 1), ("k-1000", 300, 1000)])
def test_extreme_k_gives_the_twins_irradiance(case: str, count: int, k: int) -> None:
    error = measure_irradiance(make_floor(count), k)
    add_row(case, f"error {show(error)}")
    assert error < TOLERANCE


def test_extreme_flux_scales_through() -> None:
    usual = build(make_floor(500)).irradiance(POINTS, UP, k=20).astype(float)
    error = 0.0
    for flux in (1e-30, 1e-20, 1e20, 1e30):
        extreme = build(make_floor(500), flux).irradiance(POINTS, UP, k=20) / flux
        error = max(error, float(np.abs(extreme / usual - 1.0).max()))
    add_row("flux", f"error {show(error)}")
    assert error < 1e-5


def test_user_columns_that_are_not_finite_are_refused() -> None:
    columns = make_columns(20)
    names = [name for name, column in columns.items() if column.dtype.kind == "f"]
    for name in names:
        for value in NOT_FINITE:
            bad = columns[name].copy()
            bad.reshape(len(bad), -1)[7, 0] = value
            with pytest.raises(pl.ArgumentError, match=rf"{name}\[7\].*(NaN|infinite)"):
                pl.PhotonMap.from_arrays(**{**columns, name: bad})  # type: ignore[arg-type]
    add_row("not-finite", str(len(names)))


def test_query_arrays_that_are_not_finite_are_refused() -> None:
    photons = build(make_floor(10))
    for value in NOT_FINITE:
        bad = POINTS.copy()
        bad[1, 2] = value
        for query in (
            lambda bad=bad: photons.neighbors(bad, 1),
            lambda bad=bad: photons.irradiance(bad, UP, k=1),
        ):
            with pytest.raises(pl.ArgumentError, match=r"points\[1\]\[2\]"):
                query()
        with pytest.raises(pl.ArgumentError, match=r"normals\[1\]\[2\]"):
            photons.irradiance(POINTS, bad, k=1)
    add_row("points-not-finite", "3")


def test_vertices_that_are_not_finite_are_refused(tmp_path: Path) -> None:
    values = (*NOT_FINITE, 1e31)
    for value in values:
        load_lit_floor(tmp_path)
        path = tmp_path / "lit.bin"
        content = np.frombuffer(path.read_bytes(), np.uint8).copy()
        content[:4] = np.frombuffer(np.float32(value).tobytes(), np.uint8)
        path.write_bytes(content.tobytes())
        with pytest.raises(pl.SceneError):
            pl.load_scene(tmp_path / "lit.gltf")
    add_row("vertex-not-finite", str(len(values)))


@pytest.fixture
def scene(tmp_path: Path) -> pl.Scene:
    return load_lit_floor(tmp_path)


def test_more_photons_than_ids_are_refused(scene: pl.Scene) -> None:
    with pytest.raises(pl.ArgumentError, match=r"count must be from 1 to 2147483647"):
        pl.trace_photons(scene, 2**31, store="all")
    add_row("count-limit", "message checked")


def test_more_photons_than_memory_are_refused_with_what_fits(scene: pl.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PHOTONLOUPE_MEMORY_LIMIT", str(2**30))
    with pytest.raises(pl.DeviceMemoryError, match=r"\d+ photons fit, 2147483647 asked"):
        pl.trace_photons(scene, 2**31 - 1, store="all")
    add_row("memory-limit", "message checked")


def test_more_emitted_photons_than_indices_are_refused(scene: pl.Scene) -> None:
    with pytest.raises(pl.ArgumentError, match=r"emitted must be from 1 to 1073741824"):
        pl.trace_photons(scene, emitted=2**30 + 1, store="all")
    add_row("emitted-limit", "message checked")


def test_k_out_of_range_is_refused() -> None:
    photons = build(make_floor(10))
    for k in (0, 1001):
        with pytest.raises(pl.ArgumentError, match="k must be from 1 to 1000"):
            photons.neighbors(POINTS, k)
        with pytest.raises(pl.ArgumentError, match="k must be from 1 to 1000"):
            photons.irradiance(POINTS, UP, k=k)
    add_row("k-limit", "message checked")


def test_id_beyond_the_map_is_refused() -> None:
    with pytest.raises(pl.ArgumentError, match=r"ids\[1\] = 2147483648 is not a photon"):
        build(make_floor(10)).neighbors(np.array([3, 2**31]), 1)
    add_row("id-limit", "message checked")
