# SPDX-License-Identifier: Apache-2.0
"""Histograms, scatter plots and error maps agree with NumPy and with what else the program measures."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest

import photonloupe as pl
from conftest import make_columns


@cache
def get_map() -> pl.PhotonMap:
    photons = pl.PhotonMap.from_arrays(**make_columns(5_000, seed=3))
    rng = np.random.default_rng(0)
    values = np.stack([rng.normal(size=5_000), rng.uniform(-np.pi, np.pi, 5_000), rng.integers(0, 4, 5_000)], axis=1)
    values[::20] = np.nan
    photons.set_parameters(values, ["bell", "phi", "kind"], [(0, 0), (-np.pi, np.pi), (0, 3)], [False, True, False])
    return photons


@pytest.mark.parametrize("name", ["x", "bell", "phi", "kind", "ny"])
@pytest.mark.parametrize("bins", [1, 7, 64, 1000])
def test_histograms_are_numpys(name: str, bins: int) -> None:
    found = pl.inspect.histogram(get_map(), name, bins)
    values = found.column.values[np.isfinite(found.column.values)].astype(np.float64)
    counts, edges = np.histogram(values, bins, (found.column.low, found.column.high))
    np.testing.assert_array_equal(found.counts, counts)
    np.testing.assert_allclose(found.edges, edges, rtol=1e-15, atol=1e-15)
    assert found.non_finite == len(found.column.values) - len(values)
    assert found.counts.sum() + found.below + found.above + found.non_finite == len(get_map())
    np.testing.assert_allclose(found.cdf, (found.below + np.cumsum(counts)) / len(values))


def test_histograms_of_a_range_count_what_lies_outside() -> None:
    found = pl.inspect.histogram(get_map(), "bell", 16, (-1.0, 0.5))
    values = found.column.values
    assert found.below == np.count_nonzero(values < -1.0)
    assert found.above == np.count_nonzero(values > 0.5)
    assert found.below > 0
    assert found.above > 0
    assert found.cdf[-1] == pytest.approx(1.0 - found.above / np.count_nonzero(np.isfinite(values)))


@pytest.mark.parametrize("share", [0.0, 0.05, 0.5, 0.95, 1.0])
def test_quantiles_are_numpys(share: float) -> None:
    found = pl.inspect.histogram(get_map(), "bell")
    expected = np.nanquantile(found.column.values.astype(np.float64), share)
    assert found.quantile(share) == pytest.approx(expected, rel=1e-12)


def test_histograms_of_nothing_are_empty() -> None:
    photons = pl.PhotonMap.from_arrays(**make_columns(0))
    found = pl.inspect.histogram(photons, "x", 4)
    assert found.counts.tolist() == [0, 0, 0, 0]
    assert np.isnan(found.quantile(0.5))
    one = pl.inspect.histogram(pl.PhotonMap.from_arrays(**make_columns(1)), "x", 3)
    assert one.counts.tolist() == [0, 1, 0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"bins": 0}, "bins"),
        ({"bins": 1 << 20}, "bins"),
        ({"range": (1.0, 0.0)}, "range runs from 1 down to 0"),
        ({"range": (0.0, np.inf)}, "range"),
        ({"range": (0.0, 1.0, 2.0)}, "range must be"),
        ({"name": "w"}, "no column 'w'"),
    ],
)
def test_wrong_histograms_are_refused_by_name(arguments: dict, words: str) -> None:
    with pytest.raises(pl.ArgumentError, match=words):
        pl.inspect.histogram(get_map(), **{"name": "x", **arguments})


def test_scatter_points_lie_in_proportion() -> None:
    plot = pl.inspect.scatter(get_map(), "x", "bell", (300, 200))
    x, bell = get_map().positions[:, 0], pl.inspect.column(get_map(), "bell").values
    low, high = plot.x_range
    assert (low, high) == (x.min(), x.max())
    column, row = plot.pixels.T
    known = np.isfinite(bell)
    np.testing.assert_array_equal(np.isfinite(row), known)
    np.testing.assert_allclose(np.corrcoef(column, x)[0, 1], 1.0, atol=1e-12)
    np.testing.assert_allclose(np.corrcoef(row[known], bell[known])[0, 1], -1.0, atol=1e-12)  # up is down in a picture
    # Splats of 1.5 pixels leave two at each side.
    assert (column.min(), column.max()) == pytest.approx((2.0, 298.0))
    assert (row[known].min(), row[known].max()) == pytest.approx((2.0, 198.0))
    assert plot.drawn == np.count_nonzero(known)
    for i in np.flatnonzero(known)[:50]:
        assert plot.to_data(column[i], row[i]) == pytest.approx((x[i], bell[i]), abs=1e-6)
        assert plot.rgba[int(row[i]), int(column[i]), 3] == 255


def test_polar_points_lie_as_the_planar_form(ring_map: pl.PhotonMap) -> None:
    photons = ring_map.select(np.arange(2_000))
    plot = pl.inspect.scatter(photons, "primal_phi", "primal_theta", (400, 400), polar=True)
    u, v = (pl.inspect.column(photons, name).values for name in ("primal_u", "primal_v"))
    scale = 198.0 / plot.y_range[1]
    np.testing.assert_allclose(plot.pixels, np.stack([200 + scale * u, 200 - scale * v], axis=1), atol=1e-3)
    assert plot.y_range[0] == 0.0


def test_a_selection_stands_out_from_grey() -> None:
    photons = get_map()
    chosen = np.flatnonzero(photons.positions[:, 0] > 0.0)
    plot = pl.inspect.scatter(photons, "x", "y", (256, 256), selection=chosen, color="z")
    middle = int(np.interp(0.0, plot.x_range, (2, 254)))
    left = plot.rgba[:, : middle - 3].reshape(-1, 4).astype(int)
    right = plot.rgba[:, middle + 3 :].reshape(-1, 4).astype(int)
    shown = left[left[:, 3] > 0][:, :3]
    assert (shown.max(axis=1) == shown.min(axis=1)).all()
    shown = right[right[:, 3] > 0][:, :3]
    assert (shown.max(axis=1) > shown.min(axis=1)).mean() > 0.9


def test_masks_and_ids_select_alike() -> None:
    mask = get_map().positions[:, 0] > 0.0
    by_mask = pl.inspect.scatter(get_map(), "x", "y", selection=mask)
    by_ids = pl.inspect.scatter(get_map(), "x", "y", selection=np.flatnonzero(mask))
    np.testing.assert_array_equal(by_mask.rgba, by_ids.rgba)


def test_dense_plots_show_how_many_points_lie_where() -> None:
    plot = pl.inspect.scatter(get_map(), "x", "y", (32, 32), dense_from=0)
    assert plot.dense
    counts = np.zeros((32, 32), dtype=int)
    column, row = plot.pixels.astype(int).T
    np.add.at(counts, (row, column), 1)
    expected = np.round(255 * np.log1p(counts) / np.log1p(counts.max()))
    assert np.abs(plot.rgba[..., 3].astype(int) - expected).max() <= 1


@pytest.mark.parametrize("count", [0, 1, 2])
@pytest.mark.parametrize("polar", [False, True])
def test_few_photons_make_a_plot(count: int, polar: bool) -> None:
    plot = pl.inspect.scatter(pl.PhotonMap.from_arrays(**make_columns(count)), "x", "y", (16, 16), polar)
    assert plot.drawn == count
    assert np.isfinite(np.asarray(plot.image)).all()


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"x": "q"}, "no column 'q'"),
        ({"size": (0, 5)}, r"size\[0\]"),
        ({"size": (5,)}, "size must be"),
        ({"selection": [5_000]}, "5000"),
        ({"color": "red?"}, "no column 'red"),
        ({"y": "drift"}, "not relaxed"),
    ],
)
def test_wrong_plots_are_refused_by_name(arguments: dict, words: str) -> None:
    with pytest.raises(pl.ArgumentError, match=words):
        pl.inspect.scatter(get_map(), **{"x": "x", "y": "y", **arguments})


def test_errors_are_those_of_comparing_images() -> None:
    rng = np.random.default_rng(1)
    a, b = rng.random((12, 9, 3)).astype(np.float32), rng.random((12, 9, 3)).astype(np.float32)
    found, compared = pl.inspect.error_map(pl.Image(a), b), pl.compare_images(a, b)
    assert found.rmse == pytest.approx(compared.rmse, rel=1e-9)
    assert found.relmse == pytest.approx(compared.relmse, rel=1e-9)
    weights = np.array([0.2126, 0.7152, 0.0722])
    away = np.abs(a.astype(np.float64) - b)
    np.testing.assert_allclose(found.absolute, away @ weights, rtol=1e-5)
    scale = np.sqrt(b.astype(np.float64) ** 2 + 0.01 * b.mean(dtype=np.float64) ** 2)
    np.testing.assert_allclose(found.relative, (away / scale) @ weights, rtol=1e-5)
    brightness = np.asarray(found.image).sum(axis=2)
    assert np.unravel_index(brightness.argmax(), brightness.shape) == np.unravel_index(
        found.absolute.argmax(), found.absolute.shape
    )


def test_images_that_cannot_be_compared_are_refused() -> None:
    flat = np.ones((4, 4, 3))
    with pytest.raises(pl.ArgumentError, match="4 × 4 and 3 × 4 pixels"):
        pl.inspect.error_map(flat, np.ones((4, 3, 3)))
    odd = flat.copy()
    odd[2, 1, 0] = np.nan
    with pytest.raises(pl.ArgumentError, match=r"the image has 1 pixels that are not finite .* row 2, column 1"):
        pl.inspect.error_map(odd, flat)
    with pytest.raises(pl.ArgumentError, match=r"the reference must have shape \(h, w, 3\)"):
        pl.inspect.error_map(flat, np.ones((4, 4)))
    assert pl.inspect.error_map(flat, flat).rmse == 0.0
