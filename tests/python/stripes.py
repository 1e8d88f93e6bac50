# SPDX-License-Identifier: Apache-2.0
"""The stripes of the scenes `prism` and `lightguide`: committed lines across them, and how much of one a map keeps.

A stripe's contrast is (peak − trough)/(peak + trough), each the mean irradiance of an interval of the line
(METHODS section 7). The line runs along x on the floor; the irradiance is the mean over lines parallel to it, as many
metres to either side as its half width says, since the stripe runs along z.
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from conftest import SCENES

if TYPE_CHECKING:
    from photonloupe import PhotonMap

Doubles = NDArray[np.float64]

UP = (0.0, 1.0, 0.0)
POINTS = 65  # along the line
PARALLELS = 65
REFERENCE_PHOTONS = 4_000_000

# How maps are relaxed to see what a parameter space keeps: only the parameters differ.
RELAXATION: dict[str, Any] = {
    "steps": 20,
    "neighbors": 20,
    "over_relaxation": 1.0,
    "constraint": "parameter",
    "descriptor": "pca",
    "beta": 3.0,
    "repel": "world",
}
# METHODS section 7: shares of the reference's contrast at which a stripe survives, and at which it is lost.
SURVIVES, LOST = 0.8, 0.4


@dataclass(frozen=True)
class Stripe:
    """A line across a stripe, from scenes/<name>/line.json."""

    name: str
    start: float  # m, x
    end: float  # m, x
    half_width: float  # m, |z| of the farthest parallel
    peak: tuple[float, float]  # m, x
    troughs: tuple[tuple[float, float], tuple[float, float]]  # m, x
    photons: int  # stored, in the maps whose numbers the README gives
    k: int
    reference_contrast: float

    def measure_profile(self, photons: PhotonMap, k: int | None = None) -> tuple[Doubles, Doubles]:
        """Find x along the line and the mean irradiance there over the parallels, red."""
        x, z = np.meshgrid(
            np.linspace(self.start, self.end, POINTS),
            np.linspace(-self.half_width, self.half_width, PARALLELS),
            indexing="ij",
        )
        points = np.stack([x.ravel(), np.zeros(x.size), z.ravel()], axis=1)
        found = photons.irradiance(points, UP, k=k or self.k)[:, 0]
        return x[:, 0], found.astype(np.float64).reshape(x.shape).mean(axis=1)

    def measure_contrast(self, photons: PhotonMap, k: int | None = None) -> float:
        """Contrast of the estimate from the k nearest photons."""
        x, irradiance = self.measure_profile(photons, k)
        peak, first, second = (irradiance[(x >= low) & (x <= high)].mean() for low, high in (self.peak, *self.troughs))
        return find_contrast(peak, 0.5 * (first + second))

    def measure_share(self, photons: PhotonMap, k: int | None = None) -> float:
        """Contrast over the reference's: what survives."""
        return self.measure_contrast(photons, k) / self.reference_contrast

    def count_contrast(self, photons: PhotonMap) -> float:
        """Contrast of the flux in the intervals over their areas: no kernel, for very many photons."""
        x, z = photons.positions[:, 0], photons.positions[:, 2]
        flux = np.where(np.abs(z) < self.half_width, photons.power[:, 0].astype(np.float64), 0.0)
        peak, first, second = (
            flux[(x >= low) & (x < high)].sum() / (high - low) for low, high in (self.peak, *self.troughs)
        )
        return find_contrast(peak, 0.5 * (first + second))


def find_contrast(peak: float, trough: float) -> float:
    return float((peak - trough) / (peak + trough))


def load_stripe(name: str) -> Stripe:
    """Read the committed line of a scene."""
    told = json.loads((SCENES / name / "line.json").read_text(encoding="utf-8"))
    return Stripe(
        name=name,
        start=told["from"][0],
        end=told["to"][0],
        half_width=told["half_width"],
        peak=tuple(told["peak"]),
        troughs=tuple(tuple(interval) for interval in told["troughs"]),
        photons=told["photons"],
        k=told["k"],
        reference_contrast=told["reference_contrast"],
    )
