# SPDX-License-Identifier: Apache-2.0
"""What the engine enumerates goes by names: unknown ones are refused with those there are, in the bindings too."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from photonloupe import _engine
from photonloupe.device import open_device

TRACE: dict[str, Any] = {
    "count": 10,
    "emitted": 0,
    "seed": 0,
    "emission": "sobol",
    "store": "caustic",
    "max_bounces": 4,
    "paths": False,
}
NEIGHBORS: dict[str, Any] = {"space": "world", "beta": 0.0, "center": None, "low": None, "high": None}


@pytest.mark.parametrize(
    ("changed", "names"),
    [
        ({"emission": "sobl"}, "emission is 'sobl'; it must be sobol or random"),
        ({"store": "ALL"}, "store is 'ALL'; it must be caustic, indirect or all"),
    ],
)
def test_tracing_names_the_choices(ring: pl.Scene, changed: dict[str, Any], names: str) -> None:
    with pytest.raises(pl.PhotonLoupeError, match=names):
        _engine.trace_photons(open_device(None)._native, ring._native, {**TRACE, **changed})


def test_neighbors_name_the_choices() -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.eye(3), normals=np.eye(3), power=np.ones((3, 3)))
    ids = np.zeros(1, dtype=np.uint32)
    with pytest.raises(pl.PhotonLoupeError, match="space is 'wrld'; it must be world, parameter or constrained"):
        _engine.find_neighbors(
            open_device(None)._native, photons._native, None, ids, 1, {**NEIGHBORS, "space": "wrld"}, None
        )


def test_relaxation_names_the_choices() -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.eye(3), normals=np.eye(3), power=np.ones((3, 3)))
    settings = {**pl.Relaxation(photons, steps=1, descriptor="none").settings, "limit": 0.0, "search": "exakt"}
    with pytest.raises(pl.PhotonLoupeError, match="search is 'exakt'; it must be exact or carried"):
        _engine.start_relaxation(open_device(None)._native, photons._native, None, settings, None)
