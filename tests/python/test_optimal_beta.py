# SPDX-License-Identifier: Apache-2.0
"""The choice of β: isotropy as the naive twin's, and the closed form of a linear map from parameters to the world."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from constraint_twins import Beta, optimal_beta
from point_sets import make_random
from twin_pairs import TILT, UP, make_layers, make_pair

COUNT = 500
# Enough that the border, about which neighbors lie on one side, holds few of the photons.
MANY = 20_000
NEIGHBORS = 100
# Isotropy that 5 % of k = 100 uniform points stay below (METHODS section 5.2).
QUANTILE = 0.82


@cache
def measure(shape: str, k: int) -> tuple[pl.OptimalBeta, Beta]:
    """Return the program's β and the twin's, of two emitters, some photons unset, one parameter periodic."""
    pair = make_layers(shape, COUNT)
    return pl.optimal_beta(pair.program, k), optimal_beta(pair.twin, k)


@pytest.mark.parametrize("k", [3, 20, 100])
@pytest.mark.parametrize("shape", ["flat", "sphere"])
def test_isotropy_of_every_photon_is_the_twins(shape: str, k: int) -> None:
    found, expected = measure(shape, k)
    # The lesser eigenvalue is a difference: near 0 its root tells of little but rounding.
    np.testing.assert_allclose(found.isotropy.values, expected.isotropy, atol=5e-4, equal_nan=True)


@pytest.mark.parametrize("shape", ["flat", "sphere"])
def test_beta_is_the_twins(shape: str) -> None:
    found, expected = measure(shape, 20)
    assert (float(found), found.t_beta) == pytest.approx((expected.beta, expected.clipped), rel=1e-4)


def test_isotropy_over_many_parameters_is_the_twins() -> None:
    pair = make_layers("flat", 800, dimensions=13)
    expected = optimal_beta(pair.twin, 50).isotropy
    np.testing.assert_allclose(pl.optimal_beta(pair.program, 50).isotropy.values, expected, atol=5e-4, equal_nan=True)


def test_unset_photons_have_no_isotropy() -> None:
    found, _ = measure("flat", 20)
    np.testing.assert_array_equal(np.isnan(found.isotropy.values), ~make_layers("flat", COUNT).twin.is_set)


@pytest.mark.parametrize("clip", [0.0, 0.05, 0.2, 0.5])
def test_a_share_clip_of_the_photons_lies_below_t_beta(clip: float) -> None:
    found = pl.optimal_beta(make_layers("flat", COUNT).program, 20, clip)
    values = found.isotropy.values[~np.isnan(found.isotropy.values)]
    assert np.mean(values < found.t_beta) == pytest.approx(clip, abs=2.0 / len(values))


def test_beta_is_eq_6_of_t_beta() -> None:
    found, _ = measure("flat", 20)
    assert float(found) == pytest.approx(found.t_beta**-0.5, rel=1e-12)


def test_histogram_counts_every_photon_that_has_an_isotropy() -> None:
    isotropy = measure("flat", 20)[0].isotropy
    known = isotropy.values[~np.isnan(isotropy.values)]
    lower, upper = isotropy.edges[:-1], isotropy.edges[1:]
    inside = (known[:, None] >= lower) & ((known[:, None] < upper) | (upper == 1.0))
    np.testing.assert_array_equal(isotropy.histogram, inside.sum(axis=0))
    assert isotropy.histogram.sum() == len(known)


def test_cdf_is_the_share_up_to_each_edge() -> None:
    isotropy = measure("flat", 20)[0].isotropy
    known = isotropy.values[~np.isnan(isotropy.values)]
    expected = [np.mean(known <= edge) for edge in isotropy.edges[1:]]
    np.testing.assert_allclose(isotropy.cdf, expected)


def test_cdf_at_t_beta_is_clip() -> None:
    found, _ = measure("flat", 20)
    at = np.interp(found.t_beta, found.isotropy.edges[1:], found.isotropy.cdf)
    assert at == pytest.approx(0.05, abs=0.03)


# Closed form: world = A q maps discs of parameter space to ellipses whose axis ratio is that of A's singular values.


def stretch(ratio: float, turn: float, *, tilted: bool = False) -> pl.PhotonMap:
    """Uniform parameters mapped to a rectangle `ratio` times as long as wide, turned in its plane by `turn` radians."""
    values: NDArray[np.float64] = make_random(MANY, seed=1)
    normal = TILT / np.linalg.norm(TILT) if tilted else np.array(UP)
    first = np.cross(normal, (0.0, 0.0, 1.0))
    first /= np.linalg.norm(first)
    second = np.cross(first, normal)
    along, across = np.cos(turn) * first + np.sin(turn) * second, np.cos(turn) * second - np.sin(turn) * first
    places = values[:, :1] * along + values[:, 1:] / ratio * across
    return make_pair(places, normal, parameters=values).program


@pytest.mark.parametrize(("turn", "tilted"), [(0.0, False), (0.5, False), (0.5, True)])
@pytest.mark.parametrize("ratio", [2.0, 4.0, 9.0])
def test_half_of_the_neighborhoods_of_a_linear_map_need_the_root_of_its_axis_ratio(
    ratio: float, turn: float, tilted: bool
) -> None:
    # The median's error: t of k points scatters by about 1/√k, over many thousand photons and those at the border.
    beta = pl.optimal_beta(stretch(ratio, turn, tilted=tilted), NEIGHBORS, clip=0.5)
    assert float(beta) == pytest.approx(np.sqrt(ratio), rel=0.02)


@pytest.mark.parametrize("ratio", [4.0, 9.0])
def test_all_but_the_clip_of_a_linear_map_need_the_methods_quantile_more(ratio: float) -> None:
    beta = pl.optimal_beta(stretch(ratio, 0.5), NEIGHBORS)
    assert float(beta) == pytest.approx(np.sqrt(ratio / QUANTILE), rel=0.04)


def test_beta_does_not_depend_on_the_scale_of_the_parameters() -> None:
    here = stretch(4.0, 0.0)
    there = stretch(4.0, 0.0)
    there.set_parameters(here.parameters * 1024.0)
    assert float(pl.optimal_beta(here)) == float(pl.optimal_beta(there))
