# SPDX-License-Identifier: Apache-2.0
"""How evenly photons lie, on any density: what the studio plots for each step of a relaxation."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from photonloupe.photons import PhotonMap

# Photons looked at; neighbors of the noisy and of the smooth estimate.
SAMPLE = 1000
FEW, MANY = 20, 400
# Standard deviation of a normal distribution in units of the median absolute deviation.
_DEVIATION = 1.4826


def measure_spread(photons: PhotonMap, seed: int = 0) -> tuple[float, float]:
    """Measure low-frequency power and noise of the density around a sample of the photons.

    Low-frequency power is k Var(r_k²/r_m²) over its value for random points (1 for white noise): how much the area
    that k photons take varies beside the area of m = 400 around them, k = 50. Noise is the relative deviation of the
    Epanechnikov estimate of 20 photons from that of 400. Both are medians' deviations, so that edges don't count.

    Parameters
    ----------
    photons
        Any map.
    seed
        Of the sample.

    Returns
    -------
    tuple of float
        Low-frequency power, noise; NaN with fewer than 500 photons.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> from photonloupe.studio.spread import measure_spread
    >>> spots = np.random.default_rng(0).random((20_000, 3)) * [1, 0, 1]
    >>> photons = pl.PhotonMap.from_arrays(positions=spots, normals=[[0, 1, 0]] * 20_000, power=np.ones((20_000, 3)))
    >>> power, noise = measure_spread(photons)
    >>> bool(0.7 < power < 1.3), bool(0.2 < noise < 0.35)
    (True, True)
    """
    if len(photons) < MANY + 100:
        return float("nan"), float("nan")
    ids = np.random.default_rng(seed).choice(len(photons), min(SAMPLE, len(photons)), replace=False)
    squared = photons.neighbors(np.sort(ids), MANY + 1)[1].astype(np.float64) ** 2
    middle = 50
    areas = squared[:, middle - 1] / squared[:, MANY - 1] * (MANY / middle)
    # Of random points the ratio is beta-distributed: its variance is that of k of m, (1 - k/m)/k relative.
    power = _measure_deviation(areas) ** 2 * middle / (1 - middle / MANY)
    few, many = _estimate(squared, FEW), _estimate(squared, MANY)
    known = many > 0
    return float(power), float(_measure_deviation(few[known] / many[known]))


def _estimate(squared: NDArray[np.float64], k: int) -> NDArray[np.float64]:
    reach = squared[:, k]
    with np.errstate(divide="ignore", invalid="ignore"):
        return 2 / (np.pi * reach) * (1 - squared[:, :k] / reach[:, None]).sum(axis=1)


def _measure_deviation(values: NDArray[np.float64]) -> float:
    """Relative standard deviation, by medians."""
    values = values[np.isfinite(values)]
    if len(values) == 0:
        return float("nan")
    middle = np.median(values)
    return float(_DEVIATION * np.median(np.abs(values - middle)) / middle) if middle > 0 else float("nan")
