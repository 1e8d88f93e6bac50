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
        ({"emission": "sobl"}, 'emission must be one of sobol, random, not "sobl"'),
        ({"store": "ALL"}, 'store must be one of caustic, indirect, all, not "ALL"'),
    ],
)
def test_tracing_names_the_choices(ring: pl.Scene, changed: dict[str, Any], names: str) -> None:
    with pytest.raises(pl.PhotonLoupeError, match=names):
        _engine.trace_photons(open_device(None)._native, ring._native, {**TRACE, **changed})


def test_neighbors_name_the_choices() -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.eye(3), normals=np.eye(3), power=np.ones((3, 3)))
    ids = np.zeros(1, dtype=np.uint32)
    with pytest.raises(pl.PhotonLoupeError, match='space must be one of world, parameter, constrained, not "wrld"'):
        _engine.find_neighbors(
            open_device(None)._native, photons._native, None, ids, 1, {**NEIGHBORS, "space": "wrld"}, None
        )


def test_relaxation_names_the_choices() -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.eye(3), normals=np.eye(3), power=np.ones((3, 3)))
    settings = {**pl.Relaxation(photons, steps=1, descriptor="none").settings, "search": "exakt"}
    with pytest.raises(pl.PhotonLoupeError, match='search must be one of exact, carried, not "exakt"'):
        _engine.start_relaxation(open_device(None)._native, photons._native, None, settings, None)
