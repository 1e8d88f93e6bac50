# SPDX-License-Identifier: Apache-2.0
"""How evenly photons lie, whatever their density: what the studio plots for each step of a relaxation."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

# Photons looked at; neighbors of the noisy and of the smooth estimate.
SAMPLE = 1000
FEW, MANY = 20, 100
_FEWEST_PHOTONS = 2 * MANY
# Standard deviation of a normal distribution in units of the median absolute deviation.
_DEVIATION = 1.4826


def measure_spread(distances: NDArray[np.float32]) -> tuple[float, float]:
    """Measure low-frequency power and noise of the density around a sample of the photons.

    Low-frequency power is the variance of log r₂₅² - 2 log r₅₀² + log r₁₀₀², r_k the distance to the k-th neighbor,
    over its value for random points, ψ₁(25) - ψ₁(100): 1 for white noise; a density that rises as a power of the
    distance drops out. Noise is the relative deviation of the Epanechnikov estimate of 20 photons from that of 100.
    Both by medians, so that few edges don't count.

    Parameters
    ----------
    distances
        (m, 101) of the sample to their nearest photons.

    Returns
    -------
    tuple of float
        Low-frequency power, noise; NaN with fewer than 200 photons.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> from photonloupe.studio.spread import measure_spread
    >>> spots = np.random.default_rng(0).random((20_000, 3)) * [1, 0, 1]
    >>> photons = pl.PhotonMap.from_arrays(positions=spots, normals=[[0, 1, 0]] * 20_000, power=np.ones((20_000, 3)))
    >>> power, noise = measure_spread(photons.neighbors(np.arange(0, 20_000, 20), 101)[1])
    >>> bool(0.8 < power < 1.2), bool(0.2 < noise < 0.3)
    (True, True)
    """
    if len(distances) < _FEWEST_PHOTONS:
        return math.nan, math.nan
    squared = distances.astype(np.float64) ** 2
    with np.errstate(divide="ignore", invalid="ignore"):
        bend = np.log(squared[:, 24]) - 2 * np.log(squared[:, 49]) + np.log(squared[:, 99])
        ratio = _estimate(squared, FEW) / _estimate(squared, MANY)
    return _measure_deviation(bend) ** 2 / (_trigamma(25) - _trigamma(100)), _measure_deviation(ratio)


def _estimate(squared: NDArray[np.float64], k: int) -> NDArray[np.float64]:
    reach = squared[:, k]
    return 2 / (np.pi * reach) * (1 - squared[:, :k] / reach[:, None]).sum(axis=1)


def _measure_deviation(values: NDArray[np.float64]) -> float:
    """Measure the standard deviation, by medians."""
    values = values[np.isfinite(values)]
    return float(_DEVIATION * np.median(np.abs(values - np.median(values)))) if len(values) else math.nan


def _trigamma(k: int) -> float:
    """ψ₁ of a whole number, the sum of 1/n² from k on."""
    return math.pi**2 / 6 - sum(1 / n**2 for n in range(1, k))
