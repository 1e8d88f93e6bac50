# SPDX-License-Identifier: Apache-2.0
"""Spot, directional and area lights: power, where it falls, and aiming, against closed forms and against each other."""

from __future__ import annotations

import itertools
from pathlib import Path

import numpy as np
import pytest

import photonloupe as pl
from gltf import GltfWriter, Mesh, make_glass, make_mirror
from lit_scenes import (
    HEIGHT,
    INNER,
    LIGHTS,
    OUTER,
    Doubles,
    add_optics,
    add_spot,
    build_ball,
    build_panel,
    load,
    make_lamp,
    render_below,
)
from statistics_checks import compute_chi_square_p

ENERGY_TOLERANCE = 2e-3
EXACT = 2e-6
P_LIMIT = 1e-4
PHOTONS = 1 << 20


def measure_spot(angle: float | Doubles, inner: float = INNER, outer: float = OUTER) -> Doubles:
    """W within an angle of the axis, of a spot of 1 W/sr there."""
    rings = np.cos(np.linspace(0.0, np.minimum(angle, outer), 20_001))
    ramp = np.clip((rings - np.cos(outer)) / (np.cos(inner) - np.cos(outer)), 0.0, 1.0)
    return 2.0 * np.pi * np.trapezoid(np.square(ramp), -rings, axis=0)


@pytest.mark.parametrize("emission", ["sobol", "random"])
def test_spot_sends_its_power_where_its_profile_says(tmp_path: Path, emission: str) -> None:
    scene = load(tmp_path, add_spot)
    photons = pl.trace_photons(scene, emitted=PHOTONS, store="all", max_bounces=1, emission=emission)
    emitted = photons.report["flux"]["emitted"]
    np.testing.assert_allclose(emitted, 10.0 * measure_spot(OUTER), rtol=1e-5)
    first = photons.select(photons.positions[:, 1] == photons.positions[:, 1].min())
    assert np.ptp(photons.power) == 0.0  # all alike
    off_axis = np.hypot(first.positions[:, 0] - 0.1, first.positions[:, 2] + 0.2)
    rings = np.linspace(0.0, OUTER, 33)
    counts = np.histogram(np.arctan2(off_axis, HEIGHT), rings)[0].astype(np.float64)
    shares = np.diff(measure_spot(rings)) / measure_spot(OUTER)
    if emission == "random":
        assert compute_chi_square_p(counts, shares * PHOTONS) > P_LIMIT
    else:
        np.testing.assert_allclose(counts / PHOTONS, shares, atol=2e-5)
    assert counts.sum() == len(first)


@pytest.mark.parametrize(("inner", "outer"), [(0.0, 1e-3), (0.2, 0.2), (0.0, np.pi / 2), (0.02, 0.0201)])
def test_narrow_wide_and_hard_spots_keep_their_power(tmp_path: Path, inner: float, outer: float) -> None:
    scene = load(tmp_path, lambda writer: add_spot(writer, inner, outer))
    flux = pl.trace_photons(scene, emitted=1 << 17, store="all").report["flux"]["emitted"]
    ramp = max(np.cos(inner) - np.cos(outer), 0.0)
    truth = 2.0 * np.pi * ((1.0 - np.cos(inner)) + ramp / 3.0)
    np.testing.assert_allclose(flux, 10.0 * truth, rtol=1e-4)


def test_directional_light_falls_evenly(tmp_path: Path) -> None:
    direction = np.array([0.3, -1.0, 0.2])
    scene = load(tmp_path, lambda writer: writer.add_directional_light("sun", direction, 3.0))
    photons = pl.trace_photons(scene, emitted=PHOTONS, store="all", max_bounces=1)
    cosine = 1.0 / np.linalg.norm(direction)
    np.testing.assert_allclose(photons.total_flux, 3.0 * cosine * 16.0, rtol=ENERGY_TOLERANCE)
    cells = np.histogram2d(photons.positions[:, 0], photons.positions[:, 2], 16, [(-2.0, 2.0)] * 2)[0]
    np.testing.assert_allclose(cells / len(photons), 1.0 / 256.0, rtol=0.02)
    np.testing.assert_allclose(photons.irradiance([[0.1, 0.0, 0.3]], [0, 1, 0])[0], 3.0 * cosine, rtol=0.05)


def find_panel_irradiance(half: float, height: float) -> float:
    """Of a square panel of radiance 1 on a parallel element under its middle, W/m²."""
    x = half / height
    return 4.0 * x / np.sqrt(1.0 + x * x) * np.arctan(x / np.sqrt(1.0 + x * x))


def integrate_panel(half: float, height: float, place: tuple[float, float]) -> float:
    """The same anywhere on a plane below, by the midpoint rule."""
    middles = (np.arange(32) + 0.5) / 16.0 - 1.0
    dx, dz = half * middles[:, None] - place[0], half * middles[None, :] - place[1]
    cells = height**2 / np.square(dx * dx + dz * dz + height**2)
    return float(cells.mean() * 4.0 * half**2)


@pytest.mark.parametrize("is_two_sided", [False, True])
def test_panel_sends_its_power(tmp_path: Path, is_two_sided: bool) -> None:
    half, radiance = 0.25, 8.0

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("panel", build_panel(half, HEIGHT), make_lamp(radiance, is_two_sided=is_two_sided))

    scene = load(tmp_path, change)
    assert [light["kind"] for light in scene.lights] == ["area"]
    photons = pl.trace_photons(scene, emitted=PHOTONS, store="all", max_bounces=1)
    color = radiance * np.array([1.0, 0.5, 0.25])
    sides = 2.0 if is_two_sided else 1.0
    np.testing.assert_allclose(photons.report["flux"]["emitted"], sides * np.pi * color * 4.0 * half**2, rtol=1e-5)
    x, z = (axis.ravel() for axis in np.meshgrid(*[np.linspace(-1.0, 1.0, 21)] * 2))
    truth = np.mean([integrate_panel(half, HEIGHT, place) for place in zip(x, z, strict=True)])
    found = photons.irradiance(np.stack([x, 0.0 * x, z], axis=1), [0, 1, 0], k=300).mean(axis=0)
    np.testing.assert_allclose(found, color * truth, rtol=0.01)


def test_pictures_hold_the_direct_light_of_every_kind(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("panel", build_panel(0.25, HEIGHT), make_lamp(8.0))

    panel = render_below(load(tmp_path / "panel", change), samples=1024)
    np.testing.assert_allclose(panel, 8.0 * np.array([1.0, 0.5, 0.25]) * find_panel_irradiance(0.25, 1.0), rtol=0.01)
    sun = load(tmp_path / "sun", lambda writer: writer.add_directional_light("sun", (1.0, -1.0, 0.0), 3.0))
    np.testing.assert_allclose(render_below(sun), 3.0 / np.sqrt(2.0), rtol=EXACT)

    def add_tilted(writer: GltfWriter) -> None:
        writer.add_spot_light("spot", (0.0, 1.0, 0.0), (np.tan(0.45), 0.0, 0.0), 10.0, INNER, OUTER)

    ramp = ((np.cos(0.45) - np.cos(OUTER)) / (np.cos(INNER) - np.cos(OUTER))) ** 2
    np.testing.assert_allclose(render_below(load(tmp_path / "spot", add_tilted)), 10.0 * ramp, rtol=2e-3)


def test_one_sided_lamps_are_dark_from_behind(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("panel", build_panel(0.25, HEIGHT), make_lamp(8.0))

    scene = load(tmp_path, change)
    camera = pl.Camera(position=(0.0, 3.0, 0.0), target=(0.0, 0.0, 0.0), up=(1.0, 0.0, 0.0), yfov=0.05)
    from_behind = np.asarray(pl.render(scene, mode="direct", camera=camera, width=4, height=4))
    assert not from_behind.any()


@pytest.mark.parametrize("name", LIGHTS)
def test_aimed_light_gives_the_caustic_of_all_light(tmp_path: Path, name: str) -> None:
    def change(writer: GltfWriter) -> None:
        add_optics(writer)
        LIGHTS[name](writer)

    scene = load(tmp_path, change)
    if name == "environment":
        scene.add_light("environment", intensity=2.0)
    aimed = pl.trace_photons(scene, emitted=PHOTONS)
    everything = pl.trace_photons(scene, emitted=PHOTONS, store="indirect", max_bounces=8, columns=["path_scatter"])
    # Of all light, photons that met specular surfaces alone before they landed.
    starts, scatter = everything.path_offsets, everything.path_scatter
    before_last = np.array([scatter[a + 1 : b - 1].max(initial=0.0) for a, b in itertools.pairwise(starts)])
    caustic = everything.power[before_last == 0.0].sum(axis=0, dtype=np.float64)
    tolerance = max(0.01, 4.0 / np.sqrt(np.count_nonzero(before_last == 0.0)))
    np.testing.assert_allclose(aimed.total_flux, caustic, rtol=tolerance)
    assert len(aimed) > 0.2 * np.count_nonzero(before_last == 0.0)
    # Aiming wastes less.
    if name not in ("box", "environment"):
        share = aimed.report["flux"]["emitted"][0] / everything.report["flux"]["emitted"][0]
        assert share < 0.95


def test_environment_lights_evenly(tmp_path: Path) -> None:
    scene = load(tmp_path, lambda writer: None)
    scene.add_light("environment", intensity=2.0, color=(1.0, 0.5, 0.25))
    radiance = 2.0 * np.array([1.0, 0.5, 0.25])
    photons = pl.trace_photons(scene, emitted=PHOTONS, store="all", max_bounces=1)
    np.testing.assert_allclose(photons.total_flux, radiance * np.pi * 2.0 * 16.0, rtol=ENERGY_TOLERANCE)  # both sides
    np.testing.assert_allclose(photons.irradiance([[0.2, 0, 0.1]], [0, 1, 0], k=500)[0], np.pi * radiance, rtol=0.05)
    np.testing.assert_allclose(render_below(scene), np.pi * radiance, rtol=EXACT)
    away = pl.Camera(position=(0.0, 1.0, 0.0), target=(0.0, 2.0, 0.0), up=(1.0, 0.0, 0.0))
    seen = np.asarray(pl.render(scene, mode="direct", camera=away, width=4, height=4))
    np.testing.assert_allclose(seen, np.broadcast_to(radiance, seen.shape), rtol=EXACT)


def test_many_lights_share_photons_by_their_power(tmp_path: Path) -> None:
    rng = np.random.default_rng(5)
    powers = rng.uniform(0.1, 10.0, 1000)
    powers[::7] = 0.0
    places = rng.uniform([-1.0, 1.0, -1.0], [1.0, 3.0, 1.0], (1000, 3))

    def change(writer: GltfWriter) -> None:
        for number, (place, power) in enumerate(zip(places, powers, strict=True)):
            writer.add_point_light(f"lamp {number}", tuple(place), float(power))

    scene = load(tmp_path, change)
    photons = pl.trace_photons(scene, emitted=PHOTONS, store="all", max_bounces=1, emission="random")
    np.testing.assert_allclose(photons.report["flux"]["emitted"], 4.0 * np.pi * powers.sum(), rtol=1e-5)
    first = photons.select(np.unique(photons.emitted_index, return_index=True)[1])
    # How much of each lamp's light meets the floor depends on its place: compare the fluxes, not the counts.
    from oracles import plane_cell_flux  # noqa: PLC0415

    truth = [
        plane_cell_flux([-2.0, 2.0], [-2.0, 2.0], tuple(place), float(power))[0, 0] if power > 0 else 0.0
        for place, power in zip(places, powers, strict=True)
    ]
    counts = np.bincount(first.emitter, minlength=1000).astype(np.float64)
    each = float(first.power[0, 0])
    assert not counts[powers == 0.0].any()
    assert compute_chi_square_p(counts, np.array(truth) / each) > P_LIMIT


@pytest.mark.parametrize(
    ("cone", "message"),
    [
        ({"innerConeAngle": 0.5, "outerConeAngle": 0.4}, "inner cone is wider"),
        ({"outerConeAngle": 2.0}, "outerConeAngle"),
        ({"outerConeAngle": 0.0}, "must be more than 0"),
    ],
)
def test_wrong_cones_are_refused(tmp_path: Path, cone: dict[str, float], message: str) -> None:
    with pytest.raises(pl.SceneError, match=message):
        load(tmp_path, lambda writer: writer._place_light("spot", "spot", 1.0, {}, spot=cone))


def test_many_lamps_among_many_mirrors_take_seconds(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("ball", build_ball(0.4, 0.6, 96), make_mirror("mirror", (1.0, 1.0, 1.0)))
        for x in np.linspace(-1.5, 1.5, 40):
            panel = build_panel(0.02, 1.5)
            writer.add_mesh(
                f"lamp {x}",
                Mesh(panel.positions + np.array([x, 0.0, 0.0]), panel.normals, panel.indices),
                make_lamp(8.0),
            )

    photons = pl.trace_photons(load(tmp_path, change), 20_000)
    assert len(np.unique(photons.emitter)) == 40


def test_light_comes_from_before_what_is_near_and_not_what_is_far(tmp_path: Path) -> None:
    scene = load(tmp_path, add_optics)
    scene.add_light("directional", direction=(-0.5, -1.0, 0.2), intensity=3.0)
    near = pl.trace_photons(scene, emitted=1 << 18)
    scene.add_light("area", position=(1e6, 2e6, 0.0), intensity=0.0)
    far = pl.trace_photons(scene, emitted=1 << 18)
    np.testing.assert_allclose(far.total_flux, near.total_flux, rtol=ENERGY_TOLERANCE)


def test_start_of_directional_light_tells_its_photons_apart(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        add_optics(writer)
        LIGHTS["directional"](writer)

    photons = pl.trace_photons(load(tmp_path, change), 5000)
    theta, phi = (pl.inspect.column(photons, f"primal_{name}").values for name in ("theta", "phi"))
    assert theta.max() <= 1.0 + 1e-5
    assert theta.max() > 0.5
    place = np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=1)
    starts = photons.path_vertices[photons.path_offsets[:-1]]
    # Distances between starts are those between places, times the disc's radius.
    a, b = np.arange(0, len(photons) - 1, 7), np.arange(1, len(photons), 7)[: len(np.arange(0, len(photons) - 1, 7))]
    far = np.linalg.norm(starts[a] - starts[b], axis=1)
    near = np.linalg.norm(place[a] - place[b], axis=1)
    np.testing.assert_allclose(near * (far.sum() / near.sum()), far, rtol=1e-3, atol=1e-4)


def test_ball_lens_follows_its_closed_form(tmp_path: Path) -> None:
    # Parallel light, plane at distance D behind the middle.
    radius, distance, index, irradiance = 0.5, 0.9, 1.5, 2.0

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("ball", build_ball(radius, distance), make_glass("glass", index, 1.0))
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), irradiance)

    photons = pl.trace_photons(load(tmp_path, change), emitted=1 << 20, emission="random")
    twice = photons.select(signature="22")
    starts = twice.path_vertices[twice.path_offsets[:-1]]
    b = np.hypot(starts[:, 0], starts[:, 2]).astype(np.float64)
    keep = b < 0.9 * radius  # nearer to the rim facets turn light by too much
    turn = 2.0 * (np.arcsin(b[keep] / radius) - np.arcsin(b[keep] / (radius * index)))
    landed = (b[keep] - distance * np.sin(turn)) / np.cos(turn)
    along = np.einsum("ij,ij->i", starts[keep][:, [0, 2]], twice.positions[keep][:, [0, 2]]) / np.maximum(b[keep], 1e-9)
    np.testing.assert_allclose(along, landed, atol=2e-3)
    # Flux: what two faces let through, by Fresnel's equations.
    rim = np.sqrt((np.arange(200_000) + 0.5) / 200_000)  # equal areas of the disc
    i, r = np.arcsin(rim), np.arcsin(rim / index)
    reflected = 0.5 * ((np.sin(i - r) / np.sin(i + r)) ** 2 + (np.tan(i - r) / np.tan(i + r)) ** 2)
    reach = np.abs((radius * rim - distance * np.sin(2.0 * (i - r))) / np.cos(2.0 * (i - r)))
    # What comes out upwards or lands beyond the floor, a square of half side 2, is gone.
    on_floor = 1.0 - np.clip(4.0 / np.pi * np.arccos(np.clip(2.0 / np.maximum(reach, 2.0), 0.0, 1.0)), 0.0, 1.0)
    on_floor[2.0 * (i - r) >= np.pi / 2.0] = 0.0
    truth = irradiance * np.pi * radius**2 * np.mean((1.0 - reflected) ** 2 * on_floor)
    np.testing.assert_allclose(twice.total_flux, truth, rtol=ENERGY_TOLERANCE)


def test_tracing_says_early_how_many_photons_land(tmp_path: Path) -> None:
    told: list[str] = []
    scene = load(tmp_path, add_spot)
    photons = pl.trace_photons(scene, 200_000, store="all", progress=lambda stage, _: told.append(stage) or True)
    first = next(stage for stage in told if stage != "trace photons")
    share = float(first.removeprefix("trace photons, ").removesuffix(" % land"))
    assert share == pytest.approx(100.0 * len(photons) / photons.emitted, rel=0.05)
    assert told.index(first) == 1
