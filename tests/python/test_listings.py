# SPDX-License-Identifier: Apache-2.0
"""Algorithms 1 and 2 of [SJL15] run exactly as printed. Their text is not part of the project; see `find_listings`."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
import script_twins
from conftest import SCENES, find_scene, make_columns

MAPS = ("ring", "slab", "made up")
ALPHA = 50
# Both take arc cosines, whose error near 1 is the root of the rounding: √(2·4·2⁻²⁴) at the worst, over π in the first.
ARC = 7e-4
TYPICAL = 2e-6


def find_listings() -> Path | None:
    """Find the folder PHOTONLOUPE_LISTINGS, else shared/listings beside the repository."""
    beside = Path(__file__).resolve().parents[3] / "shared" / "listings"
    folder = Path(os.environ.get("PHOTONLOUPE_LISTINGS") or beside)
    return folder if folder.is_dir() else None


def read_listing(name: str) -> str:
    folder = find_listings()
    if folder is None:
        pytest.skip("the paper's listings are not here; PHOTONLOUPE_LISTINGS names their folder")
    return (folder / f"{name}.photon").read_text()


@pytest.fixture(scope="module", params=MAPS)
def photons(request: pytest.FixtureRequest) -> pl.PhotonMap:
    if request.param != "made up":
        return pl.trace_photons(pl.load_scene(find_scene(request.param)), 5_000, seed=3)
    columns = make_columns(3_000)
    columns["path_normals"] /= np.linalg.norm(columns["path_normals"], axis=1, keepdims=True)
    return pl.PhotonMap.from_arrays(**columns)


def check_parameters(found: np.ndarray, expected: np.ndarray) -> None:
    np.testing.assert_allclose(found, expected, atol=ARC, equal_nan=True)
    assert np.nanquantile(np.abs(found - expected), 0.98) <= TYPICAL


@pytest.mark.parametrize("name", ["algorithm1", "algorithm2"])
def test_listing_is_one_parallel_pass_without_a_warning(name: str) -> None:
    script = pl.compile_script(read_listing(name))
    assert script.diagnostics == ()
    assert [row["kind"] for row in script.passes] == ["parallel"]


def test_algorithm_1_is_equation_1(photons: pl.PhotonMap) -> None:
    run = photons.run_script(read_listing("algorithm1"))
    twin = script_twins.tortuosity(photons, turns=ALPHA)
    assert run.parameter_names == ("GAMMA",)
    assert run.exposed == {"alpha": ALPHA}
    np.testing.assert_array_equal(run.parameter_bounds, [[0, 1]])
    check_parameters(run.parameters, twin.parameters)
    assert run.colors is not None
    np.testing.assert_array_equal(np.isnan(run.colors), np.isnan(twin.colors))
    # One turn of the hue is 1/α; half of that is the steepest a color changes.
    difference = np.abs(run.colors - twin.colors).max(axis=1)
    # The hue's angle reaches 300 radians, of which 24 bits leave 3e-5.
    limit = 1e-4 + np.pi * ALPHA * np.abs(run.parameters - twin.parameters)[:, 0]
    assert np.all((difference <= limit)[~np.isnan(limit)])


def test_algorithm_1_exposes_alpha(photons: pl.PhotonMap) -> None:
    text = read_listing("algorithm1")
    (alpha,) = pl.compile_script(text).exposed
    assert (alpha.name, alpha.low, alpha.high, alpha.default) == ("alpha", 1, 1000, ALPHA)
    usual, other = photons.run_script(text), photons.run_script(text, alpha=3)
    np.testing.assert_array_equal(usual.parameters, other.parameters)
    assert not np.array_equal(usual.colors, other.colors, equal_nan=True)


def test_algorithm_2_is_ppca(photons: pl.PhotonMap) -> None:
    run = photons.run_script(read_listing("algorithm2"))
    assert run.parameter_names == ("U", "V")
    np.testing.assert_array_equal(run.parameter_bounds, np.float32([[-np.pi, np.pi]] * 2))
    check_parameters(run.parameters, script_twins.ppca(photons).parameters)


def test_algorithm_2_gives_no_colors(photons: pl.PhotonMap) -> None:
    colors = photons.run_script(read_listing("algorithm2")).colors
    assert colors is None or np.isnan(colors).all()


@pytest.mark.parametrize(("listing", "script"), [("algorithm1", "tortuosity"), ("algorithm2", "ppca")])
def test_script_of_the_folder_computes_what_the_listing_computes(
    listing: str, script: str, photons: pl.PhotonMap
) -> None:
    expected = photons.run_script(read_listing(listing)).parameters
    check_parameters(photons.run_script(SCENES / "scripts" / f"{script}.photon").parameters, expected)


@pytest.mark.parametrize("name", ["algorithm1", "algorithm2"])
def test_listing_reports_no_fault(name: str, photons: pl.PhotonMap) -> None:
    assert photons.run_script(read_listing(name)).report["faults"] == []
