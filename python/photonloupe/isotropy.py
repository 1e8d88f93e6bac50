# SPDX-License-Identifier: Apache-2.0
"""How isotropic world space is around photons that are near in parameter space, and the β that follows."""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_number
from photonloupe.device_photons import DevicePhotons
from photonloupe.errors import ArgumentError
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.settings import list_settings

LOG = logging.getLogger("photonloupe")

BINS = 64
BETA_NEIGHBORS, CLIPPED_SHARE = 100, 0.05  # where nothing is said


@dataclass(frozen=True)
class Isotropy:
    """Axis ratios t = √(λ₂/λ₁) of the world positions of each photon's neighbors in parameter space, eq. 5.

    Attributes
    ----------
    values
        (n,) t of each photon; NaN where it has no parameters, no neighbors there, or all of them share its place.
    edges
        (65,) edges of the bins from 0 to 1.
    histogram
        (64,) photons in each bin.
    cdf
        (64,) share of the photons up to each bin's upper edge.
    """

    values: NDArray[np.float32]
    edges: NDArray[np.float64]
    histogram: NDArray[np.int64]
    cdf: NDArray[np.float64]


class OptimalBeta(float):
    """β as a number, with the axis ratios it came from in `isotropy` and the one that decided in `t_beta`."""

    isotropy: Isotropy
    t_beta: float


def optimal_beta(
    photons: DevicePhotons, k: int = BETA_NEIGHBORS, clip: float = CLIPPED_SHARE, *, progress: ProgressLike = None
) -> OptimalBeta:
    """Find the β that clips the neighborhoods of only a share `clip` of the photons ([SJL15] section 5.2, eqs. 5, 6).

    Parameters
    ----------
    photons
        A map with parameters.
    k
        Neighbors in parameter space whose world positions are looked at, 3 to 998.
    clip
        Accepted share of photons whose neighborhoods are cut, 0 to 0.5.
    progress
        True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    OptimalBeta
        √(1/t_β), t_β the axis ratio that all but `clip` of the photons exceed; a float with `.isotropy`.

    Raises
    ------
    ArgumentError
        If the map has no parameters, a setting is out of range, or no photon has an axis ratio above 0.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> q = np.random.default_rng(0).random((4000, 2))
    >>> flat = np.stack([4 * q[:, 0], 0 * q[:, 0], q[:, 1]], axis=1)
    >>> photons = pl.PhotonMap.from_arrays(positions=flat, normals=[[0, 1, 0]] * 4000, power=np.ones((4000, 3)))
    >>> photons.set_parameters(q)
    >>> bool(1.9 < pl.optimal_beta(photons) < 2.4)
    True
    """
    beta = _find_beta(photons, k, clip, progress)
    if beta is None:
        raise ArgumentError(_engine.explain_no_ratio(photons._native))
    return beta


def check_beta(value: Any, photons: DevicePhotons, progress: ProgressLike = None) -> float:
    """Return β as a number, found from the map when it is ``"auto"``; the default where every β would do."""
    setting = list_settings("relax")["beta"]
    checked = setting.check(value)
    if checked is not None:
        return float(checked)
    beta = _find_beta(photons, BETA_NEIGHBORS, CLIPPED_SHARE, progress)
    if beta is None:
        LOG.warning(_engine.explain_no_ratio(photons._native))
    return float(setting.default if beta is None else beta)


def _find_beta(photons: DevicePhotons, k: int, clip: float, progress: ProgressLike) -> OptimalBeta | None:
    """Find β, or None where no photon has an axis ratio: then the layers are the same whatever it is."""
    k = check_count("k", k, 3, list_settings("relax")["neighbors"].limits[1])
    clip = check_number("clip", clip, 0.0, 0.5)
    with follow_progress(progress) as callback:
        found = _engine.find_optimal_beta(photons.device._native, photons._native, k, clip, callback)
    if found is None:
        return None
    number, t_beta, values = found
    known = values[~np.isnan(values)]
    edges = np.linspace(0.0, 1.0, BINS + 1)
    histogram = np.histogram(known, edges)[0].astype(np.int64)
    beta = OptimalBeta(number)
    beta.t_beta = t_beta
    beta.isotropy = Isotropy(values, edges, histogram, np.cumsum(histogram) / len(known))
    return beta
