# SPDX-License-Identifier: Apache-2.0
"""Contact sheets hold every picture in its place below its label."""

from __future__ import annotations

import numpy as np
import pytest

import photonloupe as pl
from photonloupe.cli.contact_sheet import _GAP, _LINE, build_contact_sheet

SIDE = 64
LABELS = ("one", "two", "three")


@pytest.fixture
def pictures() -> dict[str, pl.Image]:
    """Grey pictures of radiance 0.1, 0.2, 0.3."""
    levels = 0.1 * (1.0 + np.arange(len(LABELS)))
    grey = (pl.Image(np.full((SIDE, SIDE, 3), level), provenance={"level": level}) for level in levels)
    return dict(zip(LABELS, grey, strict=True))


def cut(sheet: pl.Image, row: int, column: int) -> np.ndarray:
    """One tile, its label first."""
    top, left = row * (SIDE + _LINE + _GAP), column * (SIDE + _GAP)
    return np.asarray(sheet)[top : top + SIDE + _LINE, left : left + SIDE]


@pytest.mark.parametrize(("columns", "height", "width"), [(1, 3, 1), (2, 2, 2), (3, 1, 3)])
def test_sheet_has_as_many_columns_as_asked(
    pictures: dict[str, pl.Image], columns: int, height: int, width: int
) -> None:
    sheet = build_contact_sheet(pictures, columns=columns)
    expected = (height * (SIDE + _LINE + _GAP) - _GAP, width * (SIDE + _GAP) - _GAP)
    assert (sheet.height, sheet.width) == expected


@pytest.mark.parametrize(("place", "label"), [((0, 0), "one"), ((0, 1), "two"), ((1, 0), "three")])
def test_picture_is_in_its_place(pictures: dict[str, pl.Image], place: tuple[int, int], label: str) -> None:
    tile = cut(build_contact_sheet(pictures, columns=2), *place)
    np.testing.assert_array_equal(tile[_LINE:], np.asarray(pictures[label]))


def test_exposure_brightens_the_pictures(pictures: dict[str, pl.Image]) -> None:
    tile = cut(build_contact_sheet(pictures, columns=2, exposure=1.0), 0, 1)
    np.testing.assert_allclose(tile[_LINE:], 0.4, rtol=1e-6)


def test_labels_are_white_whatever_the_exposure(pictures: dict[str, pl.Image]) -> None:
    tile = cut(build_contact_sheet(pictures, columns=2, exposure=-3.0), 0, 0)
    assert tile[:_LINE].max() == 1.0


def test_labels_differ(pictures: dict[str, pl.Image]) -> None:
    sheet = build_contact_sheet(pictures, columns=2)
    assert not np.array_equal(cut(sheet, 0, 0)[:_LINE], cut(sheet, 0, 1)[:_LINE])


def test_sheet_says_what_made_its_pictures(pictures: dict[str, pl.Image]) -> None:
    origin = build_contact_sheet(pictures, columns=2).provenance["pictures"]
    assert [origin[label]["level"] for label in LABELS] == pytest.approx([0.1, 0.2, 0.3])
