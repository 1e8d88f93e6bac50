# SPDX-License-Identifier: Apache-2.0
"""Extremes of scripts: few photons, degenerate paths, numbers at the ends of floats, limits of the language."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from conftest import SCENES
from extremes_table import add_row, show

TOLERANCE = 1e-5
SOURCE_LIMIT = 64 * 1024
EACH = "for (i = 0; i < getNumPhotons(); i++)"


def make_photons(count: int, **columns: Any) -> pl.PhotonMap:
    x = np.arange(count, dtype=np.float64)
    positions = columns.pop("positions", np.stack([x, 2 * x, 0 * x], axis=1))
    power = columns.pop("power", np.ones((count, 3)))
    return pl.PhotonMap.from_arrays(
        positions=positions, normals=np.tile([0.0, 1.0, 0.0], (count, 1)), power=power, **columns
    )


def evaluate(expression: str, photons: pl.PhotonMap | None = None, **more: Any) -> float:
    """Value of an expression on the device, for the last photon."""
    photons = make_photons(3) if photons is None else photons
    text = f"declarePhotonParameter(3, -1e38, 1e38); {EACH} setPhotonParameter(i, 3, {expression});"
    photons.run_script(text, **more)
    return float(photons.parameters[-1, 0])


def test_scripts_run_over_few_photons() -> None:
    text = f"""
        s = 0.0; n = 0; least = 1e30;
        resetPCA2D();
        {EACH} {{
            x = getPhotonPosition(i, X);
            s += x; n++; least = min(least, x); pushPCA2D(i, 2 * i);
        }}
        ok = decomposePCA2D();
        print("sums", n, s, least, ok);
    """
    expected = {0: "sums 0 0 1e+30 0", 1: "sums 1 0 0 0", 2: "sums 2 1 0 1", 65: "sums 65 2080 0 1"}
    for count, line in expected.items():
        assert make_photons(count).run_script(text).prints == (line,)
    add_row("script-photons", "4 counts")


def test_acos_is_clamped_just_outside_its_domain() -> None:
    assert evaluate("acos(1 + 0.0000001 * i)") == 0.0
    assert abs(evaluate("acos(-1.000005)") - np.pi) < 1e-6
    assert np.isnan(evaluate("acos(1.00002)"))
    assert np.isnan(evaluate("asin(-1.00002)"))
    add_row("script-acos", "4 values")


def test_paths_of_two_vertices_and_segments_of_no_length_stay_unset() -> None:
    vertices = np.array([[0, 1, 0], [0, 0, 0]] + [[0, 1, 0]] * 2 + [[0, 0, 0]] + [[0, 1, 0], [1, 0, 0], [2, 1, 0]])
    photons = make_photons(
        3,
        path_offsets=[0, 2, 5, 8],
        path_vertices=vertices,
        path_normals=np.tile([0.0, 1.0, 0.0], (8, 1)),
        path_interactions=[0, 0, 0, 1, 0, 0, 1, 0],
    )
    run = photons.run_script(SCENES / "scripts" / "tortuosity.photon")
    assert photons.parameters_set.tolist() == [False, False, True]
    error = abs(float(photons.parameters[2, 0]) - 0.5)
    assert error < TOLERANCE
    assert not run.report["faults"]
    add_row("script-paths", f"error {show(error)}")


@pytest.mark.parametrize(
    ("points", "axis"),
    [
        ("1, 1", None),
        ("i, 0", 1.0),
        ("1e20 * i, 1e20 * i", None),
        ("1e18 * i, 1e18 * i", 0.5**0.5),
        ("1e-20 * i, 0", 1.0),
    ],
)
def test_principal_components_of_points_that_lie_alike_or_on_a_line(points: str, axis: float | None) -> None:
    run = make_photons(5).run_script(f"""
        resetPCA2D();
        {EACH} pushPCA2D({points});
        ok = decomposePCA2D();
        print("found", ok, getPCAEigenvector(0, X));
    """)
    ok, along = run.prints[0].split()[1:]
    assert ok == ("0" if axis is None else "1")
    assert np.isnan(float(along)) if axis is None else abs(float(along) - axis) < TOLERANCE
    add_row("script-pca", "5 sets of points")


def test_numbers_at_the_ends_of_floats() -> None:
    assert evaluate("magnitude(1e30, 1e30)") == np.float32(np.sqrt(2) * 1e30)
    assert evaluate("magnitude(1e-30, 0, 1e-30)") == pytest.approx(np.sqrt(2) * 1e-30, rel=1e-6)
    assert np.isnan(evaluate("min(0.0 / 0.0, 1)"))
    assert np.isnan(evaluate("max(1, 0.0 / 0.0)"))
    assert np.isnan(evaluate("clamp(0.0 / 0.0, 0, 1)"))
    assert np.isnan(evaluate("pow(0.0 / 0.0, 0)"))
    assert evaluate("1 / (1 / 0.0)") == 0.0
    assert evaluate("2147483647 + i == -2147483647") == 1.0
    add_row("script-numbers", "8 values")


def test_what_is_set_to_nan_or_inf_is_unset_and_counted() -> None:
    photons = make_photons(4)
    run = photons.run_script(
        f"declarePhotonParameter(3, 0, 1);\n{EACH} setPhotonParameter(i, 3, i == 1 ? 0.0 / 0.0 : i == 2 ? 1 / 0.0 : i);"
    )
    counted = run.report["parameters"]["p3"]
    assert photons.parameters_set.tolist() == [True, False, False, True]
    assert counted["non_finite"] == {"count": 2, "first_photon": 1}
    assert counted["out_of_bounds"] == {"count": 1, "first_photon": 3}
    assert counted["line"] == 2
    add_row("script-not-finite", "2 of 4 photons")


def test_sums_of_huge_and_tiny_numbers() -> None:
    generator = np.random.default_rng(5)
    flux = 10.0 ** generator.uniform(-30, 30, 9_000)
    photons = make_photons(9_000, power=np.repeat(flux[:, None], 3, axis=1))
    run = photons.run_script(
        f"declarePhotonParameter(3, 0, 1e38); s = 0.0;\n"
        f"{EACH} s += getPhotonPower(i, 0); {EACH} setPhotonParameter(i, 3, s);"
    )
    total = float(np.asarray(photons.power[:, 0], dtype=np.float64).sum())
    error = abs(float(photons.parameters[0, 0]) / total - 1)
    assert error < TOLERANCE
    assert not run.report["faults"]
    add_row("script-sums", f"relative error {show(error)}")


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_scripts_do_not_mind_the_scale_of_a_scene(scale: float) -> None:
    vertices = np.random.default_rng(2).random((300, 4, 3))
    found = []
    for factor in (1.0, scale):
        photons = make_photons(
            300,
            positions=vertices[:, -1] * factor,
            path_offsets=np.arange(301) * 4,
            path_vertices=vertices.reshape(-1, 3) * factor,
            path_normals=np.tile([0.0, 1.0, 0.0], (1200, 1)),
        )
        photons.run_script(SCENES / "scripts" / "tortuosity.photon")
        found.append(photons.parameters[:, 0].astype(np.float64))
    difference = float(np.abs(found[0] - found[1]).max())
    assert difference < TOLERANCE
    add_row("script-scale", f"largest difference {show(difference)}")


def test_a_loop_that_never_ends_is_stopped_and_the_next_script_runs() -> None:
    photons = make_photons(20)
    run = photons.run_script(f"{EACH} while (true) x = 1;", limits={"fuel": 100_000})
    assert run.report["passes"][0]["exhausted"] == 20
    assert evaluate("i") == 2.0
    add_row("script-endless", "20 photons")


def nest(depth: int) -> str:
    return "x = " + "(" * depth + "1" + ")" * depth + ";"


@pytest.mark.parametrize(
    ("fits", "breaks"),
    [
        ("x = 1;" + " " * (SOURCE_LIMIT - 6), "x = 1;" + " " * (SOURCE_LIMIT - 5)),
        (nest(60), nest(65)),
        ("".join(f"v{i} = 1;" for i in range(252)), "".join(f"v{i} = 1;" for i in range(257))),
        ("float a[4096];", "float a[4097];"),
        (f"{EACH} {{ float a[512]; }}", f"{EACH} {{ float a[513]; }}"),
        ("declarePhotonParameter(3, 0, 1);", "declarePhotonParameter(16, 0, 1);"),
        (f"{EACH} nn = getKNN(i, 1000);", f"{EACH} nn = getKNN(i, 1001);"),
    ],
)
def test_limits_of_the_language_hold_at_the_limit_and_refuse_beyond(fits: str, breaks: str) -> None:
    assert not pl.compile_script(fits).has_errors
    script = pl.compile_script(breaks)
    assert script.has_errors
    assert script.diagnostics[0].code.startswith("E")
    add_row("script-limits", "7 limits")
