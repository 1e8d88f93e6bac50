# SPDX-License-Identifier: Apache-2.0
"""The photon map a researcher writes: SciPy's cKDTree and a NumPy Epanechnikov estimate."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

# So many points at a time keep the gathered fluxes in the cache.
CHUNK = 8_192


def build_scipy_tree(positions: NDArray[np.float32]) -> Any:
    """Build the tree, SciPy's defaults."""
    from scipy.spatial import cKDTree  # noqa: PLC0415 - an optional peer

    return cKDTree(positions)


def estimate_with_scipy(
    tree: Any, power: NDArray[np.float32], points: NDArray[np.float32], k: int
) -> NDArray[np.float32]:
    """Irradiance (n, 3) by METHODS section 2; every photon is taken to lie on the receiver."""
    irradiance = np.empty((len(points), 3), np.float32)
    for first in range(0, len(points), CHUNK):
        rows = slice(first, first + CHUNK)
        distances, ids = tree.query(points[rows], k + 1, workers=-1)
        square = np.square(distances[:, k:])
        weights = (1.0 - np.square(distances[:, :k]) / square).astype(np.float32)
        flux = np.einsum("nk,nkc->nc", weights, power[ids[:, :k]])
        irradiance[rows] = 2.0 / (np.pi * square) * flux
    return irradiance
