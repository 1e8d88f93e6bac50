# SPDX-License-Identifier: Apache-2.0
"""The scripts in scenes/scripts give what their twins give, run in parallel, and say what they do."""

from __future__ import annotations

import re
from collections.abc import Mapping
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from conftest import SCENES, find_scene, make_columns, write_scene
from gltf import GltfWriter, build_quad, make_diffuse
from script_twins import TWINS, Doubles, Twin, cluster_incidence, find_beta, measure_isotropy

FOLDER = SCENES / "scripts"
SCRIPTS = sorted(path.stem for path in FOLDER.glob("*.photon"))
SETTING = sorted(TWINS)  # scripts that set parameters
MAPS = ("ring", "slab", "plates", "made up")
COUNT = 5_000  # more than a block of 4,096, of which sums over photons are made

# Largest differences of parameters, radians or none, and of colors. Scripts compute with 24 bits in coordinates of
# meters: 2e-6 is some 20 roundings. Others say why.
TOLERANCE = dict.fromkeys(SETTING, (2e-6, 4e-6)) | {
    "tortuosity": (1e-5, 4e-4),  # the arc cosine of almost straight paths; colors are 2π·turns times as sensitive
    "ppca": (1e-5, 1e-5),  # eigenvectors of eigenvalues near each other
    "signature": (0.0, 1e-6),
    "primal_trajectory": (3e-5, 1e-5),  # opposite to the mean direction the plane is torn
    "incident_trajectory": (1e-5, 4e-6),  # the same, where light arrives from behind
    "trajectory_color": (2e-6, 1e-4),  # the same
    "kmeans_incidence": (0.0, 1e-6),
}
# Photons that may differ by more: one half-way between two clusters, where the rounding decides.
ODD = {"kmeans_incidence": 1e-3}
# Every slider, away from its default.
OTHERS: dict[str, dict[str, float]] = {
    "tortuosity": {"turns": 3},
    "ppca": {"turns": 5},
    "signature": {"digits": 1, "hues": 5},
    "primal_trajectory": {"zoom": 1.5},
    "trajectory_color": {"waves": 4},
    "incident_trajectory": {"zoom": 0.75},
    "scatter": {"gamma": 0.5},
    "incidence": {"contrast": 2.5},
    "incident_and_extant": {"extant": 3},
    "kmeans_incidence": {"clusters": 3, "rounds": 2},
}
# Printed numbers have six digits. The script's quantile counts bins of 1/4096, of t_beta here 0.02 and more.
BETA_TOLERANCE = 4e-3
ISOTROPY_COUNT = 2_500  # the twin compares all pairs
PARAMETERIZED = ("primal_trajectory", "incidence", "ppca")


def find_script(name: str) -> Path:
    return FOLDER / f"{name}.photon"


@cache
def trace(name: str, count: int = COUNT) -> pl.PhotonMap:
    return pl.trace_photons(pl.load_scene(find_scene(name)), count, seed=3)


def make_up() -> pl.PhotonMap:
    """Paths of two to four vertices anywhere, of three lights; four of them have no length somewhere."""
    columns = make_columns(3_000)
    columns["path_normals"] /= np.linalg.norm(columns["path_normals"], axis=1, keepdims=True)
    offsets, vertices = columns["path_offsets"], columns["path_vertices"]
    for photon in (0, 1, 2):
        vertices[offsets[photon]] = vertices[offsets[photon] + 1]
    vertices[offsets[6] - 1] = vertices[offsets[6] - 2]
    return pl.PhotonMap.from_arrays(**columns)


@pytest.fixture(scope="module")
def maps(tmp_path_factory: pytest.TempPathFactory) -> Mapping[str, pl.PhotonMap]:
    """Mirror; glass; two diffuse plates, direct light too; paths that no scene would give."""

    def add_ceiling(writer: GltfWriter) -> None:
        writer.add_mesh("ceiling", build_quad(2.0, 2.0), make_diffuse("paint", 0.9))

    path = write_scene(tmp_path_factory.mktemp("plates"), "plates", add_ceiling)
    plates = pl.trace_photons(pl.load_scene(path), COUNT, seed=3, store="all")
    return {"ring": trace("ring"), "slab": trace("slab"), "plates": plates, "made up": make_up()}


def subtract(name: str, found: Doubles, expected: Doubles) -> Doubles:
    """Differences of parameters; of trajectory_color's φ the arc it spans, which at θ = 0 is none."""
    difference = np.abs(found - expected)
    if name == "trajectory_color":
        across = np.abs(np.remainder(found[:, 1] - expected[:, 1] + np.pi, 2.0 * np.pi) - np.pi)
        difference[:, 1] = across * np.sin(expected[:, 0])
    return difference


def check_twin(name: str, run: pl.ScriptRun, twin: Twin) -> None:
    parameters, colors = TOLERANCE[name]
    assert run.colors is not None
    np.testing.assert_array_equal(np.isnan(run.parameters), np.isnan(twin.parameters))
    np.testing.assert_array_equal(np.isnan(run.colors), np.isnan(twin.colors))
    off = subtract(name, run.parameters.astype(np.float64), twin.parameters) > parameters
    tinted = np.abs(run.colors - twin.colors) > colors
    assert np.mean(off.any(axis=1)) <= ODD.get(name, 0.0)
    assert np.mean(tinted.any(axis=1)) <= ODD.get(name, 0.0)


def read_print(run: pl.ScriptRun, text: str) -> list[float]:
    """Numbers of the line that begins with a text."""
    line = next(line for line in run.prints if line.startswith(text))
    return [float(number) for number in line.removeprefix(text).split()]


def test_every_script_has_a_twin() -> None:
    assert set(SCRIPTS) == {*SETTING, "isotropy"}


@pytest.mark.parametrize("name", SCRIPTS)
def test_script_is_parallel_without_a_warning(name: str) -> None:
    script = pl.compile_script(find_script(name))
    assert script.diagnostics == ()
    assert {row["kind"] for row in script.passes} == {"parallel"}


@pytest.mark.parametrize("name", SCRIPTS)
def test_script_opens_with_what_it_computes_its_equation_its_colors_and_how_to_run_it(name: str) -> None:
    opening = re.match(r"(//.*\n)+", find_script(name).read_text())
    assert opening is not None
    assert opening.group().startswith("// SPDX-License-Identifier: Apache-2.0\n")
    for part in ("[SJL15]", "// Colors: ", "// Run:    photonloupe script ", f"scenes/scripts/{name}.photon"):
        assert part in opening.group()


@pytest.mark.parametrize("name", SCRIPTS)
def test_script_names_its_parameters_and_exposes_a_slider(name: str) -> None:
    script = pl.compile_script(find_script(name))
    assert len(script.exposed) > 0
    names = re.findall(r'declarePhotonParameter\(\d+, .*"([a-z0-9 ]+)"', script.text)
    assert len(names) == script.text.count("declarePhotonParameter(")
    assert len(names) > 0 or name == "isotropy"


@pytest.mark.parametrize("map_name", MAPS)
@pytest.mark.parametrize("name", SETTING)
def test_script_gives_what_its_twin_gives(name: str, map_name: str, maps: Mapping[str, pl.PhotonMap]) -> None:
    photons = maps[map_name]
    check_twin(name, photons.run_script(find_script(name)), TWINS[name](photons))


@pytest.mark.parametrize(("name", "values"), OTHERS.items())
def test_sliders_change_what_the_twin_changes(
    name: str, values: dict[str, float], maps: Mapping[str, pl.PhotonMap]
) -> None:
    photons = maps["made up"]
    assert set(values) == {variable.name for variable in pl.compile_script(find_script(name)).exposed}
    usual = photons.run_script(find_script(name))
    for slider, value in values.items():
        run = photons.run_script(find_script(name), values={slider: value})
        check_twin(name, run, TWINS[name](photons, **{slider: value}))
        assert not np.array_equal(run.colors, usual.colors, equal_nan=True)


@pytest.mark.parametrize("map_name", MAPS)
@pytest.mark.parametrize("name", SETTING)
def test_script_reports_no_fault_and_stays_in_bounds(
    name: str, map_name: str, maps: Mapping[str, pl.PhotonMap]
) -> None:
    report = maps[map_name].run_script(find_script(name)).report
    assert report["faults"] == []
    assert report["stopped"] == ""
    assert {row["kind"] for row in report["passes"]} == {"parallel"}
    if map_name == "made up" and name == "incident_trajectory":
        return  # its light arrives from behind, too
    assert [row["out_of_bounds"]["count"] for row in report["parameters"].values()] == [0] * len(report["parameters"])


@pytest.mark.parametrize("name", SETTING)
def test_script_gives_the_same_bits_twice(name: str, maps: Mapping[str, pl.PhotonMap]) -> None:
    first, second = (maps["ring"].run_script(find_script(name)) for _ in range(2))
    assert first.parameters.tobytes() == second.parameters.tobytes()
    assert first.colors is not None
    assert second.colors is not None
    assert first.colors.tobytes() == second.colors.tobytes()
    assert first.prints == second.prints


@pytest.mark.parametrize("name", SETTING)
def test_colors_are_colors(name: str, maps: Mapping[str, pl.PhotonMap]) -> None:
    colors = maps["plates"].run_script(find_script(name)).colors
    assert colors is not None
    assert np.nanmin(colors) >= 0.0
    assert np.nanmax(colors) <= 1.0 + 1e-6


# Each script against something other than its twin.


@pytest.mark.parametrize("map_name", ["ring", "made up"])
def test_primal_trajectory_is_that_of_the_program(map_name: str, maps: Mapping[str, pl.PhotonMap]) -> None:
    photons = maps[map_name]
    run = photons.run_script(find_script("primal_trajectory"))
    expected = pl.find_primal_trajectory(photons)
    np.testing.assert_allclose(run.parameters, expected, atol=TOLERANCE["primal_trajectory"][0], equal_nan=True)


def test_trajectory_color_and_primal_trajectory_are_one_direction(maps: Mapping[str, pl.PhotonMap]) -> None:
    angles = maps["ring"].run_script(find_script("trajectory_color")).parameters.astype(np.float64)
    plane = maps["ring"].run_script(find_script("primal_trajectory")).parameters
    theta, phi = angles.T
    np.testing.assert_allclose(plane, np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=1), atol=2e-6)


@pytest.mark.parametrize(("map_name", "signature"), [("ring", 1), ("ring", 4), ("slab", 8), ("slab", 68)])
def test_signature_picks_the_photons_that_select_picks(
    map_name: str, signature: int, maps: Mapping[str, pl.PhotonMap]
) -> None:
    photons = maps[map_name]
    values = photons.run_script(find_script("signature")).parameters[:, 0]
    expected = photons.select(signature=signature)
    assert len(expected) > 0
    np.testing.assert_array_equal(photons.emitted_index[values == signature], expected.emitted_index)


def test_direct_light_has_signature_0_and_no_tortuosity(maps: Mapping[str, pl.PhotonMap]) -> None:
    photons = maps["plates"]
    direct = np.diff(photons.path_offsets) == 2
    values = photons.run_script(find_script("signature")).parameters[:, 0]
    np.testing.assert_array_equal(values == 0.0, direct)
    np.testing.assert_array_equal(np.isnan(photons.run_script(find_script("tortuosity")).parameters[:, 0]), direct)


def test_signature_of_a_long_path_keeps_its_lowest_digits() -> None:
    interactions = np.array([1, 2] * 10, dtype=np.uint8)
    photons = pl.PhotonMap.from_arrays(
        positions=np.zeros((2, 3)),
        normals=[[0, 1, 0]] * 2,
        power=np.ones((2, 3)),
        path_offsets=[0, 22, 25],
        path_vertices=np.random.default_rng(0).normal(size=(25, 3)),
        path_interactions=[0, *interactions, 0, 0, 2, 0],
    )
    run = photons.run_script(find_script("signature"))
    expected = sum(int(digit) * 3**place for place, digit in enumerate(interactions[:15]))
    assert run.parameters[:, 0].tolist() == [expected, 2]
    assert read_print(run, "photons with more interactions than digits") == [1]


def test_mirrors_and_glass_do_not_scatter(maps: Mapping[str, pl.PhotonMap]) -> None:
    for name in ("ring", "slab"):
        assert not maps[name].run_script(find_script("scatter")).parameters.any()


def test_light_through_a_slab_leaves_as_it_came(maps: Mapping[str, pl.PhotonMap]) -> None:
    run = maps["slab"].run_script(find_script("incident_and_extant"))
    straight = np.diff(maps["slab"].path_offsets) == 4
    # The last segment is 0.3 m long between vertices rounded in meters.
    np.testing.assert_allclose(run.parameters[straight, :3], run.parameters[straight, 3:], atol=2e-5)


def test_incidence_is_a_unit_vector_that_goes_down(maps: Mapping[str, pl.PhotonMap]) -> None:
    arriving = maps["ring"].run_script(find_script("incidence")).parameters
    np.testing.assert_allclose(np.linalg.norm(arriving, axis=1), 1.0, atol=1e-6)
    assert (arriving[:, 1] < 0.0).all()


def test_incident_trajectory_is_the_incidence_seen_from_the_floor(maps: Mapping[str, pl.PhotonMap]) -> None:
    right, up = maps["ring"].run_script(find_script("incident_trajectory")).parameters.astype(np.float64).T
    arriving = maps["ring"].run_script(find_script("incidence")).parameters
    theta = np.hypot(right, up)
    # A floor's basis is x, −z, and y up; incidence points the other way.
    back = np.stack([np.sin(theta) * right / theta, np.cos(theta), -np.sin(theta) * up / theta], axis=1)
    np.testing.assert_allclose(arriving, -back, atol=2e-6)


@pytest.mark.parametrize("clusters", [2, 4, 12])
def test_clusters_tighten_with_every_round(clusters: int, maps: Mapping[str, pl.PhotonMap]) -> None:
    spreads = []
    for rounds in (0, 1, 3, 10):
        run = maps["ring"].run_script(find_script("kmeans_incidence"), clusters=clusters, rounds=rounds)
        spreads += read_print(run, "mean squared distance to the center")
        assert spreads[-1] == pytest.approx(cluster_incidence(maps["ring"], clusters, rounds)[1], rel=1e-5)
    assert sorted(spreads, reverse=True) == spreads


# Isotropy, over parameters that an earlier run left.


@pytest.fixture(scope="module", params=PARAMETERIZED)
def parameterized(request: pytest.FixtureRequest) -> tuple[pl.PhotonMap, Doubles]:
    """A map with the parameters of a script, and its isotropies by the twin."""
    photons = trace("ring", ISOTROPY_COUNT)
    photons = photons.select(np.arange(len(photons)))
    photons.run_script(find_script(request.param))
    return photons, measure_isotropy(photons)


def test_beta_of_the_script_is_the_programs_and_the_twins(parameterized: tuple[pl.PhotonMap, Doubles]) -> None:
    photons, isotropy = parameterized
    run = photons.run_script(find_script("isotropy"), keep=True)
    (t_beta, beta) = read_print(run, "t_beta, beta")
    assert read_print(run, "photons with an isotropy") == [np.count_nonzero(~np.isnan(isotropy))]
    assert beta == pytest.approx(float(pl.optimal_beta(photons)), rel=BETA_TOLERANCE)
    assert beta == pytest.approx(find_beta(isotropy), rel=BETA_TOLERANCE)
    assert beta == pytest.approx(t_beta**-0.5, rel=1e-5)


def test_histogram_and_colors_of_isotropy_are_the_twins(parameterized: tuple[pl.PhotonMap, Doubles]) -> None:
    photons, isotropy = parameterized
    run = photons.run_script(find_script("isotropy"), keep=True)
    found = run.histograms["isotropy"]
    assert (found.below, found.above, found.non_finite) == (0, 0, 0)
    # A photon near an edge may count in the next bin.
    counts = np.histogram(isotropy[~np.isnan(isotropy)], found.edges)[0]
    assert np.abs(np.cumsum(found.counts - counts)).max() <= 3
    colors = 0.5 + 0.5 * np.cos(4.0 * isotropy[:, None] - 2.0 * np.pi * np.arange(3) / 3.0)
    colors[np.isnan(isotropy)] = 0.5
    # In a tie of 24 bits another photon may be the last of the neighbors.
    assert run.colors is not None
    assert np.mean(np.abs(run.colors - colors).max(axis=1) < 1e-4) > 0.99


def test_isotropy_leaves_the_parameters(parameterized: tuple[pl.PhotonMap, Doubles]) -> None:
    photons, _ = parameterized
    before = photons.parameters.copy()
    report = photons.run_script(find_script("isotropy"), keep=True).report
    np.testing.assert_array_equal(photons.parameters, before)
    assert report["faults"] == []


def test_isotropy_gives_the_same_bits_twice(parameterized: tuple[pl.PhotonMap, Doubles]) -> None:
    photons, _ = parameterized
    first, second = (photons.run_script(find_script("isotropy"), keep=True) for _ in range(2))
    assert first.colors is not None
    assert second.colors is not None
    assert first.colors.tobytes() == second.colors.tobytes()
    assert first.prints == second.prints


@pytest.mark.parametrize(("clip", "neighbors"), [(0.0, 100), (0.2, 100), (0.5, 100), (0.05, 20)])
def test_sliders_of_isotropy_are_the_arguments_of_optimal_beta(clip: float, neighbors: int) -> None:
    photons = trace("ring", ISOTROPY_COUNT)
    photons.run_script(find_script("primal_trajectory"))
    run = photons.run_script(find_script("isotropy"), keep=True, clip=clip, neighbors=neighbors)
    expected = float(pl.optimal_beta(photons, neighbors, clip))
    # At clip 0 a single photon decides, of t below a hundredth: half a bin more.
    tolerance = BETA_TOLERANCE if clip else 0.05
    assert read_print(run, "t_beta, beta")[1] == pytest.approx(expected, rel=tolerance)


def test_photons_without_parameters_are_gray() -> None:
    photons = trace("ring", ISOTROPY_COUNT)
    values = photons.positions[:, :1].copy()
    values[::3] = np.nan
    photons.set_parameters(values)
    colors = photons.run_script(find_script("isotropy"), keep=True).colors
    assert colors is not None
    np.testing.assert_array_equal((colors == 0.5).all(axis=1), np.isnan(values[:, 0]))


def test_isotropy_without_parameters_says_what_is_missing() -> None:
    photons = trace("ring", ISOTROPY_COUNT)
    photons.run_script("x = 1;")
    with pytest.raises(pl.PhotonLoupeError, match="no parameters"):
        photons.run_script(find_script("isotropy"))


def test_all_photons_unset_have_no_beta() -> None:
    photons = trace("ring", ISOTROPY_COUNT)
    photons.set_parameters(np.full((len(photons), 1), np.nan))
    run = photons.run_script(find_script("isotropy"), keep=True)
    assert run.prints == ("photons with an isotropy 0",)
