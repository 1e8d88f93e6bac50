# SPDX-License-Identifier: Apache-2.0
"""Participating media against closed forms and a Monte Carlo twin: where light goes, and that none is lost."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from conftest import write_scene
from gltf import GltfWriter, Mesh, build_box, build_quad, make_diffuse, make_glass
from lit_scenes import build_ball, build_panel, make_lamp
from media_twin import Doubles, find_phase, find_point_fluence, make_medium, pass_slab
from photonloupe.paths import parse_signature
from statistics_checks import Z_LIMIT, compute_chi_square_p

P_LIMIT = 1e-4
MILLION = 1 << 20
ENERGY_TOLERANCE = 2e-3
BALANCE_TOLERANCE = 1e-5
BLACK = make_diffuse("black", 0.0)
FLOOR, CEILING, SLAB = 0, 1, 2  # objects of `build_slab`


def load(folder: Path, change: Any) -> pl.Scene:
    return pl.load_scene(write_scene(folder, "media", change, lamp=False, floor=False))


def build_slab(folder: Path, material: dict[str, Any], thickness: float) -> pl.Scene:
    """A slab as good as endless, between a black floor and a black ceiling, straight light on its middle."""

    def change(writer: GltfWriter) -> None:
        floor, ceiling = build_quad(2000.0, -3.0), build_quad(2000.0, 5.0)
        writer.add_mesh("floor", floor, BLACK)
        writer.add_mesh("ceiling", Mesh(ceiling.positions, -ceiling.normals, ceiling.indices[:, ::-1]), BLACK)
        writer.add_mesh("slab", build_box((-50.0, -thickness, -50.0), (50.0, 0.0, 50.0)), material)
        writer.add_spot_light("spot", (0.0, 3.0, 0.0), (0.0, 0.0, 0.0), 1.0, 1e-3, 1e-3)

    return load(folder, change)


def trace_all(scene: pl.Scene, emitted: int = MILLION, **settings: Any) -> pl.PhotonMap:
    return pl.trace_photons(scene, emitted=emitted, store="all", max_bounces=64, **settings)


def share_by_object(photons: pl.PhotonMap, index: int) -> Doubles:
    return photons.power[photons.object == index].sum(axis=0, dtype=np.float64) / photons.report["flux"]["emitted"]


SLABS = {
    "white": ((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), 0.0, 1.0, 1.0),
    "forward": ((0.9, 0.9, 0.9), (0.1, 0.1, 0.1), 0.8, 1.0, 2.0),
    "colored": ((2.0, 1.0, 0.5), (0.1, 0.2, 0.3), 0.0, 1.0, 1.0),
    "leaf": ((0.5, 0.5, 0.5), (0.5, 0.25, 0.5), -0.5, 1.5, 1.0),
}


@pytest.mark.parametrize("name", SLABS)
def test_a_slab_reflects_and_passes_what_its_twin_does(tmp_path: Path, name: str) -> None:
    scattering, absorption, anisotropy, ior, thickness = SLABS[name]
    photons = trace_all(build_slab(tmp_path, make_medium(scattering, absorption, anisotropy, ior), thickness))
    for channel in range(3):
        extinction = scattering[channel] + absorption[channel]
        reflected, passed, _ = pass_slab(
            MILLION, extinction * thickness, scattering[channel] / extinction, anisotropy, ior, seed=channel
        )
        # Four standard deviations of both together; a channel that flights seldom follow is noisier.
        noise = Z_LIMIT * np.sqrt(2.0 * 2.0 / MILLION)
        assert share_by_object(photons, CEILING)[channel] == pytest.approx(reflected, abs=noise)
        assert share_by_object(photons, FLOOR)[channel] == pytest.approx(passed, abs=noise)


def test_a_white_slab_keeps_nothing(tmp_path: Path) -> None:
    photons = trace_all(build_slab(tmp_path, make_medium((2.0, 1.0, 0.5)), 1.0))
    out = share_by_object(photons, FLOOR) + share_by_object(photons, CEILING)
    np.testing.assert_allclose(out, 1.0, rtol=ENERGY_TOLERANCE)


def test_light_that_nothing_stops_decays_exponentially(tmp_path: Path) -> None:
    photons = trace_all(build_slab(tmp_path, make_medium((2.0, 1.0, 0.5), (0.1, 0.2, 0.3)), 1.0))
    straight = photons.select(signature="22")
    share = straight.power.sum(axis=0, dtype=np.float64) / photons.report["flux"]["emitted"]
    np.testing.assert_allclose(share, np.exp([-2.1, -1.2, -0.8]), rtol=0.01)
    # Of the first stop too: as much is stored there as does not pass.
    first = photons.select(signature="2")
    first = first.power[first.object == SLAB].sum(axis=0, dtype=np.float64) / photons.report["flux"]["emitted"]
    np.testing.assert_allclose(first, 1.0 - np.exp([-2.1, -1.2, -0.8]), rtol=0.01)


@pytest.mark.parametrize("store", ["caustic", "indirect", "all"])
def test_paths_and_flux_are_balanced(tmp_path: Path, store: str) -> None:
    scene = build_slab(tmp_path, make_medium((2.0, 1.0, 0.5), (0.1, 0.2, 0.3), 0.3, 1.33), 1.0)
    report = pl.trace_photons(scene, emitted=1 << 17, store=store).report
    assert report["emitted"] == sum(report[end] for end in ("absorbed", "escaped", "truncated", "ended_on_receiver"))
    spent = np.sum([report["flux"][end] for end in ("deposited", "escaped", "truncated")], axis=0)
    np.testing.assert_allclose(spent, report["flux"]["emitted"], rtol=BALANCE_TOLERANCE)


def test_the_border_of_a_fog_neither_bends_nor_reflects(tmp_path: Path) -> None:
    """A fog too thin to stop anything moves no photon by more than rays start off a surface, however flat they are."""

    def change(writer: GltfWriter, has_fog: bool) -> None:
        writer.add_mesh("floor", build_quad(2.0), make_diffuse("floor", 0.5))
        writer.add_point_light("lamp", (0.3, 1.0, 0.2), 1.0)
        if has_fog:
            fog = make_medium((1e-12, 1e-12, 1e-12))
            fog["pbrMetallicRoughness"]["roughnessFactor"] = 1.0
            writer.add_mesh("fog", build_box((-1.5, 0.1, -1.5), (1.5, 0.4, 1.5)), fog)

    clear, foggy = (
        trace_all(load(tmp_path / str(fog), lambda writer, fog=fog: change(writer, fog)), 1 << 16, emission="random")
        for fog in (False, True)
    )
    first = foggy.select(foggy.object == 0)
    direct = np.unique(clear.emitted_index, return_index=True)[1]
    through = np.unique(first.emitted_index, return_index=True)[1]
    assert len(direct) == len(through)
    np.testing.assert_allclose(clear.positions[direct], first.positions[through], atol=3e-5)
    np.testing.assert_allclose(clear.power[direct], first.power[through], rtol=1e-6)


@pytest.mark.parametrize("g", [-0.9, -0.5, 0.0, 0.5, 0.9])
def test_light_is_scattered_as_henyey_and_greenstein_say(tmp_path: Path, g: float) -> None:
    """Directions after the first stop, on a black ball far away; Φ is even."""

    def change(writer: GltfWriter) -> None:
        ball = build_ball(1000.0, 0.0, 64)
        writer.add_mesh("shell", Mesh(ball.positions, -ball.normals, ball.indices[:, ::-1]), BLACK)
        writer.add_mesh("fog", build_ball(0.5, 0.0, 32), make_medium((0.2, 0.2, 0.2), anisotropy=g))
        writer.add_spot_light("spot", (30.0, 40.0, 0.0), (0.0, 0.0, 0.0), 1.0, 1e-3, 1e-3)

    photons = trace_all(load(tmp_path, change), emission="random").select(signature="232")
    direction = photons.positions.astype(np.float64) / np.linalg.norm(photons.positions, axis=1, keepdims=True)
    along = np.array([-0.6, -0.8, 0.0])
    across = np.array([0.8, -0.6, 0.0])
    cosine = np.clip(direction @ along, -1.0, 1.0)
    azimuth = np.arctan2(direction @ across, direction[:, 2])
    # Edges between which the phase function holds as much each.
    edges = np.concatenate([np.cos(np.linspace(np.pi, 0.0, 41))])
    fine = np.linspace(-1.0, 1.0, 400_001)
    middle = 0.5 * (fine[1:] + fine[:-1])
    cdf = np.concatenate([[0.0], np.cumsum(2.0 * np.pi * find_phase(middle, g) * np.diff(fine))])
    shares = np.diff(np.interp(edges, fine, cdf / cdf[-1]))
    counts = np.histogram2d(cosine, azimuth, [edges, np.linspace(-np.pi, np.pi, 9)])[0]
    assert len(photons) > 20_000
    assert compute_chi_square_p(counts, np.repeat(shares[:, None] / 8.0, 8, axis=1) * len(photons)) > P_LIMIT


def trace_ball(folder: Path, albedo: float) -> pl.PhotonMap:
    """A lamp of 1 W in the middle of a ball of 25 mean free paths: as good as endless."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("ball", build_ball(25.0, 0.0, 24), make_medium((albedo,) * 3, (1.0 - albedo,) * 3))
        writer.add_point_light("lamp", (0.0, 0.0, 0.0), 0.25 / np.pi)

    return trace_all(load(folder, change), emission="random")


@pytest.mark.parametrize("albedo", [0.2, 0.5, 0.8])
def test_fluence_about_a_lamp_in_an_endless_medium(tmp_path: Path, albedo: float) -> None:
    photons = trace_ball(tmp_path, albedo)
    radius = np.linalg.norm(photons.positions.astype(np.float64), axis=1)
    edges = np.array([0.1, 0.3, 0.6, 1.0, 1.5, 2.0, 3.0, 4.0, 5.0])
    stopped = np.histogram(radius, edges, weights=photons.power[:, 0].astype(np.float64))[0]
    nodes, weights = np.polynomial.legendre.leggauss(8)
    for low, high, flux in zip(edges, edges[1:], stopped, strict=False):
        r = 0.5 * (high - low) * nodes + 0.5 * (high + low)
        fluence = [find_point_fluence(at, albedo) for at in r]
        truth = 0.5 * (high - low) * np.sum(weights * fluence * 4.0 * np.pi * r**2)
        assert flux == pytest.approx(truth, rel=0.015), (low, high)


def test_far_from_a_lamp_fluence_falls_as_diffusion_theory_says(tmp_path: Path) -> None:
    """κ = √(3 σ_a σ_t) is itself 3 % too large at this albedo: the exact one solves c artanh(κ) = κ."""
    albedo = 0.9
    photons = trace_ball(tmp_path, albedo)
    radius = np.linalg.norm(photons.positions.astype(np.float64), axis=1)
    edges = np.linspace(2.0, 6.0, 9)
    middle = 0.5 * (edges[1:] + edges[:-1])
    # φ r² falls as r e^(-κ r)
    decay = np.log(np.histogram(radius, edges, weights=photons.power[:, 0].astype(np.float64))[0] / middle)
    kappa = -np.polyfit(middle, decay, 1)[0]
    assert kappa == pytest.approx(np.sqrt(3.0 * (1.0 - albedo)), rel=0.08)


def test_fluence_is_estimated_from_the_nearest_photons(tmp_path: Path) -> None:
    photons = trace_ball(tmp_path, 0.5)
    directions = np.random.default_rng(1).normal(size=(64, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    for radius in (1.0, 2.0, 3.0):
        fluence = photons.fluence(radius * directions, k=100)
        assert fluence.shape == (64, 3)
        assert float(fluence.mean()) == pytest.approx(find_point_fluence(radius, 0.5), rel=0.04)


def build_fog(folder: Path, *, g: float = 0.0, scattering: float = 1e-3) -> pl.Scene:
    """Sun from straight above on a box of fog of extinction 1/m."""

    def change(writer: GltfWriter) -> None:
        fog = make_medium((scattering,) * 3, (1.0 - scattering,) * 3, g)
        writer.add_mesh("fog", build_box((-1.0, 0.0, -1.0), (1.0, 1.0, 1.0)), fog)
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), 1.0)

    return load(folder, change)


def look_through_fog(eye: Doubles, target: Doubles, g: float, scattering: float) -> float:
    """Radiance of light scattered once, by integration along the eye's ray."""
    along = (target - eye) / np.linalg.norm(target - eye)
    t = np.linspace(0.0, 10.0, 100_001)
    x = eye + t[:, None] * along
    inside = (np.abs(x[:, [0, 2]]) < 1.0).all(axis=1) & (x[:, 1] > 0.0) & (x[:, 1] < 1.0)
    depth = (1.0 - x[:, 1]) + (t - t[inside][0])
    phase = find_phase(np.array(along[1]), g)
    return float(np.sum(np.where(inside, scattering * phase * np.exp(-depth), 0.0)) * (t[1] - t[0]))


@pytest.mark.parametrize("g", [0.0, 0.6])
@pytest.mark.parametrize("eye", [(0.0, 0.5, 5.0), (0.0, 3.5, 3.0), (0.0, -2.5, 3.0), (0.2, 0.5, 0.3)])
def test_a_picture_shows_light_scattered_once(tmp_path: Path, eye: tuple[float, float, float], g: float) -> None:
    scene, target = build_fog(tmp_path, g=g), np.array([0.0, 0.5, 0.0])
    camera = pl.Camera(position=eye, target=tuple(target), yfov=0.04)
    image = pl.render(scene, trace_all(scene), camera=camera, width=16, height=16, samples=4, mode="caustic", k=15)
    shown = float(np.asarray(image, dtype=np.float64).mean())
    assert shown == pytest.approx(look_through_fog(np.array(eye), target, g, 1e-3), rel=0.02)


LAMPS = {
    "sun": lambda writer: writer.add_directional_light("lamp", (0.0, -1.0, 0.0), 1.0),
    "point": lambda writer: writer.add_point_light("lamp", (0.3, 1.4, 0.2), 1.0),
    "inside": lambda writer: writer.add_point_light("lamp", (0.1, 0.5, 0.2), 1.0),
    "panel": lambda writer: writer.add_mesh("lamp", build_panel(0.2, 1.3), make_lamp(5.0)),
}


@pytest.mark.parametrize("lamp", LAMPS)
def test_direct_light_is_what_photons_show_of_the_first_scattering(tmp_path: Path, lamp: str) -> None:
    """Nearly nothing is scattered twice, so that an `all` map shows the same."""

    def change(writer: GltfWriter) -> None:
        fog = make_medium((1e-3, 2e-3, 5e-4), (1.0, 0.5, 0.3), 0.4)
        writer.add_mesh("fog", build_box((-1.0, 0.0, -1.0), (1.0, 1.0, 1.0)), fog)
        LAMPS[lamp](writer)

    scene = load(tmp_path, change)
    camera = pl.Camera(position=(0.2, 0.6, 4.0), target=(0.0, 0.45, 0.0), yfov=0.2)
    size = {"camera": camera, "width": 16, "height": 16}
    photons = np.asarray(pl.render(scene, trace_all(scene), samples=16, mode="caustic", k=20, **size), dtype=np.float64)
    direct = np.asarray(pl.render(scene, samples=64, mode="direct", **size), dtype=np.float64)
    np.testing.assert_allclose(direct.mean(axis=(0, 1)), photons.mean(axis=(0, 1)), rtol=0.03)


def test_a_medium_of_another_index_shows_less_than_it_holds(tmp_path: Path) -> None:
    """Radiance is divided by n² on leaving; sun and eye straight above, light scattered once."""
    ior, albedo, depth = 1.5, 1e-3, 3.0

    def change(writer: GltfWriter) -> None:
        medium = make_medium((albedo,) * 3, (1.0 - albedo,) * 3, ior=ior)
        writer.add_mesh("slab", build_box((-1.0, -depth, -1.0), (1.0, 0.0, 1.0)), medium)
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), 1.0)

    scene = load(tmp_path, change)
    camera = pl.Camera(position=(0.0, 5.0, 0.0), target=(0.0, 0.0, 0.0), yfov=0.1, up=(0.0, 0.0, -1.0))
    image = pl.render(scene, trace_all(scene), camera=camera, width=16, height=16, samples=8, mode="caustic", k=8)
    truth = 0.96**2 / ior**2 * albedo / (4.0 * np.pi) * 0.5 * (1.0 - np.exp(-2.0 * depth))
    assert float(np.asarray(image, dtype=np.float64).mean()) == pytest.approx(truth, rel=0.03)


def test_fog_weakens_direct_light_and_what_is_seen(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("floor", build_quad(1.0, 0.1), make_diffuse("floor", 0.5))
        writer.add_mesh("fog", build_box((-2.0, 0.0, -2.0), (2.0, 1.0, 2.0)), make_medium((1e-9,) * 3, (1.0, 0.5, 0.1)))
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), 1.0)

    camera = pl.Camera(position=(0.0, 3.0, 0.0), target=(0.0, 0.0, 0.0), yfov=0.1, up=(0.0, 0.0, -1.0))
    image = np.asarray(pl.render(load(tmp_path, change), mode="direct", camera=camera, width=4, height=4))
    truth = 0.5 / np.pi * np.exp(-2.0 * 0.9 * np.array([1.0, 0.5, 0.1]))
    np.testing.assert_allclose(image.mean(axis=(0, 1)), truth, rtol=2e-3)


def test_lamp_and_glass_within_a_fog(tmp_path: Path) -> None:
    """Light starts in the fog, crosses a glass pane in it, and is in the fog again behind."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("floor", build_quad(2.0, 0.1), BLACK)
        writer.add_mesh("fog", build_box((-3.0, 0.0, -3.0), (3.0, 3.0, 3.0)), make_medium((1e-9,) * 3, (0.5, 0.5, 0.5)))
        writer.add_mesh("pane", build_box((-2.0, 0.8, -2.0), (2.0, 1.2, 2.0)), make_glass("pane", 1.5, 0.4))
        writer.add_spot_light("spot", (0.0, 2.1, 0.0), (0.0, 0.0, 0.0), 1.0, 1e-3, 1e-3)

    photons = pl.trace_photons(load(tmp_path, change), emitted=1 << 18, store="caustic").select(signature="22")
    share = float(share_by_object(photons, FLOOR)[0])
    assert share == pytest.approx(0.96**2 * np.exp(-0.5 * 1.6), rel=0.01)


def test_everything_else_takes_maps_with_photons_in_media(tmp_path: Path) -> None:
    """Surfaces do not gather them, relaxation leaves them where they are, files and views keep them."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("floor", build_quad(2.0, 0.1), make_diffuse("floor", 0.5))
        writer.add_mesh("fog", build_box((-1.0, 0.05, -1.0), (1.0, 1.0, 1.0)), make_medium((1.0,) * 3, (0.5,) * 3))
        writer.add_point_light("lamp", (0.0, 2.0, 0.0), 1.0)

    scene = load(tmp_path, change)
    photons = pl.trace_photons(scene, 20_000, store="all")
    in_fog = np.linalg.norm(photons.normals, axis=1) < 0.75
    assert 0 < in_fog.sum() < len(photons)
    surface = photons.select(~in_fog)
    points = np.random.default_rng(0).uniform(-0.8, 0.8, (50, 3)) * [1.0, 0.0, 1.0] + [0.0, 0.1, 0.0]
    up = (0.0, 1.0, 0.0)
    np.testing.assert_allclose(photons.irradiance(points, up, k=20), surface.irradiance(points, up, k=20), rtol=1e-5)
    relaxed = photons.relax(steps=3)
    np.testing.assert_array_equal(relaxed.positions[in_fog], photons.positions[in_fog])
    assert np.abs(relaxed.positions[~in_fog] - photons.positions[~in_fog]).max() > 0.0
    assert set(np.unique(photons.path_interactions)) == {0, 1, 2, 3}
    np.testing.assert_allclose(photons.path_normals[np.flatnonzero(photons.path_interactions == 3)], 0.0, atol=0.51)
    relaxed.save(tmp_path / "fog.zarr")
    again = pl.load_photons(tmp_path / "fog.zarr")
    np.testing.assert_array_equal(again.normals, photons.normals)
    photons.run_script("scenes/scripts/signature.photon")
    assert np.isfinite(photons.parameters).all()
    for mode in ("composite", "photons", "voronoi", "false-color"):
        assert np.isfinite(np.asarray(pl.render(scene, photons, width=24, height=24, samples=1, mode=mode))).all()


def test_a_sun_through_fog_gives_its_photons_to_no_surface(tmp_path: Path) -> None:
    """All photons have one normal, which is no surface's."""
    photons = trace_all(build_fog(tmp_path, scattering=0.0 + 1e-6), 1 << 14)
    up = photons.normals[0] / np.linalg.norm(photons.normals[0])
    assert (photons.irradiance(photons.positions[:20], up, k=5) == 0.0).all()


@pytest.mark.parametrize(
    ("extras", "message"),
    [
        ({"scattering": [1.0, 1.0]}, "scattering"),
        ({"scattering": [-1.0, 0.0, 0.0]}, "scattering"),
        ({"scattering": "much"}, "scattering"),
        ({"anisotropy": 1.0}, "anisotropy"),
        ({"scatering": [1.0, 1.0, 1.0]}, "scatering"),
        ([1.0], "photonloupe"),
    ],
)
def test_what_is_no_medium_is_refused(tmp_path: Path, extras: Any, message: str) -> None:
    material = {**make_medium((1.0, 1.0, 1.0)), "extras": {"photonloupe": extras}}
    with pytest.raises(pl.SceneError, match=message):
        load(tmp_path, lambda writer: writer.add_mesh("box", build_box((0, 0, 0), (1, 1, 1)), material))


def test_a_medium_needs_an_inside(tmp_path: Path) -> None:
    material = {**make_diffuse("wall", 0.5), "extras": make_medium((1.0, 1.0, 1.0))["extras"]}
    with pytest.raises(pl.SceneError, match="inside"):
        load(tmp_path, lambda writer: writer.add_mesh("box", build_box((0, 0, 0), (1, 1, 1)), material))


def test_other_programs_extras_pass(tmp_path: Path) -> None:
    material = {**make_diffuse("wall", 0.5), "extras": {"photon": 1, "name": ["x"]}}
    scene = load(tmp_path, lambda writer: writer.add_mesh("box", build_box((0, 0, 0), (1, 1, 1)), material))
    assert "participating media" not in scene.describe().split("required:")[1].split("\n")[0]


def test_khronos_volume_scatter_is_read(tmp_path: Path) -> None:
    """A half space of single albedo 1 is white, of 0 is black."""
    material = make_medium((0.0, 0.0, 0.0), (2.0, 2.0, 2.0))
    del material["extras"]
    material["extensions"]["KHR_materials_volume_scatter"] = {
        "multiscatterColor": [1.0, 0.0, 0.5],
        "scatterAnisotropy": 0.25,
    }
    scene = load(tmp_path, lambda writer: writer.add_mesh("box", build_box((0, 0, 0), (1, 1, 1)), material))
    text = scene.describe()
    assert "required: dielectrics" in text
    assert "participating media" in text.split("left out")[0]
    told = re.search(r"scattering \((.*?)\)", text)
    assert told is not None
    np.testing.assert_allclose([float(number) for number in told[1].split(",")], [2.0, 0.0, 1.8235], atol=1e-3)
    assert "anisotropy 0.25" in text


def test_a_digit_0_in_a_signature_stands_for_scattered() -> None:
    assert parse_signature(3) == parse_signature("31")
