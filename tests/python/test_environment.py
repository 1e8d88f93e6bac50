# SPDX-License-Identifier: Apache-2.0
"""Environments that an image says: power, where it falls, what eyes see, and files that are none."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import photonloupe as pl
from conftest import write_scene
from gltf import GltfWriter, make_glass, make_mirror
from lit_scenes import Doubles, add_optics, build_ball, build_panel, load, render_below

ENERGY_TOLERANCE = 2e-3
EXACT = 2e-6
P_LIMIT = 1e-4
PHOTONS = 1 << 20


def write_sky(folder: Path, pixels: Any, name: str = "sky.exr") -> Path:
    folder.mkdir(parents=True, exist_ok=True)
    pl.Image(np.ascontiguousarray(pixels, dtype=np.float32)).save(folder / name)
    return folder / name


def make_sky(height: int, radiance: Callable[[Doubles, Doubles, Doubles], Any]) -> Doubles:
    """Pixels (height, 2 height, 3) of a radiance at the middles of texels, by x, y, z of the direction."""
    polar = np.pi * (np.arange(height) + 0.5)[:, None] / height
    azimuth = 2.0 * np.pi * ((np.arange(2 * height) + 0.5)[None, :] / (2 * height) - 0.5)
    x, y, z = np.broadcast_arrays(np.sin(polar) * np.cos(azimuth), np.cos(polar), np.sin(polar) * np.sin(azimuth))
    return np.broadcast_to(np.asarray(radiance(x, y, z), dtype=np.float64), (height, 2 * height, 3)).copy()


def weigh_rows(height: int) -> Doubles:
    """Solid angle of a texel by its row."""
    return -np.diff(np.cos(np.pi * np.arange(height + 1) / height)) * np.pi / height


def light_floor(
    folder: Path, pixels: Any, change: Callable[[GltfWriter], Any] = lambda writer: None, **told: Any
) -> pl.Scene:
    scene = load(folder, change)
    scene.add_light("environment", image=write_sky(folder, pixels), **told)
    return scene


def find_directions(photons: pl.PhotonMap) -> Doubles:
    """Where the light of each photon comes from."""
    starts = photons.path_offsets[:-1]
    way = photons.path_vertices[starts].astype(np.float64) - photons.path_vertices[starts + 1]
    return way / np.linalg.norm(way, axis=1, keepdims=True)


def test_constant_image_is_the_constant_environment(tmp_path: Path) -> None:
    by_image = light_floor(tmp_path, np.full((16, 32, 3), (4.0, 2.0, 1.0)), add_optics, intensity=0.5)
    plain = load(tmp_path / "plain", add_optics)
    plain.add_light("environment", intensity=2.0, color=(1.0, 0.5, 0.25))
    photons, truth = (
        pl.trace_photons(scene, emitted=1 << 17, store="all", max_bounces=1) for scene in (by_image, plain)
    )
    np.testing.assert_allclose(photons.report["flux"]["emitted"], truth.report["flux"]["emitted"], rtol=1e-6)
    np.testing.assert_allclose(photons.total_flux, truth.total_flux, rtol=1e-5)
    np.testing.assert_array_equal(photons.emitted_index, truth.emitted_index)
    away = np.linalg.norm(photons.positions - truth.positions, axis=1)
    assert np.quantile(away, 0.999) < 1e-5


@pytest.mark.parametrize("emission", ["sobol", "random"])
def test_photons_carry_the_power_of_the_sky_to_the_floor(tmp_path: Path, emission: str) -> None:
    sky = make_sky(64, lambda x, y, z: np.stack([1.0 + 0.0 * y, (y > 0) * 1.0, (x > 0) * np.maximum(y, 0.0)], axis=2))
    scene = light_floor(tmp_path, sky)
    photons = pl.trace_photons(scene, emitted=PHOTONS, store="all", max_bounces=1, emission=emission)
    # All discs are of one size: what is emitted is their area times the integral of the radiance.
    integral = (sky * weigh_rows(64)[:, None, None]).sum(axis=(0, 1))
    emitted = np.array(photons.report["flux"]["emitted"])
    radius = np.hypot(2.0, 2.0) * 1.001  # of the floor's corners
    tolerance = 1e-5 if emission == "sobol" else ENERGY_TOLERANCE
    np.testing.assert_allclose(emitted, integral * np.pi * radius**2, rtol=tolerance)
    # Red from both sides; green from above; blue is y over half the sky, whose cosine integral is 2π/3 / 2.
    truth = 16.0 * np.array([2.0 * np.pi, np.pi, np.pi / 3.0])
    np.testing.assert_allclose(photons.total_flux, truth, rtol=2.0 * ENERGY_TOLERANCE)


def test_half_a_white_sky_gives_half_the_irradiance(tmp_path: Path) -> None:
    half = light_floor(tmp_path, make_sky(64, lambda x, y, z: ((x > 0) * 3.0)[..., None] * np.ones(3)))
    np.testing.assert_allclose(render_below(half, 256), 3.0 * np.pi / 2.0, rtol=0.01)
    photons = pl.trace_photons(half, emitted=PHOTONS, store="all", max_bounces=1)
    above = photons.irradiance([[0.2, 0.0, 0.1]], [0, 1, 0], k=1000)[0]
    np.testing.assert_allclose(above, 3.0 * np.pi / 2.0, rtol=0.05)
    assert (
        find_directions(pl.trace_photons(half, emitted=1 << 14, store="all", columns=["path_vertices"]))[:, 0] > -1e-5
    ).all()


def test_one_bright_texel_is_a_sun(tmp_path: Path) -> None:
    height, row, column, radiance = 256, 40, 300, 5e3
    sky = np.zeros((height, 2 * height, 3))
    sky[row, column] = radiance * np.array([1.0, 0.5, 0.25])
    by_image = light_floor(tmp_path, sky, add_optics)
    polar, azimuth = np.pi * (row + 0.5) / height, np.pi * ((column + 0.5) / height - 1.0)
    there = np.array([np.sin(polar) * np.cos(azimuth), np.cos(polar), np.sin(polar) * np.sin(azimuth)])
    irradiance = float(radiance * weigh_rows(height)[row])
    sun = load(tmp_path / "sun", add_optics)
    sun.add_light("directional", direction=-there, intensity=irradiance, color=(1.0, 0.5, 0.25))
    # Within half a texel's height, 0.35°, of one direction.
    tolerance = 0.01
    lit = [light_floor(tmp_path / "open", sky), load(tmp_path / "bare", lambda writer: None)]
    lit[1].add_light("directional", direction=-there, intensity=irradiance, color=(1.0, 0.5, 0.25))
    seen = [render_below(scene, 64) for scene in lit]
    np.testing.assert_allclose(seen[0], seen[1], rtol=tolerance)
    photons, truth = (pl.trace_photons(scene, emitted=PHOTONS) for scene in (by_image, sun))
    np.testing.assert_allclose(photons.total_flux, truth.total_flux, rtol=tolerance)
    # The mirror's light falls where the sun's does.
    middle = [(p.positions * p.power[:, :1]).sum(axis=0) / p.power[:, 0].sum() for p in (photons, truth)]
    np.testing.assert_allclose(middle[0], middle[1], atol=0.01)


def test_caustics_of_parts_of_the_sky_add_up(tmp_path: Path) -> None:
    random = np.random.default_rng(4)
    whole = random.uniform(0.0, 1.0, (16, 32, 3)) ** 4
    left = whole * (np.arange(32) < 11)[None, :, None]
    flux = [
        pl.trace_photons(light_floor(tmp_path / name, sky, add_optics), emitted=PHOTONS).total_flux
        for name, sky in (("whole", whole), ("left", left), ("right", whole - left))
    ]
    np.testing.assert_allclose(flux[1] + flux[2], flux[0], rtol=0.01)


def look(scene: pl.Scene, target: tuple[float, float, float], yfov: float = 0.02) -> Doubles:
    camera = pl.Camera(
        position=(0.0, 1.0, 0.0), target=tuple(np.array([0.0, 1.0, 0.0]) + target), yfov=yfov, up=(0.1, 1.0, 0.2)
    )
    return np.asarray(pl.render(scene, mode="direct", camera=camera, width=4, height=4), dtype=np.float64).mean(
        axis=(0, 1)
    )


def test_axes_are_those_that_are_documented(tmp_path: Path) -> None:
    height = 32
    sky = np.zeros((height, 2 * height, 3))
    v, u = np.meshgrid(np.arange(height), np.arange(2 * height), indexing="ij")
    sky[..., 0], sky[..., 1], sky[..., 2] = u + 1, v + 1, 1.0
    scene = light_floor(tmp_path / "a", sky)
    turned = light_floor(tmp_path / "b", sky, rotation=np.pi / 2.0)  # counter-clockwise from above: +x goes to -z
    for target, column, row in (
        ((1.0, 0.03, 0.03), height, height / 2 - 1),
        ((0.03, 0.03, 1.0), 1.5 * height - 1, height / 2 - 1),
        ((-1.0, 0.03, 0.03), 2 * height - 1, height / 2 - 1),
        ((0.03, 0.03, -1.0), 0.5 * height, height / 2 - 1),
        ((0.02, 1.0, 0.02), 1.25 * height - 0.5, 0),
    ):
        np.testing.assert_allclose(look(scene, target)[1:], [row + 1, 1.0], rtol=1e-5)
        if target[1] < 1.0:
            np.testing.assert_allclose(look(scene, target)[0], column + 1, rtol=1e-5)
            x, y, z = target
            np.testing.assert_allclose(look(turned, (z, y, -x)), look(scene, target), rtol=1e-5)
    assert turned.hash != scene.hash


def test_nothing_shows_before_a_white_sky(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("mirror", build_panel(0.4, 0.45, faces_up=True), make_mirror("mirror", (1.0, 1.0, 1.0)))
        add_optics(writer)

    path = write_scene(tmp_path, "furnace", change, lamp=False, floor=False)
    scene = pl.load_scene(path)
    scene.add_light("environment", image=write_sky(tmp_path, np.full((32, 64, 3), 2.0)))
    down = pl.Camera(position=(0.0, 2.0, 0.05), target=(0.0, 0.45, 0.0), yfov=0.1)
    at_mirror = np.asarray(pl.render(scene, mode="direct", camera=down, width=8, height=8))
    np.testing.assert_allclose(at_mirror, 2.0, rtol=1e-5)
    at_glass = pl.Camera(position=(0.9, 2.0, 0.6), target=(0.85, 0.3, 0.55), yfov=0.1)
    seen = np.asarray(pl.render(scene, mode="direct", camera=at_glass, width=8, height=8, samples=64))
    np.testing.assert_allclose(seen.mean(axis=(0, 1)), 2.0, rtol=0.02)


def test_glass_that_all_light_leaves_is_followed_to_an_end(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        writer.add_mesh("ball", build_ball(0.25, 1.0, 64), make_glass("glass", 1.5, 0.5))

    scene = pl.load_scene(write_scene(tmp_path, "alone", change, lamp=False, floor=False))
    scene.add_light("environment", intensity=2.0)
    camera = pl.Camera(position=(0.9, 1.0, 0.0), target=(0.0, 1.0, 0.0), yfov=0.6)
    pixels = np.asarray(pl.render(scene, mode="direct", camera=camera, width=32, height=32, samples=16))
    np.testing.assert_allclose(pixels, 2.0, rtol=0.02)


@pytest.mark.parametrize("height", [1, 512])
def test_direct_light_is_unbiased_and_calm(tmp_path: Path, height: int) -> None:
    # A disc of 5° that sends as much as the gray around it, seen in 16 samples.
    sun = np.array([0.5, 0.7, 0.51])
    sun /= np.linalg.norm(sun)
    sky = make_sky(
        height,
        lambda x, y, z: (1.0 + 300.0 * (np.stack([x, y, z], axis=2) @ sun > np.cos(0.09)))[..., None] * np.ones(3),
    )
    scene = light_floor(tmp_path, sky)
    camera = pl.Camera(position=(0.3, 0.2, 0.0), target=(0.0, 0.0, 0.0), yfov=0.02)
    pixels = np.asarray(pl.render(scene, mode="direct", camera=camera, width=32, height=32, samples=16))[..., 0]
    up = np.maximum(make_sky(height, lambda x, y, z: y[..., None] * np.ones(3))[..., 0], 0.0)
    truth = 0.5 / np.pi * (sky[..., 0] * up * weigh_rows(height)[:, None]).sum() if height > 1 else 0.5
    np.testing.assert_allclose(pixels.mean(), truth, rtol=0.01)
    assert pixels.std() / truth < 0.15


def test_starts_keep_their_places_before_what_is_far(tmp_path: Path) -> None:
    sky = np.full((4, 8, 3), 1.0)
    near, far = (light_floor(tmp_path / name, sky, add_optics) for name in ("near", "far"))
    far.add_light("area", position=(3e7, 2e7, 0.0), size=(100.0, 100.0), intensity=0.0)
    photons, truth = (pl.trace_photons(scene, emitted=1 << 18) for scene in (far, near))
    np.testing.assert_allclose(photons.total_flux, truth.total_flux, rtol=ENERGY_TOLERANCE)
    assert len(photons) == pytest.approx(len(truth), rel=1e-3)
    middles = [p.positions.astype(np.float64).mean(axis=0) for p in (photons, truth)]
    np.testing.assert_allclose(middles[0], middles[1], atol=1e-3)


def test_what_is_far_and_large_is_in_the_way(tmp_path: Path) -> None:
    above = np.concatenate([np.ones((2, 8, 3)), np.zeros((2, 8, 3))])
    open_sky, roofed = (light_floor(tmp_path / name, above, add_optics) for name in ("open", "roofed"))
    # Seen from the floor it covers all but a degree above the horizon.
    roofed.add_light("area", position=(0.0, 1e3, 0.0), size=(1.4e5, 1.4e5), intensity=0.0)
    covered, free = (pl.trace_photons(scene, emitted=1 << 18) for scene in (roofed, open_sky))
    assert covered.total_flux[0] < 0.05 * free.total_flux[0]


def test_maps_and_hashes_know_the_image(tmp_path: Path) -> None:
    path = write_scene(tmp_path, "bare", add_optics, lamp=False)
    sky = write_sky(tmp_path, make_sky(8, lambda x, y, z: (y + 1.0)[..., None] * np.ones(3)))
    scene, same, plain = (pl.load_scene(path) for _ in range(3))
    for each in (scene, same):
        each.add_light("environment", image=sky, rotation=0.5)
    plain.add_light("environment")
    assert scene.hash == same.hash != plain.hash
    assert scene.lights[0]["image"] == str(sky)
    assert "mean of an image" in scene.describe()
    photons = pl.trace_photons(scene, 5000)
    photons.save(tmp_path / "map.zarr")
    loaded = pl.load_photons(tmp_path / "map.zarr")
    np.testing.assert_array_equal(loaded.path_vertices, photons.path_vertices)  # traced again, under the same sky
    write_sky(tmp_path, np.full((8, 16, 3), 1.0))
    other = pl.load_scene(path)
    other.add_light("environment", image=sky, rotation=0.5)
    assert other.hash != scene.hash
    with pytest.raises(pl.SceneError, match=r"sky\.exr: the image has changed .* add it anew"):
        pl.load_scene(path).restore(scene.additions)
    sky.unlink()
    again = pl.load_photons(tmp_path / "map.zarr")
    with pytest.raises(pl.PhotonLoupeError, match=r"sky\.exr.*no such file"):
        _ = again.path_vertices


@pytest.mark.parametrize(
    ("pixels", "message"),
    [
        (np.ones((4, 4, 3)), "twice as wide as high"),
        (np.zeros((4, 8, 3)), "sends no light"),
        (np.full((4, 8, 3), np.nan), "column 4 of row 0 is NaN"),
        (np.full((4, 8, 3), np.inf), "is infinite"),
    ],
)
def test_images_that_are_no_sky_are_refused(tmp_path: Path, pixels: Doubles, message: str) -> None:
    scene = load(tmp_path, lambda writer: None)
    before = scene.hash
    with pytest.raises(pl.SceneError, match=message):
        scene.add_light("environment", image=write_sky(tmp_path, pixels))
    assert scene.hash == before
    assert not scene.lights


def test_wrong_environments_are_refused(tmp_path: Path) -> None:
    scene = load(tmp_path, lambda writer: None)
    sky = write_sky(tmp_path, np.full((2, 4, 3), 1.0))
    (tmp_path / "text.exr").write_text("no image")
    for told, message in (
        ({"image": tmp_path / "gone.exr"}, "no such file"),
        ({"image": tmp_path / "text.exr"}, "can't be read as EXR"),
        ({"image": 5}, "path of a file"),
        ({"image": sky, "rotation": 7.0}, "rotation"),
        ({"image": sky, "rotation": np.nan}, "rotation"),
        ({"image": sky, "intensity": 0.0}, "sends no light"),
    ):
        with pytest.raises(pl.PhotonLoupeError, match=message):
            scene.add_light("environment", **told)
    for name in ("", "a\0b"):
        with pytest.raises(pl.SceneError, match="/image: it names no file"):
            scene.restore([{"add": "light", "kind": "environment", "image": name}])
    with pytest.raises(pl.PhotonLoupeError, match="not a point light"):
        scene.add_light("point", image=sky)
    scene.add_light("environment", image=sky)
    with pytest.raises(pl.SceneError, match="has an environment that an image says"):
        scene.add_light("environment", image=sky)
    scene.add_light("environment", intensity=2.0)  # both together
    np.testing.assert_allclose(render_below(scene, 256), 3.0 * np.pi, rtol=0.01)


def test_negative_values_count_as_none_and_are_told(tmp_path: Path) -> None:
    sky = np.full((4, 8, 3), 1.0)
    sky[0, 0] = -5.0
    scene = light_floor(tmp_path, sky)
    assert any("3 negative values" in note for note in scene.report["notes"])


def test_command_line_and_studio_take_an_image(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from photonloupe.cli import main  # noqa: PLC0415

    path = write_scene(tmp_path, "bare", add_optics, lamp=False)
    sky = write_sky(tmp_path, make_sky(16, lambda x, y, z: (y + 1.0)[..., None] * np.ones(3)))
    picture = tmp_path / "bare.exr"
    size = ["--width", "32", "--height", "32", "--samples", "1", "--photons", "5000"]
    sent = ["--environment", str(sky), "--environment-intensity", "2", "--environment-rotation", "90"]
    assert main(["render", str(path), "-o", str(picture), *size, *sent]) == 0
    assert np.asarray(pl.load_image(picture)).max() > 0.0
    assert main(["trace", str(path), "-o", str(tmp_path / "m.zarr"), "--photons", "5000", *sent]) == 0
    assert main(["render", str(path), "-o", str(picture), *size[:6], "--map", str(tmp_path / "m.zarr")]) == 0
    capsys.readouterr()
    assert main(["render", str(path), "-o", str(picture), *size, "--environment", "gone.exr"]) == 2
    assert "no such file" in capsys.readouterr().err
    assert main(["render", str(path), "-o", str(picture), *size, "--environment-rotation", "90"]) == 2
    assert "name it with --environment" in capsys.readouterr().err
    scene = pl.load_scene(path)
    scene.add_light("environment", image=sky, rotation=0.5)
    with pl.Studio(scene=scene, offscreen=True, size=(1000, 700), photons=5000) as studio:
        studio.frame()
        assert len(studio.photons) >= 5000
        assert f'scene.add_light("environment", image="{sky}", rotation=0.5, intensity=1.0' in studio.python()
        state = json.loads(studio.state)
        positions = studio.photons.positions.copy()
    with pl.Studio(offscreen=True, size=(1000, 700)) as other:
        other.set_state(json.dumps(state))
        other.frame()
        np.testing.assert_array_equal(other.photons.positions, positions)
        program = other.python().split("camera =")[0]
    names: dict[str, Any] = {}
    exec(program, names)
    np.testing.assert_array_equal(names["photons"].positions, positions)
