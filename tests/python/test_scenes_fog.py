# SPDX-License-Identifier: Apache-2.0
"""The glass ball in fog: light that it bent draws together behind it, in the air."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

import photonloupe as pl
from conftest import find_scene
from foggy_ball import FOG

EMITTED = 1 << 19


@pytest.fixture(scope="module")
def photons() -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene("fog")), emitted=EMITTED, store="caustic", seed=1)


def find_places(photons: pl.PhotonMap) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Distance behind the ball's middle along the lamp's axis, and from it, of photons in the fog."""
    middle, lamp = np.array(FOG.middle), np.array(FOG.lamp)
    axis = (middle - lamp) / np.linalg.norm(middle - lamp)
    in_fog = np.linalg.norm(photons.normals, axis=1) < 0.75
    offset = photons.positions[in_fog].astype(np.float64) - middle
    along = offset @ axis
    return along, np.linalg.norm(offset - along[:, None] * axis, axis=1)


def test_fog_is_read_and_only_lobes_are_left_out() -> None:
    scene = pl.load_scene(find_scene("fog"))
    assert "participating media" in scene.describe().split("left out")[0]
    assert [line for line in scene.report["ignored"] if "lobe" not in line] == []


def test_light_draws_together_behind_the_ball(photons: pl.PhotonMap) -> None:
    """The lamp is near: its paraxial image lies farther behind than the focus, rays farther out meet before it."""
    along, aside = find_places(photons.select(signature="22"))
    width = [np.median(aside[(along > low) & (along < low + 0.05)]) for low in (0.2, 0.3, 0.4, 0.8)]
    assert width[1] < 0.5 * width[0]
    assert width[2] < 0.5 * width[3]


def test_a_caustic_map_holds_nothing_before_the_ball_but_what_it_mirrors(photons: pl.PhotonMap) -> None:
    twice = photons.select(signature="22")
    along, _ = find_places(twice)
    assert len(along) > 10_000
    assert along.min() > -1e-3
