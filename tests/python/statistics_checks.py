# SPDX-License-Identifier: Apache-2.0
"""Statistical gates that tests share: each says how unlikely a false alarm is."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

# One false alarm in 15,000 per two-sided comparison; seeds are fixed, so it fails always or never.
Z_LIMIT = 4.0
# A cell counts in χ² when this many photons are expected, as the approximation asks.
MIN_EXPECTED = 10.0


def compute_z(samples: NDArray[np.float64], emitted: int, truth: float, scale: float) -> float:
    """Z of the mean of `samples` (all others of `emitted` are zero) times `scale` against `truth`."""
    mean = samples.sum() / emitted
    variance = np.square(samples).sum() / emitted - mean**2
    return float((mean * scale - truth) / (scale * np.sqrt(variance / emitted)))


def compute_chi_square_p(counts: NDArray[np.float64], expected: NDArray[np.float64]) -> float:
    """P of `counts` being Poisson with means `expected`; cells that expect too few are pooled into one."""
    from scipy.stats import chi2  # noqa: PLC0415 - only some of the tests need SciPy

    large = expected >= MIN_EXPECTED
    statistic = np.sum(np.square(counts[large] - expected[large]) / expected[large])
    degrees = int(large.sum())
    pooled = float(expected[~large].sum())
    if pooled >= MIN_EXPECTED:
        statistic += (float(counts[~large].sum()) - pooled) ** 2 / pooled
        degrees += 1
    return float(chi2.sf(statistic, degrees))
