# SPDX-License-Identifier: Apache-2.0
"""Scripts from Python: diagnostics, exposed variables, what a run leaves on the map and in its report."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from conftest import SCENES

HEIGHT = """
LEVEL = 3;
scale = 2;
expose scale range 0, 10
declarePhotonParameter(LEVEL, -100, 100);
for (i = 0; i < getNumPhotons(); i++) {
    if (getPhotonPosition(i, X) < 0) continue;
    setPhotonParameter(i, LEVEL, scale * getPhotonPosition(i, X));
    setPhotonColourEncoding(i, 1, 0.5, 0);
}
"""
FLOOR_SHARE = 0.98  # of the picture
WRONG = "x = 1;\nfor (i = 0; i < getNumPhotons(); i++)\n  y = getPathVertx(i, 0, X) + z;\n"


@pytest.fixture(scope="module")
def traced() -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(SCENES / "ring" / "ring.gltf"), 5_000, seed=3)


@pytest.fixture
def photons(traced: pl.PhotonMap) -> pl.PhotonMap:
    return traced.select(np.arange(len(traced)))


def test_a_run_sets_parameters_and_colors(photons: pl.PhotonMap) -> None:
    run = photons.run_script(HEIGHT)
    x = photons.positions[:, 0]
    expected = np.where(x < 0, np.nan, 2 * x)[:, None]
    np.testing.assert_array_equal(photons.parameters, expected.astype(np.float32))
    np.testing.assert_array_equal(run.parameters, photons.parameters)
    assert photons.parameter_names == run.parameter_names == ("LEVEL",)
    np.testing.assert_array_equal(photons.parameter_bounds, [[-100, 100]])
    np.testing.assert_array_equal(photons.parameters_set, x >= 0)
    np.testing.assert_array_equal(np.isnan(photons.colors[:, 0]), x < 0)
    assert (photons.colors[x >= 0] == np.float32([1, 0.5, 0])).all()
    assert run.report["parameters"]["LEVEL"]["unset"]["count"] == np.count_nonzero(x < 0)
    assert run.report["columns"] == ["positions"]
    assert [row["kind"] for row in run.report["passes"]] == ["parallel"]


def test_exposed_variables_are_keywords_and_values(photons: pl.PhotonMap) -> None:
    first = photons.run_script(HEIGHT, scale=5).parameters
    second = photons.run_script(HEIGHT, values={"scale": 5})
    np.testing.assert_array_equal(first, second.parameters)
    assert second.exposed == {"scale": 5.0}
    assert np.nanmax(first) > np.nanmax(photons.run_script(HEIGHT).parameters)


@pytest.mark.parametrize(
    ("values", "message"),
    [({"scale": 11}, "scale.*10"), ({"scale": "much"}, "scale"), ({"size": 1}, "no exposed variable 'size'.*scale")],
)
def test_values_out_of_range_are_refused(photons: pl.PhotonMap, values: dict[str, object], message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        photons.run_script(HEIGHT, values=values)


def test_whole_ranges_with_a_step_take_whole_numbers(photons: pl.PhotonMap) -> None:
    text = 'n = 3; expose n range 1, 9 step 1\nprint("n", n);'
    assert photons.run_script(text, n=4).prints == ("n 4",)
    with pytest.raises(pl.ArgumentError, match="whole number"):
        photons.run_script(text, n=4.5)


def test_errors_are_values_with_places() -> None:
    script = pl.compile_script(WRONG)
    assert script.has_errors
    first = script.diagnostics[0]
    assert (first.severity, first.line, first.column, first.end_column) == ("error", 3, 7, 19)
    assert "getPathVertx" in first.message
    assert "getPathVertex" in first.note
    assert "script:3:7: error " in first.text
    assert len(script.diagnostics) == 2


def test_a_script_with_errors_raises_them_and_leaves_the_map(photons: pl.PhotonMap) -> None:
    photons.run_script(HEIGHT)
    before = photons.parameters.copy()
    with pytest.raises(pl.ScriptError, match="getPathVertx") as caught:
        photons.run_script(WRONG)
    assert [diagnostic.line for diagnostic in caught.value.diagnostics] == [3, 3]
    np.testing.assert_array_equal(photons.parameters, before)
    photons.neighbors([int(np.argmax(photons.parameters_set))], 3, space="parameter")


def test_checking_needs_no_device() -> None:
    code = "import photonloupe as pl; s = pl.compile_script('x = 1;'); print(s.diagnostics, len(s.glsl()))"
    environment = {**os.environ, "VK_ICD_FILENAMES": "/nowhere", "VK_DRIVER_FILES": "/nowhere"}
    done = subprocess.run(
        [sys.executable, "-P", "-c", code], env=environment, capture_output=True, text=True, check=True
    )
    assert done.stdout.strip() == "() 0"


def test_a_script_is_a_path_or_a_text(photons: pl.PhotonMap, tmp_path: Path) -> None:
    path = tmp_path / "height.photon"
    path.write_text(HEIGHT)
    for script in (path, str(path), HEIGHT, pl.compile_script(path)):
        photons.run_script(script)
        assert photons.parameter_names == ("LEVEL",)
    with pytest.raises(pl.FileFormatError, match=r"absent\.photon"):
        photons.run_script("absent.photon")
    assert photons.provenance["script"]["name"] == "height.photon"
    assert photons.provenance["script"]["hash"] == pl.compile_script(path).hash


def test_a_run_replaces_everything_unless_told_to_keep(photons: pl.PhotonMap) -> None:
    photons.run_script(HEIGHT)
    kept = photons.parameters.copy()
    photons.run_script("for (i = 0; i < getNumPhotons(); i++) setPhotonColourEncoding(i, 0, 0, 1);", keep=True)
    np.testing.assert_array_equal(photons.parameters, kept)
    assert (photons.colors == np.float32([0, 0, 1])).all()
    photons.run_script(
        """
        n = 0;
        for (i = 0; i < getNumPhotons(); i++) { nn = getParameterKNN(i, 10); n += length(nn); }
        print("neighbors", n);
    """,
        keep=True,
    )
    np.testing.assert_array_equal(photons.parameters, kept)
    photons.run_script("x = 1;")
    assert photons.parameter_names == ()
    with pytest.raises(pl.PhotonLoupeError, match="no parameters"):
        photons.parameters  # noqa: B018
    with pytest.raises(pl.PhotonLoupeError, match="no colors"):
        photons.colors  # noqa: B018


def test_paths_are_traced_when_a_script_reads_them(photons: pl.PhotonMap) -> None:
    assert "path_vertices" not in photons.recorded
    run = photons.run_script("""
        n = 0;
        for (i = 0; i < getNumPhotons(); i++) n += getNumPathVertices(i);
        print("vertices", n);
    """)
    assert run.prints == (f"vertices {len(photons.path_vertices)}",)


def test_columns_that_a_map_lacks_are_named() -> None:
    photons = pl.PhotonMap.from_arrays(
        positions=np.zeros((2, 3)),
        normals=[[0, 1, 0]] * 2,
        power=np.ones((2, 3)),
        path_offsets=[0, 2, 4],
        path_vertices=np.zeros((4, 3)),
    )
    photons.run_script("for (i = 0; i < getNumPhotons(); i++) x = getPathVertex(i, 1, X);")
    with pytest.raises(pl.PhotonLoupeError, match="path_normals"):
        photons.run_script("for (i = 0; i < getNumPhotons(); i++) x = getPathNormal(i, 1, X);")


def test_histograms_and_prints_come_back(photons: pl.PhotonMap) -> None:
    run = photons.run_script("""
        print("photons", getNumPhotons());
        for (i = 0; i < getNumPhotons(); i++) {
            histogram("x", getPhotonPosition(i, X), -1, 1, 16);
            print("at", getPhotonPosition(i, X));
        }
    """)
    x = photons.positions[:, 0]
    counts, edges = np.histogram(x, 16, (-1, 1))
    np.testing.assert_array_equal(run.histograms["x"].counts, counts)
    np.testing.assert_allclose(run.histograms["x"].edges, edges)
    assert (run.histograms["x"].below, run.histograms["x"].above) == (np.sum(x < -1), np.sum(x > 1))
    assert run.prints[0] == f"photons {len(photons)}"
    assert len(run.prints) == 21
    assert run.prints[3] == f"photon 2: at {x[2]:.6g}"


def test_parameters_of_a_script_guide_neighbors_and_relaxation(photons: pl.PhotonMap) -> None:
    photons.run_script("""
        declarePhotonParameter(3, -10, 10);
        for (i = 0; i < getNumPhotons(); i++) setPhotonParameter(i, 3, getPhotonPosition(i, X));
    """)
    ids, _ = photons.neighbors([7], 5, space="parameter")
    apart = np.abs(photons.positions[:, 0] - photons.positions[7, 0])
    apart[7] = np.inf
    np.testing.assert_array_equal(ids[0], np.lexsort((np.arange(len(apart)), apart))[:5])
    assert photons.relax(steps=1).relaxation["settings"]["constraint"] == "parameter"


def test_colors_are_saved_and_loaded(photons: pl.PhotonMap, tmp_path: Path) -> None:
    photons.run_script(HEIGHT)
    photons.save(tmp_path / "map.zarr")
    loaded = pl.load_photons(tmp_path / "map.zarr")
    np.testing.assert_array_equal(loaded.colors, photons.colors)
    np.testing.assert_array_equal(loaded.parameters, photons.parameters)


def test_two_runs_give_the_same_bits(photons: pl.PhotonMap) -> None:
    text = """
        s = 0.0;
        declarePhotonParameter(3, -10, 10);
        for (i = 0; i < getNumPhotons(); i++) {
            s += sin(getPhotonPosition(i, X)) * random(i, 3);
            setPhotonParameter(i, 3, exp(getPhotonPosition(i, Z)) + random(i, 1));
        }
        print("sum", s * 1000000);
    """
    first = photons.run_script(text)
    second = photons.run_script(text)
    assert first.prints == second.prints
    assert first.parameters.tobytes() == second.parameters.tobytes()
    assert photons.run_script(text, seed=2).prints != first.prints


def test_false_color_is_the_color_times_the_luminance(photons: pl.PhotonMap) -> None:
    scene = pl.load_scene(SCENES / "ring" / "ring.gltf")
    with pytest.raises(pl.PhotonLoupeError, match="no colors"):
        pl.render(scene, photons, mode="false-color", width=8, height=8)
    photons.run_script("for (i = 0; i < getNumPhotons(); i++) setPhotonColourEncoding(i, 0.2, 0.4, 1);")
    settings = {"camera": "top", "width": 32, "height": 32, "samples": 1, "k": 20}
    colored = np.asarray(pl.render(scene, photons, mode="false-color", **settings))  # type: ignore[arg-type]
    plain = np.asarray(pl.render(scene, photons, mode="caustic", **settings))  # type: ignore[arg-type]
    luminance = plain @ np.float32([0.2126, 0.7152, 0.0722])
    # The floor is gray: its color's luminance is each of its channels.
    # But for the few pixels that see the gold wall, which colors the light a second time.
    expected = luminance[..., None] * np.float32([0.2, 0.4, 1.0])
    assert np.mean(np.isclose(colored, expected, rtol=2e-4, atol=1e-7)) > FLOOR_SHARE
    assert luminance.max() > 0


def test_false_color_outlives_selection_saving_and_relaxation(photons: pl.PhotonMap, tmp_path: Path) -> None:
    scene = pl.load_scene(SCENES / "ring" / "ring.gltf")
    settings = {"camera": "top", "width": 16, "height": 16, "samples": 1, "k": 20, "mode": "false-color"}
    photons.run_script(HEIGHT)  # photons left of the middle have no parameter: they are grey
    expected = np.asarray(pl.render(scene, photons, **settings))  # type: ignore[arg-type]
    assert not np.allclose(expected[..., 0], expected[..., 2])
    photons.save(tmp_path / "map.zarr")
    for same in (photons.select(np.arange(len(photons))), pl.load_photons(tmp_path / "map.zarr")):
        np.testing.assert_array_equal(np.asarray(pl.render(scene, same, **settings)), expected)  # type: ignore[arg-type]
    relaxed = photons.relax(steps=0)
    np.testing.assert_allclose(np.asarray(pl.render(scene, relaxed, **settings)), expected, rtol=1e-5)  # type: ignore[arg-type]


def test_photons_without_a_parameter_are_grey_though_they_were_given_a_color(photons: pl.PhotonMap) -> None:
    scene = pl.load_scene(SCENES / "ring" / "ring.gltf")
    settings = {"camera": "top", "width": 16, "height": 16, "samples": 1, "k": 20, "mode": "false-color"}
    photons.run_script("""
        declarePhotonParameter(3, 0, 1);
        for (i = 0; i < getNumPhotons(); i++) setPhotonColourEncoding(i, 1, 0, 0);
    """)
    for shown in (photons, photons.select(np.arange(len(photons)))):
        pixels = np.asarray(pl.render(scene, shown, **settings))  # type: ignore[arg-type]
        assert pixels.max() > 0
        np.testing.assert_array_equal(pixels[..., 0], pixels[..., 2])


def test_the_next_script_runs_after_one_that_never_ends(photons: pl.PhotonMap) -> None:
    run = photons.run_script(
        "declarePhotonParameter(3, 0, 1);\n"
        "for (i = 0; i < getNumPhotons(); i++) { while (true) ; setPhotonParameter(i, 3, 1); }",
        limits={"fuel": 1000},
    )
    row = run.report["passes"][0]
    assert row["exhausted"] >= 1000
    assert row["first_exhausted"] == 0
    assert row["exhausted_line"] == 2
    assert row["stopped"]
    assert not photons.parameters_set.any()
    photons.run_script(HEIGHT)
    assert photons.parameters_set.any()


def test_an_empty_map_runs_scripts() -> None:
    photons = pl.PhotonMap.from_arrays(positions=np.zeros((0, 3)), normals=np.zeros((0, 3)), power=np.zeros((0, 3)))
    run = photons.run_script("""
        n = 0;
        declarePhotonParameter(3, 0, 1);
        for (i = 0; i < getNumPhotons(); i++) { n++; setPhotonParameter(i, 3, 1); }
        print("n", n);
    """)
    assert run.prints == ("n 0",)
    assert run.parameters.shape == (0, 1)
