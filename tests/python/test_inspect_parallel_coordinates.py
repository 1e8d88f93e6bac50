# SPDX-License-Identifier: Apache-2.0
"""Parallel coordinates from Python: arrays against NumPy and SciPy, files, extremes, refusals."""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy import stats
from scipy.interpolate import PchipInterpolator

import photonloupe as pl
from conftest import find_scene
from photonloupe.inspect import Axis, ParallelCoordinates, parallel_coordinates

COUNT = 250
# Single precision on an image of a thousand pixels.
PIXEL_ROUNDING = 2e-3
# Of the peak: values are put on bins, and kernels end at five deviations.
BINNING = 2e-3
SVG = "{http://www.w3.org/2000/svg}"


def make_data(count: int = COUNT, seed: int = 0) -> dict[str, NDArray[np.float32]]:
    rng = np.random.default_rng(seed)
    return {
        "a": rng.normal(2.0, 0.5, count).astype(np.float32),
        "b": rng.random(count).astype(np.float32),
        "phi": rng.uniform(0.0, 6.0, count).astype(np.float32),
        "edges": rng.integers(2, 6, count).astype(np.float32),
    }


def plot(data: Mapping[str, Any] | None = None, **settings: Any) -> ParallelCoordinates:
    data = make_data() if data is None else data
    return parallel_coordinates(data, list(data), **settings)


def find_axis_x(plotted: ParallelCoordinates, axis: int) -> float:
    return float(plotted.points[0, axis, 0])


def test_values_are_the_columns_in_the_order_of_the_axes() -> None:
    data = make_data()
    plotted = parallel_coordinates(data, ["phi", "a"])
    np.testing.assert_array_equal(plotted.values, np.stack([data["phi"], data["a"]], axis=1))
    assert [axis.name for axis in plotted.axes] == ["phi", "a"]


def test_points_of_an_open_axis_are_linear_in_the_value() -> None:
    data = make_data()
    plotted = plot(data)
    low, high = data["a"].min(), data["a"].max()
    bottom, top = plotted.points[:, 0, 1].max(), plotted.points[:, 0, 1].min()
    expected = bottom + (data["a"] - low) / (high - low) * (top - bottom)
    np.testing.assert_allclose(plotted.points[:, 0, 1], expected, atol=PIXEL_ROUNDING)
    assert np.ptp(plotted.points[:, 0, 0]) == 0


@pytest.mark.parametrize("periods", [1, 3])
def test_points_of_a_closed_axis_lie_on_its_ellipse(periods: int) -> None:
    data = make_data()
    plotted = parallel_coordinates(data, ["a", Axis("phi", 0.0, 6.0, closed=True, periods=periods), "b"])
    angle = 2 * np.pi * periods * data["phi"].astype(np.float64) / 6.0
    x, y = plotted.points[:, 1].T.astype(np.float64)
    rx, ry = np.ptp(x) / 2, np.ptp(y) / 2
    middle = (find_axis_x(plotted, 0) + find_axis_x(plotted, 2)) / 2
    fitted = np.linalg.lstsq(np.stack([np.sin(angle), np.ones(COUNT)], axis=1), x, rcond=None)
    assert fitted[0][1] == pytest.approx(middle, abs=0.51)  # axes stand on whole pixels
    np.testing.assert_allclose(x, fitted[0][1] + fitted[0][0] * np.sin(angle), atol=PIXEL_ROUNDING)
    vertical = np.linalg.lstsq(np.stack([np.cos(angle), np.ones(COUNT)], axis=1), y, rcond=None)
    np.testing.assert_allclose(y, vertical[0][1] + vertical[0][0] * np.cos(angle), atol=PIXEL_ROUNDING)
    assert rx > 10
    assert ry > 100


def test_inner_tangents_are_scipys_monotone_ones() -> None:
    plotted = plot(closed=["phi"])
    for i in range(COUNT):
        x, y = plotted.points[i].T.astype(np.float64)
        expected = PchipInterpolator(x, y).derivative()(x)
        np.testing.assert_allclose(plotted.tangents[i, :-1, 1], expected[1:-1], rtol=1e-4, atol=1e-5)
        np.testing.assert_allclose(plotted.tangents[i, 1:, 0], expected[1:-1], rtol=1e-4, atol=1e-5)


def test_no_tension_gives_straight_lines() -> None:
    plotted = plot(tension=0.0)
    step = np.diff(plotted.points, axis=1)
    slope = step[..., 1] / step[..., 0]
    np.testing.assert_allclose(plotted.tangents, np.stack([slope, slope], axis=-1), rtol=1e-5, atol=1e-6)


@pytest.mark.parametrize("name", ["a", "b"])
def test_density_is_scipys(name: str) -> None:
    data = make_data()
    plotted = plot(data)
    i = list(data).index(name)
    density = plotted.density[i]
    low, high = plotted.axes[i].low, plotted.axes[i].high
    assert low is not None
    assert high is not None
    values = data[name].astype(np.float64)
    quartiles = np.quantile(values, [0.25, 0.75])
    spread = min(values.std(ddof=1), float(np.diff(quartiles)[0]) / 1.34)
    assert density.bandwidth == pytest.approx(0.9 * spread * COUNT**-0.2, rel=1e-5)
    peer = stats.gaussian_kde(values, bw_method=density.bandwidth / values.std(ddof=1))
    expected = peer(low + density.positions * (high - low))
    np.testing.assert_allclose(density.heights * density.peak, expected, atol=BINNING * expected.max())
    assert density.heights.max() == 1.0


def test_density_of_a_closed_axis_wraps() -> None:
    data = {"a": make_data()["a"], "phi": np.abs(np.random.default_rng(1).normal(0, 0.5, COUNT)).astype(np.float32)}
    density = parallel_coordinates(data, ["a", Axis("phi", 0.0, 6.0, closed=True)]).density[1]
    copies = np.concatenate([data["phi"] + turn for turn in (-6.0, 0.0, 6.0)]).astype(np.float64)
    places = 6.0 * density.positions[:, None]
    kernels = np.exp(-0.5 * ((places - copies) / density.bandwidth) ** 2)
    expected = kernels.sum(axis=1) / (density.bandwidth * np.sqrt(2 * np.pi) * COUNT)
    np.testing.assert_allclose(density.heights * density.peak, expected, atol=BINNING * expected.max())


def test_whole_numbers_of_few_values_have_bars() -> None:
    data = make_data()
    density = plot(data).density[3]
    values, counts = np.unique(data["edges"], return_counts=True)
    assert density.is_bars
    np.testing.assert_allclose(density.positions, (values - 2) / 3, atol=1e-6)
    np.testing.assert_allclose(density.heights, counts / counts.max(), rtol=1e-6)


def test_brushes_select_what_a_mask_does() -> None:
    data = make_data()
    plotted = plot(data, brushes={"a": [(1.5, 1.8), (2.2, 2.5)], "b": [(0.2, 0.9)]})
    a, b = data["a"], data["b"]
    inside = ((a >= 1.5) & (a <= np.float32(1.8))) | ((a >= np.float32(2.2)) & (a <= 2.5))
    expected = np.flatnonzero(inside & (b >= np.float32(0.2)) & (b <= np.float32(0.9)))
    assert 5 < len(expected) < COUNT / 2
    np.testing.assert_array_equal(plotted.selected, expected)


def test_brush_on_a_closed_axis_goes_on_through_the_ends() -> None:
    data = make_data()
    plotted = parallel_coordinates(data, ["a", Axis("phi", 0.0, 6.0, closed=True, brush=[(5.0, 1.0)])])
    np.testing.assert_array_equal(plotted.selected, np.flatnonzero((data["phi"] >= 5) | (data["phi"] <= 1)))


def test_selection_and_brushes_are_anded() -> None:
    data = make_data()
    mask = np.arange(COUNT) % 2 == 0
    plotted = plot(data, selection=mask, brushes={"b": [(0.5, 1.0)]})
    np.testing.assert_array_equal(plotted.selected, np.flatnonzero(mask & (data["b"] >= 0.5)))
    np.testing.assert_array_equal(plot(data, selection=[7, 3]).selected, [3, 7])


def test_context_is_grey_beneath_the_selection() -> None:
    data = {"a": np.array([0.0, 1.0]), "b": np.array([0.0, 1.0])}
    pixels = np.asarray(plot(data, selection=[1], color=np.array([[1, 0, 0], [1, 0, 0]]), density=False).image)
    high, low = pixels[34, 450], pixels[330 - 1, 450]
    assert high[0] > 2 * high[1], "red"
    assert np.ptp(low) < 1e-3, "grey"
    assert low[0] < 0.9


def test_photons_without_a_value_break_and_are_counted() -> None:
    data = make_data()
    data["b"][4] = np.nan
    data["a"][9] = np.inf
    plotted = plot(data, brushes={"b": [(-1.0, 2.0)]})
    assert plotted.broken == 2
    assert 4 not in plotted.selected
    assert np.isnan(plotted.points[4, 1]).all()
    assert np.isnan(plotted.tangents[4, :2]).all()
    assert not np.isnan(plotted.tangents[4, 2]).any()


@pytest.mark.parametrize("count", [0, 1, 2, 2000, 2001])
def test_any_number_of_photons_has_a_picture(count: int) -> None:
    plotted = plot(make_data(count))
    assert np.asarray(plotted.image).shape == (360, 900, 3)
    assert plotted.is_density == (count == 2001)
    assert len(plotted.selected) == count


EXTREMES: dict[str, Callable[[dict[str, NDArray[np.float32]]], Any]] = {
    "equal": lambda data: data["a"].fill(3.0),
    "all missing": lambda data: data["a"].fill(np.nan),
    "huge": lambda data: data["a"].__setitem__(0, 1e30),
    "largest": lambda data: data["a"].__setitem__(slice(0, 2), [3e38, -3e38]),
    "tiny": lambda data: data["a"].__imul__(1e-38),
}


@pytest.mark.parametrize("change", EXTREMES)
@pytest.mark.parametrize("closed", [(), ("a",)])
def test_extreme_values_keep_everything_finite(change: str, closed: tuple[str, ...]) -> None:
    data = make_data()
    EXTREMES[change](data)
    plotted = plot(data, closed=closed)
    assert np.isfinite(np.asarray(plotted.image)).all()
    known = ~np.isnan(plotted.values)
    assert np.isfinite(plotted.points[known]).all()
    for density in plotted.density:
        assert np.all((density.heights >= 0) & (density.heights <= 1))


def test_one_axis_shows_its_density_alone() -> None:
    plotted = parallel_coordinates(make_data(), ["a"])
    assert plotted.tangents.shape == (COUNT, 0, 2)
    assert len(plotted.density) == 1
    assert np.asarray(plotted.image).min() < 0.5


@pytest.mark.parametrize("count", [COUNT, 3000])
def test_same_bits_in_two_runs(count: int) -> None:
    data = make_data(count)
    first, second = (plot(data, closed=["phi"]) for _ in range(2))
    np.testing.assert_array_equal(np.asarray(first.image), np.asarray(second.image))


def test_map_has_its_positions_and_parameters_as_axes() -> None:
    rng = np.random.default_rng(5)
    positions = rng.random((60, 3)).astype(np.float32)
    photons = pl.PhotonMap.from_arrays(positions=positions, normals=[[0, 1, 0]] * 60, power=np.ones((60, 3)))
    angles = rng.uniform(0, 3, 60).astype(np.float32)
    photons.set_parameters(angles, ["angle"], [[0.0, 3.0]], [True])
    plotted = parallel_coordinates(photons, ["x", "angle", "z"])
    np.testing.assert_array_equal(plotted.values, np.stack([positions[:, 0], angles, positions[:, 2]], axis=1))
    assert [axis.closed for axis in plotted.axes] == [False, True, False]
    assert (plotted.axes[1].low, plotted.axes[1].high) == (0.0, 3.0)


def test_map_has_every_column_as_axis() -> None:
    photons = pl.trace_photons(pl.load_scene(find_scene("ring")), 2_000, seed=1)
    photons.set_parameters(photons.positions[:, 0], ["x"], [[-3.0, 3.0]])
    names = ["primal_theta", "primal_phi", "signature", "parameter.x", "x"]
    plotted = parallel_coordinates(photons, names)
    expected = [pl.inspect.column(photons, name) for name in names]
    np.testing.assert_array_equal(plotted.values, np.stack([column.values for column in expected], axis=1))
    assert [axis.closed for axis in plotted.axes] == [False, True, False, False, False]
    assert [(axis.low, axis.high) for axis in plotted.axes] == [(column.low, column.high) for column in expected]
    assert [density.is_bars for density in plotted.density] == [False, False, True, False, False]


def test_column_that_a_map_lacks_is_refused_with_what_to_do() -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.eye(3), normals=[[0, 1, 0]] * 3, power=np.ones((3, 3)))
    with pytest.raises(pl.ArgumentError, match="'alpha'; the columns are x, y, z"):
        parallel_coordinates(photons, ["alpha"])
    with pytest.raises(pl.ArgumentError, match=r"tortuosity.*path"):
        parallel_coordinates(photons, ["tortuosity"])


def test_selection_and_size_follow_the_axes() -> None:
    data = make_data()
    plotted = parallel_coordinates(data, ["a", "b"], [5, 2], (300, 200))
    np.testing.assert_array_equal(plotted.selected, [2, 5])
    assert np.asarray(plotted.image).shape == (200, 300, 3)


def test_svg_stands_alone(tmp_path: Path) -> None:
    data = {"a<b": make_data()["a"], "phi": make_data()["phi"], "edges": make_data()["edges"]}
    plotted = plot(data, closed=["phi"], brushes={"a<b": [(1.9, 2.1)]})
    plotted.save_svg(tmp_path / "plot.svg")
    root = ET.parse(tmp_path / "plot.svg").getroot()
    paths = [path.get("d") or "" for path in root.iter(f"{SVG}path")]
    assert len(paths) == COUNT
    assert all(path.count("C") == 2 and path.count("M") == 1 for path in paths)
    assert len(list(root.iter(f"{SVG}ellipse"))) == 1
    texts = [text.text for text in root.iter(f"{SVG}text")]
    assert {"a<b", "phi", "edges", "2", "5"} <= set(texts)
    assert len(list(root.iter(f"{SVG}polygon"))) == 2 + 4 + 1, "two densities, four bars, one brush"


def test_svg_curves_are_the_arrays(tmp_path: Path) -> None:
    plotted = plot()
    plotted.save_svg(tmp_path / "plot.svg")
    path = next(ET.parse(tmp_path / "plot.svg").getroot().iter(f"{SVG}path")).get("d") or ""
    numbers = np.array(re.findall(r"-?\d+\.\d+", path), dtype=float).reshape(-1, 2)
    np.testing.assert_allclose(numbers[0], plotted.points[0, 0], atol=0.01)
    np.testing.assert_allclose(numbers[3::3], plotted.points[0, 1:], atol=0.01)
    third = (plotted.points[0, 1, 0] - plotted.points[0, 0, 0]) / 3
    np.testing.assert_allclose(numbers[1, 1], numbers[0, 1] + third * plotted.tangents[0, 0, 0], atol=0.02)


def test_svg_of_many_curves_holds_their_picture(tmp_path: Path) -> None:
    plotted = plot(make_data(2500))
    plotted.save_svg(tmp_path / "plot.svg")
    root = ET.parse(tmp_path / "plot.svg").getroot()
    assert not list(root.iter(f"{SVG}path"))
    image = next(root.iter(f"{SVG}image"))
    assert (image.get("href") or "").startswith("data:image/png;base64,iVBOR")


def test_png_is_written(tmp_path: Path) -> None:
    plotted = plot(size=(400, 200))
    plotted.image.save(tmp_path / "plot.png")
    np.testing.assert_allclose(np.asarray(pl.load_image(tmp_path / "plot.png")), np.asarray(plotted.image), atol=1e-4)


def test_svg_that_cannot_be_written_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(pl.FileFormatError, match="missing"):
        plot().save_svg(tmp_path / "missing" / "plot.svg")
    with pytest.raises(pl.ArgumentError, match=r"\.svg"):
        plot().save_svg(tmp_path / "plot.txt")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"axes": []}, "at least one"),
        ({"axes": "a"}, "at least one"),
        ({"axes": ["c"]}, "'c'; there are a, b, phi, edges"),
        ({"axes": [Axis("a", 2.0, 1.0)]}, "axis a runs from 2 down to 1"),
        ({"axes": [Axis("a", np.nan)]}, "axis a: low"),
        ({"axes": [Axis("a", periods=0)]}, "axis a: periods"),
        ({"axes": [Axis("a", brush=[(2.0, 1.0)])]}, "axis a: brush"),
        ({"brushes": {"c": [(0, 1)]}}, "'c'"),
        ({"closed": ["c"]}, "'c'"),
        ({"brushes": {"a": [0.5]}}, "pair"),
        ({"tension": 1.5}, "tension"),
        ({"size": (900, 20)}, r"size\[1\]"),
        ({"size": (116, 360)}, "no room"),
        ({"size": (900, 360, 3)}, "width, height"),
        ({"selection": [COUNT]}, "is not a photon"),
        ({"color": np.zeros((3, 3))}, "color"),
        ({"color": "c"}, "'c'"),
    ],
)
def test_refusals_say_what_and_where(arguments: dict[str, Any], message: str) -> None:
    data = make_data()
    with pytest.raises(pl.ArgumentError, match=message):
        parallel_coordinates(data, **({"axes": list(data)} | arguments))


def test_arrays_of_different_length_are_refused() -> None:
    with pytest.raises(pl.ArgumentError, match="b has 3 values, a has 2"):
        parallel_coordinates({"a": [1, 2], "b": [1, 2, 3]}, ["a", "b"])
