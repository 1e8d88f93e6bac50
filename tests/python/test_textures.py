# SPDX-License-Identifier: Apache-2.0
"""Textures and vertex colors: where an image lies, what it does to light, and what is done about broken ones."""

from __future__ import annotations

import io
import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

import photonloupe as pl
from gltf import GltfWriter, Mesh, build_box, build_quad, make_diffuse, make_glass, make_mirror
from lit_scenes import Doubles, build_panel, make_lamp, render_below

Codes = NDArray[np.uint8]
RED, GREEN, BLUE, WHITE = (255, 0, 0), (0, 255, 0), (0, 0, 255), (255, 255, 255)


def encode(codes: Codes, form: str = "PNG") -> bytes:
    stream = io.BytesIO()
    Image.fromarray(codes).save(stream, form, **({"quality": 100, "subsampling": 0} if form == "JPEG" else {}))
    return stream.getvalue()


def decode_srgb(codes: Codes) -> Doubles:
    encoded = codes / 255.0
    return np.where(encoded <= 0.04045, encoded / 12.92, ((encoded + 0.055) / 1.055) ** 2.4)


# Of build_quad's corners, so that the image lies with its top towards -z and its left towards -x.
COORDINATES = np.array([[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]])


def add_painted_floor(
    writer: GltfWriter,
    image: bytes,
    *,
    coordinates: Doubles = COORDINATES,
    transform: dict[str, Any] | None = None,
    **sampler: int,
) -> None:
    material = make_diffuse("painted", 1.0)
    reference: dict[str, Any] = {"index": writer.add_texture(image, **sampler)}
    if transform:
        reference["extensions"] = {"KHR_texture_transform": transform}
    material["pbrMetallicRoughness"]["baseColorTexture"] = reference
    writer.add_mesh("floor", build_quad(1.0), material, coordinates=[coordinates])
    writer.add_directional_light("sun", (0.0, -1.0, 0.0), np.pi)


def write(folder: Path, change: Callable[[GltfWriter], Any]) -> Path:
    writer = GltfWriter("painted")
    change(writer)
    writer.write(folder)
    return folder / "painted.gltf"


def look_down(scene: pl.Scene, places: Doubles, **settings: Any) -> Doubles:
    """Radiance of the floor at (x, z), straight from above: its base color under light of π W/m²."""
    seen = []
    for x, z in places:
        camera = pl.Camera(position=(x, 1.0, z), target=(x, 0.0, z), up=(0.0, 0.0, -1.0), yfov=1e-4)
        image = pl.render(scene, mode="direct", camera=camera, width=2, height=2, samples=1, **settings)
        seen.append(np.asarray(image, dtype=np.float64).mean(axis=(0, 1)))
    return np.array(seen)


def sample_bilinearly(values: Doubles, u: float, v: float, wrap: Callable[[int, int], int]) -> Doubles:
    height, width = values.shape[:2]
    x, y = u * width - 0.5, v * height - 0.5
    column, row = int(np.floor(x)), int(np.floor(y))
    total = np.zeros(3)
    for dy, dx in ((0, 0), (0, 1), (1, 0), (1, 1)):
        weight = (1 - abs(x - column - dx)) * (1 - abs(y - row - dy))
        total += weight * values[wrap(row + dy, height), wrap(column + dx, width)]
    return total


WRAPS: dict[int, Callable[[int, int], int]] = {
    10497: lambda at, size: at % size,
    33071: lambda at, size: min(max(at, 0), size - 1),
    33648: lambda at, size: at % (2 * size) if at % (2 * size) < size else 2 * size - 1 - at % (2 * size),
}


@pytest.mark.parametrize("wrap", list(WRAPS))
@pytest.mark.parametrize("form", ["PNG", "JPEG", "WEBP"])
def test_an_image_lies_as_its_coordinates_say(tmp_path: Path, form: str, wrap: int) -> None:
    blocks = np.random.default_rng(1).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    codes = np.repeat(np.repeat(blocks, 8, axis=0), 8, axis=1)  # blocks of a JPEG, so that it loses next to nothing
    coordinates = COORDINATES * [3.1, 2.3] - [1.2, 0.7]
    image = encode(codes, form) if form != "WEBP" else encode_lossless(codes)

    def change(writer: GltfWriter) -> None:
        add_painted_floor(writer, image, coordinates=coordinates, wrapS=wrap, wrapT=wrap)

    places = np.random.default_rng(2).uniform(-0.95, 0.95, (24, 2))
    seen = look_down(pl.load_scene(write(tmp_path, change)), places)
    values = decode_srgb(np.asarray(Image.open(io.BytesIO(image)).convert("RGB")))
    uv = (places + 1.0) / 2.0 * [3.1, 2.3] - [1.2, 0.7]
    truth = np.array([sample_bilinearly(values, u, v, WRAPS[wrap]) for u, v in uv])
    np.testing.assert_allclose(seen, truth, atol=2e-3)
    assert np.ptp(truth) > 0.2


def encode_lossless(codes: Codes) -> bytes:
    stream = io.BytesIO()
    Image.fromarray(codes).save(stream, "WEBP", lossless=True)
    return stream.getvalue()


def test_nearest_samplers_keep_texels_apart(tmp_path: Path) -> None:
    codes = np.array([[RED, GREEN], [BLUE, WHITE]], dtype=np.uint8)
    scene = pl.load_scene(write(tmp_path, lambda writer: add_painted_floor(writer, encode(codes), magFilter=9728)))
    places = np.array([[-0.01, -0.01], [0.01, -0.01], [-0.01, 0.01], [0.01, 0.01]])
    np.testing.assert_allclose(look_down(scene, places), codes.reshape(4, 3) / 255.0, atol=1e-6)


def test_a_transform_turns_scales_and_moves_the_image(tmp_path: Path) -> None:
    codes = np.random.default_rng(3).integers(0, 256, (16, 16, 3), dtype=np.uint8)
    transform = {"offset": [0.3, 0.1], "rotation": 0.4, "scale": [0.5, 1.5]}
    image = encode(codes)
    scene = pl.load_scene(write(tmp_path, lambda writer: add_painted_floor(writer, image, transform=transform)))
    places = np.random.default_rng(4).uniform(-0.95, 0.95, (16, 2))
    u, v = (places[:, 0] + 1.0) / 4.0, (places[:, 1] + 1.0) * 0.75
    c, s = np.cos(0.4), np.sin(0.4)
    uv = np.stack([c * u + s * v + 0.3, -s * u + c * v + 0.1], axis=1)
    truth = [sample_bilinearly(decode_srgb(codes), *place, WRAPS[10497]) for place in uv]
    np.testing.assert_allclose(look_down(scene, places), truth, atol=2e-3)


def test_vertex_colors_and_factors_multiply(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        colors = np.array([[1.0, 0.5, 0.25, 1.0]] * 4)
        material = make_diffuse("painted", 0.5)
        texture = writer.add_texture(encode(np.full((2, 2, 3), (255, 255, 188), dtype=np.uint8)))
        material["pbrMetallicRoughness"]["baseColorTexture"] = {"index": texture}
        writer.add_mesh("floor", build_quad(1.0), material, coordinates=[COORDINATES], colors=colors)
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), np.pi)

    scene = pl.load_scene(write(tmp_path, change))
    truth = 0.5 * np.array([1.0, 0.5, 0.25]) * decode_srgb(np.array([255, 255, 188], dtype=np.uint8))
    np.testing.assert_allclose(look_down(scene, np.array([[0.3, 0.1]]))[0], truth, rtol=1e-5)
    assert {"textures", "vertex colors"} <= set(scene.report["requires"])


def test_photons_leave_a_painted_wall_with_its_mean_color(tmp_path: Path) -> None:
    """Energy: what is reflected is the mean of the texture over the surface."""
    codes = np.random.default_rng(6).integers(0, 256, (8, 8, 3), dtype=np.uint8)
    scene = pl.load_scene(write(tmp_path, lambda writer: add_painted_floor(writer, encode(codes))))
    flux = pl.trace_photons(scene, emitted=1 << 18, store="all").report["flux"]
    share = np.divide(flux["escaped"], flux["emitted"])
    np.testing.assert_allclose(share, decode_srgb(codes).mean(axis=(0, 1)), rtol=5e-3)


def test_metal_and_transmission_follow_their_textures(tmp_path: Path) -> None:
    """Half of the plate is metal, half of the pane clear: the shares of the paths say so."""
    shine = np.zeros((4, 4, 3), dtype=np.uint8)
    shine[:, :2, 2] = 255  # metal on the left, smooth everywhere
    clear = np.zeros((4, 4, 3), dtype=np.uint8)
    clear[:2, :, 0] = 255

    def change(writer: GltfWriter) -> None:
        metal = make_mirror("metal", (1.0, 1.0, 1.0), 1.0)
        texture = writer.add_texture(encode(shine), magFilter=9728)
        metal["pbrMetallicRoughness"]["metallicRoughnessTexture"] = {"index": texture}
        writer.add_mesh("plate", build_quad(1.0), metal, coordinates=[COORDINATES])
        pane = make_glass("pane", 1.5, 0.0)
        pane["extensions"]["KHR_materials_transmission"]["transmissionTexture"] = {
            "index": writer.add_texture(encode(clear), magFilter=9728)
        }
        pane["pbrMetallicRoughness"]["baseColorFactor"] = [0.0, 0.0, 0.0, 1.0]
        quad = build_quad(1.0)
        beside = Mesh(quad.positions + np.array([3.0, 0.0, 0.0]), quad.normals, quad.indices)
        writer.add_mesh("pane", beside, pane, coordinates=[COORDINATES])
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), 1.0)

    scene = pl.load_scene(write(tmp_path, change))
    photons = pl.trace_photons(scene, emitted=1 << 16, store="all", seed=2)
    plate = photons.select(photons.object == 0)
    assert len(plate) > 1000  # its diffuse half stores, its metal half does not
    assert (plate.positions[:, 0] > -0.01).all()
    pane = photons.select(photons.object == 1)
    assert len(pane) > 1000  # its black half stores, its clear half lets pass or reflects
    assert (pane.positions[:, 2] > -0.01).all()
    assert "roughness" in scene.report["left_out"]  # the texture says 0 everywhere


def test_masked_surfaces_let_light_through_where_they_are_not(tmp_path: Path) -> None:
    rgba = np.full((8, 8, 4), 255, dtype=np.uint8)
    rgba[:4, :, 3] = 100  # below the cutoff of a half: the side towards -z is not there

    def change(writer: GltfWriter) -> None:
        leaf = make_diffuse("leaf", 0.0)
        leaf["alphaMode"] = "MASK"
        leaf["pbrMetallicRoughness"]["baseColorTexture"] = {"index": writer.add_texture(encode(rgba), magFilter=9728)}
        writer.add_mesh("leaf", build_quad(1.0, 1.0), leaf, coordinates=[COORDINATES])
        writer.add_mesh("floor", build_quad(1.0), make_diffuse("floor", 1.0))
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), np.pi)

    scene = pl.load_scene(write(tmp_path, change))
    assert "alpha" in scene.report["requires"]
    photons = pl.trace_photons(scene, emitted=1 << 14, store="all", max_bounces=1)
    below = photons.positions[photons.object == 1]
    assert (below[:, 2] <= 1e-3).all()
    np.testing.assert_allclose(len(below) / (1 << 14), 0.5, atol=2e-3)
    camera = pl.Camera(position=(0.3, 0.5, -0.4), target=(0.3, 0.0, -0.4), up=(0.0, 0.0, -1.0), yfov=1e-3)
    image = np.asarray(pl.render(scene, mode="direct", camera=camera, width=2, height=2, samples=1))
    np.testing.assert_allclose(image, 1.0, rtol=1e-5)  # the shadow ray passes the hole


@pytest.mark.parametrize("alpha", [0.25, 0.7])
def test_blended_surfaces_stop_their_share_of_light(tmp_path: Path, alpha: float) -> None:
    def change(writer: GltfWriter) -> None:
        veil = make_diffuse("veil", 0.0)
        veil["alphaMode"] = "BLEND"
        veil["pbrMetallicRoughness"]["baseColorFactor"] = [0.0, 0.0, 0.0, alpha]
        for height in (1.0, 1.5):
            writer.add_mesh("veil", build_quad(1.0, height), veil)
        writer.add_mesh("floor", build_quad(1.0), make_diffuse("floor", 1.0))
        writer.add_directional_light("sun", (0.0, -1.0, 0.0), np.pi)

    scene = pl.load_scene(write(tmp_path, change))
    photons = pl.trace_photons(scene, emitted=1 << 18, store="all", max_bounces=1)
    share = (1.0 - alpha) ** 2
    reached = float((photons.object == 2).sum()) / (1 << 18)
    assert abs(reached - share) < 4.0 * np.sqrt(share * (1 - share) / (1 << 18))
    camera = pl.Camera(position=(0.1, 0.5, 0.1), target=(0.1, 0.0, 0.1), up=(0.0, 0.0, -1.0), yfov=1e-3)
    image = np.asarray(pl.render(scene, mode="direct", camera=camera, width=2, height=2, samples=1))
    np.testing.assert_allclose(image, share, rtol=1e-5)


def test_a_normal_texture_turns_the_mirror(tmp_path: Path) -> None:
    """Tilted towards the image's right (+u, here +x) and up (-v, here -z), light is thrown there."""
    tilt = np.array([0.2, 0.3, np.sqrt(1.0 - 0.13)])
    codes = np.broadcast_to(np.round((tilt + 1.0) * 127.5).astype(np.uint8), (4, 4, 3))

    def change(writer: GltfWriter) -> None:
        mirror = make_mirror("mirror", (1.0, 1.0, 1.0))
        mirror["normalTexture"] = {"index": writer.add_texture(encode(np.ascontiguousarray(codes)))}
        writer.add_mesh("mirror", build_quad(0.01), mirror, coordinates=[COORDINATES])
        ceiling = build_quad(50.0, 10.0)
        writer.add_mesh(
            "ceiling", Mesh(ceiling.positions, -ceiling.normals, ceiling.indices[:, ::-1]), make_diffuse("c", 0.0)
        )
        writer.add_spot_light("spot", (0.0, 5.0, 0.0), (0.0, 0.0, 0.0), 1.0, 1e-3, 1e-3)

    photons = pl.trace_photons(pl.load_scene(write(tmp_path, change)), emitted=1 << 12)
    normal = 2.0 * codes[0, 0] / 255.0 - 1.0
    normal = np.array([normal[0], normal[2], -normal[1]]) / np.linalg.norm(normal)
    leaving = 2.0 * normal[1] * normal - [0.0, 1.0, 0.0]
    expected = leaving / leaving[1] * 10.0
    np.testing.assert_allclose(photons.positions.mean(axis=0), expected, atol=0.05)


def test_textures_nothing_asks_for_cost_nothing(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        add_painted_floor(writer, encode(np.full((4, 4, 3), 128, dtype=np.uint8)))
        del writer.materials[0]["pbrMetallicRoughness"]["baseColorTexture"]
        writer.materials[0]["occlusionTexture"] = {"index": 0}

    scene = pl.load_scene(write(tmp_path, change))
    assert {"textures", "vertex colors", "alpha"} <= set(scene.report["left_out"])
    assert any("occlusion" in line for line in scene.report["ignored"])


@pytest.mark.parametrize(
    ("image", "reason"),
    [
        (b"\x89PNG\r\n\x1a\nbroken", "no readable PNG"),
        (b"\xff\xd8\xff\xe0 nothing", "no readable JPEG"),
        (b"RIFF\x10\0\0\0WEBPVP8 ....", "WebP"),
        (b"GIF89a....", "neither PNG, JPEG nor WebP"),
        (b"\xabKTX 20\xbb....", "KTX 2"),
        (encode(np.zeros((4, 4, 3), dtype=np.uint8))[:-30], "no readable PNG|too early"),
    ],
)
def test_broken_images_leave_the_factors(tmp_path: Path, image: bytes, reason: str) -> None:
    scene = pl.load_scene(write(tmp_path, lambda writer: add_painted_floor(writer, image)))
    lines = [line for line in scene.report["ignored"] if "image" in line]
    assert len(lines) == 1
    assert any(part in lines[0] for part in reason.split("|")), lines
    assert "keep their factors" in lines[0]
    np.testing.assert_allclose(look_down(scene, np.array([[0.1, 0.2]])), 1.0, rtol=1e-5)


def test_missing_and_forbidden_image_files_are_named(tmp_path: Path) -> None:
    path = write(tmp_path, lambda writer: add_painted_floor(writer, encode(np.zeros((2, 2, 3), dtype=np.uint8))))
    document = json.loads(path.read_text())
    for uri, reason in (("missing.png", "missing.png"), ("../outside.png", "leads out")):
        document["images"] = [{"uri": uri}]
        path.write_text(json.dumps(document))
        assert any(reason in line for line in pl.load_scene(path).report["ignored"])
    (tmp_path / "there.png").write_bytes(encode(np.zeros((2, 2, 3), dtype=np.uint8)))
    document["images"] = [{"uri": "there.png"}]
    path.write_text(json.dumps(document))
    black = pl.load_scene(path)
    np.testing.assert_allclose(look_down(black, np.array([[0.1, 0.2]])), 0.0, atol=1e-6)
    (tmp_path / "there.png").write_bytes(encode(np.full((2, 2, 3), 255, dtype=np.uint8)))
    assert pl.load_scene(path).hash != black.hash


def test_additions_keep_painted_scenes_whole(tmp_path: Path) -> None:
    codes = np.array([[RED, GREEN], [BLUE, WHITE]], dtype=np.uint8)
    scene = pl.load_scene(write(tmp_path, lambda writer: add_painted_floor(writer, encode(codes), magFilter=9728)))
    scene.add_floor(y=-1.0)
    np.testing.assert_allclose(look_down(scene, np.array([[0.5, -0.5]]))[0], [0.0, 1.0, 0.0], atol=1e-6)


def test_a_textured_lamp_sends_what_its_texture_shows(tmp_path: Path) -> None:
    """One bright quarter: its power, where photons start, and the light that arrives below it."""
    codes = np.zeros((64, 64, 3), dtype=np.uint8)
    codes[:32, :32] = (255, 188, 128)
    half, radiance = 0.25, 8.0

    def change(writer: GltfWriter) -> None:
        lamp = make_lamp(radiance)
        lamp["emissiveTexture"] = {"index": writer.add_texture(encode(codes), magFilter=9728)}
        writer.add_mesh("floor", build_quad(2.0), make_diffuse("plaster", 0.5))
        writer.add_mesh("lamp", build_panel(half, 1.0), lamp, coordinates=[COORDINATES])

    scene = pl.load_scene(write(tmp_path, change))
    color = radiance * np.array([1.0, 0.5, 0.25]) * decode_srgb(codes[0, 0])
    photons = pl.trace_photons(scene, emitted=1 << 16, store="all", max_bounces=1)
    np.testing.assert_allclose(photons.report["flux"]["emitted"], np.pi * color * half**2, rtol=1e-4)
    starts = photons.path_vertices[photons.path_offsets[:-1]]
    assert (starts[:, 0] < 1e-6).all()
    assert (starts[:, 2] < 1e-6).all()
    np.testing.assert_allclose(starts[:, [0, 2]].mean(axis=0), -half / 2, atol=5e-3)
    # Radiance times the quarter's projected solid angle at the floor's middle, and the same from a picture.
    middles = half * ((np.arange(64) + 0.5) / 64.0 - 1.0)
    squared = 1.0 + middles[:, None] ** 2 + middles[None, :] ** 2
    truth = color * (1.0 / squared**2).mean() * half**2
    np.testing.assert_allclose(render_below(scene, samples=1024), truth, rtol=5e-3)
    seen = pl.render(
        scene,
        mode="direct",
        camera=pl.Camera(position=(-0.1, 0.5, -0.1), target=(-0.1, 1.0, -0.1), up=(0.0, 0.0, -1.0), yfov=1e-3),
        width=2,
        height=2,
        samples=1,
    )
    np.testing.assert_allclose(np.asarray(seen).mean(axis=(0, 1)), color, rtol=1e-5)


def tilt_codes(tilt: Doubles) -> Codes:
    return np.ascontiguousarray(np.broadcast_to(np.round((tilt + 1.0) * 127.5).astype(np.uint8), (4, 4, 3)))


def add_tilted_floor(writer: GltfWriter, angle: float) -> None:
    floor = make_diffuse("floor", 1.0)
    tilt = np.array([np.sin(angle), 0.0, np.cos(angle)])
    floor["normalTexture"] = {"index": writer.add_texture(encode(tilt_codes(tilt)))}
    writer.add_mesh("floor", build_quad(1.0), floor, coordinates=[COORDINATES])
    writer.add_directional_light("sun", (0.0, -1.0, 0.0), np.pi)


@pytest.mark.parametrize("angle", [0.0, 0.3, 0.7])
def test_a_normal_texture_leaves_photons_and_their_density_alone(tmp_path: Path, angle: float) -> None:
    """Light goes about the turned normal, is stored on the surface as it is, and never leaks through it."""
    scene = pl.load_scene(write(tmp_path, lambda writer: add_tilted_floor(writer, angle)))
    photons = pl.trace_photons(scene, emitted=1 << 16, store="all", seed=1)
    np.testing.assert_allclose(photons.irradiance([[0.1, 0.0, 0.2]], [0, 1, 0], k=200)[0], np.pi, rtol=0.1)
    np.testing.assert_allclose(photons.normals[0], [0.0, 1.0, 0.0], atol=1e-6)
    seen = look_down(scene, np.array([[0.3, 0.1]]))[0]
    np.testing.assert_allclose(seen, np.cos(angle), atol=0.02)  # direct light sees the turned normal


def test_light_does_not_leak_through_a_turned_normal(tmp_path: Path) -> None:
    def change(writer: GltfWriter) -> None:
        add_tilted_floor(writer, 1.0)
        writer.add_mesh("below", build_quad(5.0, -0.5), make_diffuse("below", 0.0))

    photons = pl.trace_photons(pl.load_scene(write(tmp_path, change)), emitted=1 << 14, store="all", max_bounces=2)
    below = photons.positions[photons.object == 1]
    assert (np.abs(below[:, [0, 2]]).max(axis=1) > 1.0 - 1e-3).all()


@pytest.mark.parametrize("first", [0, 1, 2])
def test_normal_textures_do_not_depend_on_the_order_of_corners(tmp_path: Path, first: int) -> None:
    """A long plate, ten to one, tilted 20 degrees along u."""
    angle = np.radians(20.0)
    codes = tilt_codes(np.array([np.sin(angle), 0.0, np.cos(angle)]))

    def change(writer: GltfWriter) -> None:
        mirror = make_mirror("mirror", (1.0, 1.0, 1.0))
        mirror["normalTexture"] = {"index": writer.add_texture(encode(codes))}
        quad = build_quad(0.01)
        plate = Mesh(quad.positions * [1.0, 1.0, 10.0], quad.normals, np.roll(quad.indices, first, axis=1))
        writer.add_mesh("mirror", plate, mirror, coordinates=[COORDINATES])
        ceiling = build_quad(50.0, 10.0)
        down = Mesh(ceiling.positions, -ceiling.normals, ceiling.indices[:, ::-1])
        writer.add_mesh("ceiling", down, make_diffuse("c", 0.0))
        writer.add_spot_light("spot", (0.0, 5.0, 0.0), (0.0, 0.0, 0.0), 1.0, 1e-3, 1e-3)

    photons = pl.trace_photons(pl.load_scene(write(tmp_path, change)), emitted=1 << 12)
    np.testing.assert_allclose(photons.positions.mean(axis=0), [10.0 * np.tan(2.0 * angle), 10.0, 0.0], atol=0.1)


def test_coordinates_far_away_read_as_zero(tmp_path: Path) -> None:
    codes = np.full((4, 4, 3), 255, dtype=np.uint8)
    transform = {"scale": [1e6, 1e6], "offset": [1e6, -1e6]}
    image = encode(codes)

    def change(writer: GltfWriter) -> None:
        add_painted_floor(writer, image, coordinates=COORDINATES * 1e35, transform=transform)

    scene = pl.load_scene(write(tmp_path, change))
    assert any("read as 0" in line or "reads as 0" in line for line in scene.report["notes"])
    np.testing.assert_allclose(look_down(scene, np.array([[0.3, 0.1]])), 1.0, rtol=1e-5)


@pytest.mark.parametrize("mode", ["BLEND", "MASK"])
def test_a_lamp_that_is_there_in_part_sends_its_part(tmp_path: Path, mode: str) -> None:
    rgba = np.full((16, 16, 4), 255, dtype=np.uint8)
    rgba[:, :8, 3] = 0

    def change(writer: GltfWriter) -> None:
        lamp = make_lamp(8.0)
        lamp["alphaMode"] = mode
        lamp["pbrMetallicRoughness"]["baseColorTexture"] = {"index": writer.add_texture(encode(rgba), magFilter=9728)}
        writer.add_mesh("lamp", build_panel(0.25, 1.0), lamp, coordinates=[COORDINATES])
        writer.add_mesh("floor", build_quad(1.0), make_diffuse("floor", 0.5))

    scene = pl.load_scene(write(tmp_path, change))
    emitted = pl.trace_photons(scene, emitted=1 << 12, store="all").report["flux"]["emitted"]
    np.testing.assert_allclose(emitted, 0.5 * np.pi * 8.0 * np.array([1.0, 0.5, 0.25]) * 0.25, rtol=1e-3)


@pytest.mark.parametrize(
    "extension",
    [{"KHR_materials_specular": {}}, {"KHR_materials_clearcoat": {"clearcoatFactor": 1.0}}],
)
def test_a_gloss_makes_caustics(tmp_path: Path, extension: dict[str, Any]) -> None:
    def change(writer: GltfWriter) -> None:
        plate = make_diffuse("plate", 0.5)
        plate["pbrMetallicRoughness"]["roughnessFactor"] = 0.1
        plate["extensions"] = extension
        writer.add_mesh("plate", build_quad(1.0), plate)
        writer.add_mesh("ceiling", build_quad(3.0, 3.0), make_diffuse("ceiling", 0.5))
        writer.add_point_light("lamp", (0.0, 1.0, 0.0), 1.0)

    photons = pl.trace_photons(pl.load_scene(write(tmp_path, change)), 2000)
    assert (photons.object == 1).any()


def test_light_from_all_around_stays_out_of_closed_rooms(tmp_path: Path) -> None:
    """Also where something that is not there stands within, and far things make light start late."""

    def change(writer: GltfWriter) -> None:
        writer.add_mesh("mirror", build_quad(0.3), make_mirror("mirror", (1.0, 1.0, 1.0)))
        ghost = make_diffuse("ghost", 0.5)
        ghost["alphaMode"] = "MASK"
        ghost["pbrMetallicRoughness"]["baseColorFactor"][3] = 0.1
        writer.add_mesh("ghost", build_box((-1.5, -1.5, -1.5), (1.5, 1.5, 1.5)), ghost)
        writer.add_mesh("room", build_box((-2.0, -2.0, -2.0), (2.0, 2.0, 2.0)), make_diffuse("room", 0.5))
        writer.add_mesh("far", build_box((9e3, 0.0, 0.0), (9.001e3, 1.0, 1.0)), make_diffuse("far", 0.5))

    scene = pl.load_scene(write(tmp_path, change))
    scene.add_light("environment", intensity=1.0)
    assert len(pl.trace_photons(scene, emitted=1 << 12, store="caustic")) == 0


def test_a_gloss_takes_no_light_from_what_glass_reflects(tmp_path: Path) -> None:
    """A white wall in a slab's front face; behind it a black wall, which a gloss can only brighten."""

    def look(name: str, *, is_glossy: bool) -> float:
        def change(writer: GltfWriter) -> None:
            writer.add_mesh("slab", build_box((-5.0, -0.2, -5.0), (5.0, 0.0, 5.0)), make_glass("slab", 1.5, 0.2))
            black = make_diffuse("black", 0.0)
            if is_glossy:
                black["extensions"] = {"KHR_materials_specular": {}}
            writer.add_mesh("below", build_quad(9.0, -1.0), black)
            ceiling = build_quad(30.0, 4.0)
            down = Mesh(ceiling.positions, -ceiling.normals, ceiling.indices[:, ::-1])
            writer.add_mesh("ceiling", down, make_diffuse("white", 1.0))
            writer.add_point_light("lamp", (15.0, 2.0, 0.0), 10.0)

        scene = pl.load_scene(write(tmp_path / name, change))
        camera = pl.Camera(position=(-3.0, 0.8, 0.0), target=(0.0, 0.0, 0.0), yfov=0.02)
        image = pl.render(scene, mode="direct", camera=camera, width=16, height=16, samples=64)
        return float(np.asarray(image, dtype=np.float64).mean())

    assert look("glossy", is_glossy=True) > 0.98 * look("plain", is_glossy=False)
