# SPDX-License-Identifier: Apache-2.0
"""Maps of some of the photons: masks, ids, signatures, and their paths."""

from __future__ import annotations

import numpy as np
import pytest

import photonloupe as pl
from conftest import make_columns

PHOTONS = 30


@pytest.fixture
def photons() -> pl.PhotonMap:
    return pl.PhotonMap.from_arrays(**make_columns(PHOTONS))  # type: ignore[arg-type]


def test_mask_picks_its_rows(photons: pl.PhotonMap) -> None:
    mask = np.arange(PHOTONS) % 4 == 1
    np.testing.assert_array_equal(photons.select(mask).positions, photons.positions[mask])


def test_ids_pick_in_their_order(photons: pl.PhotonMap) -> None:
    np.testing.assert_array_equal(photons.select([5, 2, 9]).power, photons.power[[5, 2, 9]])


def test_paths_follow_their_photons(photons: pl.PhotonMap) -> None:
    picked = photons.select([7, 3])
    offsets = photons.path_offsets
    expected = np.concatenate([photons.path_vertices[offsets[i] : offsets[i + 1]] for i in (7, 3)])
    np.testing.assert_array_equal(picked.path_vertices, expected)


def test_signature_picks_paths_with_these_interactions(photons: pl.PhotonMap) -> None:
    offsets, interactions = photons.path_offsets, photons.path_interactions
    wanted = [i for i in range(PHOTONS) if interactions[offsets[i] + 1 : offsets[i + 1] - 1].tolist() == [2]]
    np.testing.assert_array_equal(photons.select(signature="2").emitted_index, photons.emitted_index[wanted])


def test_number_of_a_signature_has_its_first_interaction_lowest(photons: pl.PhotonMap) -> None:
    # [SJL15] eq. 2: reflected then transmitted is 1·3⁰ + 2·3¹ = 7.
    by_number, by_digits = photons.select(signature=7), photons.select(signature="12")
    np.testing.assert_array_equal(by_number.emitted_index, by_digits.emitted_index)


def test_selection_keeps_the_number_emitted(photons: pl.PhotonMap) -> None:
    assert photons.select([0]).emitted == photons.emitted


def test_empty_selection_is_a_map(photons: pl.PhotonMap) -> None:
    assert len(photons.select(np.zeros(PHOTONS, dtype=bool))) == 0


@pytest.mark.parametrize("ids", [[-1], [PHOTONS], [0.5], [[0]], np.ones(PHOTONS - 1, dtype=bool)])
def test_wrong_ids_are_refused(photons: pl.PhotonMap, ids: object) -> None:
    with pytest.raises(pl.ArgumentError):
        photons.select(ids)  # type: ignore[arg-type]


@pytest.mark.parametrize("signature", ["4", "1 2", 1.5, -1])
def test_wrong_signature_is_refused(photons: pl.PhotonMap, signature: str | int) -> None:
    with pytest.raises(pl.ArgumentError, match="signature"):
        photons.select(signature=signature)


def test_selection_of_a_traced_map_finds_its_own_paths(ring: pl.Scene) -> None:
    ids = np.arange(0, 5_000, 7)[::-1]
    before = pl.trace_photons(ring, 5_000, seed=2).select(ids)
    whole = pl.trace_photons(ring, 5_000, seed=2)
    np.testing.assert_array_equal(before.path_vertices, whole.select(ids).path_vertices)


def test_ring_is_mostly_reflected_once(ring_map: pl.PhotonMap) -> None:
    assert len(ring_map.select(signature="1")) > 0.9 * len(ring_map)
