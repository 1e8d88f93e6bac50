# SPDX-License-Identifier: Apache-2.0
"""Scripts that ask of the language what Algorithms 1 and 2 of [SJL15] do compute what the paper says.

They are those of tests/script/paper; PHOTONLOUPE_LISTINGS names a folder with the printed ones, which then are held to
the same.
"""

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


def list_scripts(name: str, printed: str) -> list[Path]:
    """Our script, and the printed one where it is at hand."""
    listings = os.environ.get("PHOTONLOUPE_LISTINGS")
    ours = SCENES.parent / "tests" / "script" / "paper" / f"{name}.photon"
    return [ours, *([Path(listings) / f"{printed}.photon"] if listings else [])]


def get_name(path: Path) -> str:
    return path.stem


TORTUOSITY = list_scripts("tortuosity", "algorithm1")
COMPONENTS = list_scripts("components", "algorithm2")


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


@pytest.mark.parametrize("path", TORTUOSITY + COMPONENTS, ids=get_name)
def test_script_is_one_parallel_pass_without_a_warning(path: Path) -> None:
    script = pl.compile_script(path.read_text())
    assert script.diagnostics == ()
    assert [row["kind"] for row in script.passes] == ["parallel"]


@pytest.mark.parametrize("path", TORTUOSITY, ids=get_name)
def test_tortuosity_is_equation_1(path: Path, photons: pl.PhotonMap) -> None:
    run = photons.run_script(path.read_text())
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


@pytest.mark.parametrize("path", TORTUOSITY, ids=get_name)
def test_tortuosity_exposes_alpha(path: Path, photons: pl.PhotonMap) -> None:
    text = path.read_text()
    (alpha,) = pl.compile_script(text).exposed
    assert (alpha.name, alpha.low, alpha.high, alpha.default) == ("alpha", 1, 1000, ALPHA)
    usual, other = photons.run_script(text), photons.run_script(text, alpha=3)
    np.testing.assert_array_equal(usual.parameters, other.parameters)
    assert not np.array_equal(usual.colors, other.colors, equal_nan=True)


@pytest.mark.parametrize("path", COMPONENTS, ids=get_name)
def test_components_are_ppca(path: Path, photons: pl.PhotonMap) -> None:
    run = photons.run_script(path.read_text())
    assert run.parameter_names == ("U", "V")
    np.testing.assert_array_equal(run.parameter_bounds, np.float32([[-np.pi, np.pi]] * 2))
    check_parameters(run.parameters, script_twins.ppca(photons).parameters)


@pytest.mark.parametrize("path", COMPONENTS, ids=get_name)
def test_components_give_no_colors(path: Path, photons: pl.PhotonMap) -> None:
    colors = photons.run_script(path.read_text()).colors
    assert colors is None or np.isnan(colors).all()


@pytest.mark.parametrize(
    ("path", "script"), [(path, "tortuosity") for path in TORTUOSITY] + [(path, "ppca") for path in COMPONENTS]
)
def test_script_of_the_folder_computes_the_same(path: Path, script: str, photons: pl.PhotonMap) -> None:
    expected = photons.run_script(path.read_text()).parameters
    check_parameters(photons.run_script(SCENES / "scripts" / f"{script}.photon").parameters, expected)


@pytest.mark.parametrize("path", TORTUOSITY + COMPONENTS, ids=get_name)
def test_script_reports_no_fault(path: Path, photons: pl.PhotonMap) -> None:
    assert photons.run_script(path.read_text()).report["faults"] == []
