# SPDX-License-Identifier: Apache-2.0
"""Pictures: rendering them, saving with their provenance, measuring how far they are apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from PIL import Image as PillowImage

import photonloupe as pl

SIDE = 48


def make_picture(seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).random((24, 32, 3)).astype(np.float32)


def test_exr_survives_bit_for_bit(tmp_path: Path) -> None:
    pixels = make_picture() * np.float32(1e4)
    pl.Image(pixels).save(tmp_path / "a.exr")
    np.testing.assert_array_equal(np.asarray(pl.load_image(tmp_path / "a.exr")), pixels)


@pytest.mark.parametrize("suffix", [".exr", ".png"])
def test_provenance_survives(suffix: str, tmp_path: Path) -> None:
    provenance = {"version": "1", "settings": {"seed": 3, "mode": "caustic"}, "device": "é"}
    pl.Image(make_picture(), provenance=provenance).save(tmp_path / f"a{suffix}")
    assert pl.load_image(tmp_path / f"a{suffix}").provenance == provenance


@pytest.mark.parametrize("exposure", [-2.0, 0.0, 1.5])
def test_png_is_clipped_and_srgb_coded(exposure: float, tmp_path: Path) -> None:
    pixels = make_picture()
    pl.Image(pixels).save(tmp_path / "a.png", exposure=exposure)
    linear = np.clip(pixels.astype(np.float64) * 2.0**exposure, 0.0, 1.0)
    coded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    stored = np.asarray(PillowImage.open(tmp_path / "a.png").convert("RGB"), dtype=np.float64)
    assert np.abs(stored - 255.0 * coded).max() <= 0.51


def test_picture_shows_in_notebooks() -> None:
    assert pl.Image(make_picture())._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", ["a.jpg", "a", "none/a.exr"])
def test_impossible_name_is_refused(name: str, tmp_path: Path) -> None:
    with pytest.raises(pl.PhotonLoupeError):
        pl.Image(make_picture()).save(tmp_path / name)


@pytest.mark.parametrize("suffix", [".exr", ".png"])
@pytest.mark.parametrize("content", [b"", b"not a picture", b"\x76\x2f\x31\x01\x02\x00\x00\x00", b"\x89PNG\r\n\x1a\n"])
def test_damaged_file_is_refused(suffix: str, content: bytes, tmp_path: Path) -> None:
    (tmp_path / f"a{suffix}").write_bytes(content)
    with pytest.raises(pl.PhotonLoupeError):
        pl.load_image(tmp_path / f"a{suffix}")


def test_missing_file_is_named(tmp_path: Path) -> None:
    with pytest.raises(pl.FileFormatError, match=r"none\.exr"):
        pl.load_image(tmp_path / "none.exr")


def test_rmse_has_its_definition() -> None:
    a, b = make_picture(1), make_picture(2)
    difference = a.astype(np.float64) - b
    assert pl.compare_images(a, b).rmse == pytest.approx(np.sqrt(np.mean(difference**2)))


def test_relmse_has_its_definition() -> None:
    a, b = make_picture(1).astype(np.float64), make_picture(2).astype(np.float64)
    truth = np.mean((a - b) ** 2 / (b**2 + 0.01 * b.mean() ** 2))
    assert pl.compare_images(a, b).relmse == pytest.approx(truth)


def test_picture_does_not_differ_from_itself() -> None:
    difference = pl.compare_images(make_picture(), make_picture())
    assert (difference.rmse, difference.relmse, difference.flip) == (0.0, 0.0, 0.0)


def test_flip_sees_a_change() -> None:
    assert pl.compare_images(make_picture() * 1.5, make_picture()).flip > 0.05


@pytest.mark.parametrize("scale", [0.0, 1e-20, 1e20])
def test_flip_survives_extreme_references(scale: float) -> None:
    reference = make_picture() * np.float32(scale)
    assert np.isfinite(pl.compare_images(make_picture(), reference).flip)


def test_flip_does_not_depend_on_the_unit() -> None:
    a, b = make_picture(1).astype(np.float64), make_picture(2).astype(np.float64)
    assert pl.compare_images(a * 1e8, b * 1e8).flip == pytest.approx(pl.compare_images(a, b).flip, abs=1e-3)


def test_pixel_that_is_not_finite_is_named() -> None:
    bad = make_picture().copy()
    bad[3, 5, 1] = np.nan
    with pytest.raises(pl.ArgumentError, match="row 3, column 5"):
        pl.compare_images(bad, make_picture())


def test_pixel_beyond_32_bits_is_named() -> None:
    bright = make_picture().astype(np.float64)
    bright[2, 1, 0] = 1e39
    with pytest.raises(pl.ArgumentError, match="row 2, column 1"):
        pl.compare_images(make_picture(), bright)


def test_sizes_must_agree() -> None:
    with pytest.raises(pl.ArgumentError, match="size"):
        pl.compare_images(make_picture(), make_picture()[:-1])


def test_linear_and_coded_pictures_do_not_compare(tmp_path: Path) -> None:
    image = pl.Image(make_picture())
    image.save(tmp_path / "a.png")
    with pytest.raises(pl.ArgumentError, match="8-bit"):
        image.compare(pl.load_image(tmp_path / "a.png"))


@pytest.mark.parametrize("mode", ["composite", "caustic", "direct", "photons"])
def test_every_mode_renders_light(mode: str, ring: pl.Scene, ring_map: pl.PhotonMap) -> None:
    pixels = np.asarray(pl.render(ring, ring_map, camera="top", width=SIDE, height=SIDE, samples=1, mode=mode))
    assert pixels.shape == (SIDE, SIDE, 3)
    assert np.isfinite(pixels).all()
    assert pixels.max() > 0.0


def test_same_settings_render_the_same_bits(ring: pl.Scene, ring_map: pl.PhotonMap) -> None:
    first, second = (
        np.asarray(pl.render(ring, ring_map, camera="view", width=SIDE, height=SIDE, samples=2)) for _ in range(2)
    )
    assert first.tobytes() == second.tobytes()


def test_caustic_picture_is_irradiance_times_reflectance(ring: pl.Scene, ring_map: pl.PhotonMap) -> None:
    # A smooth patch before the near wall, lit by its outer face from z = 1 to 1.45 m.
    image = np.asarray(pl.render(ring, ring_map, camera="top", width=64, height=64, samples=16, mode="caustic", k=50))
    cell = 4.0 / 64
    rows, columns = np.arange(50, 54), np.arange(28, 36)
    x, z = -2.0 + (columns + 0.5) * cell, -2.0 + (rows + 0.5) * cell
    points = np.stack(np.meshgrid(x, [0.0], z), axis=-1).reshape(-1, 3)
    irradiance = ring_map.irradiance(points, (0.0, 1.0, 0.0), k=50).mean(axis=0)
    radiance = image[50:54, 28:36].reshape(-1, 3).mean(axis=0)
    np.testing.assert_allclose(radiance, 0.7 / np.pi * irradiance, rtol=0.03)


def test_aspect_may_differ(ring: pl.Scene, ring_map: pl.PhotonMap) -> None:
    image = pl.render(ring, ring_map, camera="view", width=40, height=20, samples=1)
    assert (image.width, image.height) == (40, 20)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"camera": "side"}, "top, view, close"),
        ({"width": 0}, "width"),
        ({"samples": 0}, "samples"),
        ({"mode": "pretty"}, "mode"),
        ({"k": 1001}, "k must"),
    ],
)
def test_wrong_setting_is_refused_by_name(ring: pl.Scene, ring_map: pl.PhotonMap, settings: dict, message: str) -> None:
    with pytest.raises(pl.ArgumentError, match=message):
        pl.render(ring, ring_map, **settings)


def test_look_ends_after_its_bounces(ring: pl.Scene) -> None:
    """The ring is a mirror: without a bounce nothing is seen in it, and the floor as before."""
    none, some = (
        np.asarray(pl.render(ring, camera="view", mode="direct", width=SIDE, height=SIDE, max_bounces=count))
        for count in (0, 16)
    )
    differs = (none != some).any(axis=2)
    assert 0.05 < differs.mean() < 0.5
    assert (none[differs] <= some[differs]).all()


def test_composite_needs_photons(ring: pl.Scene) -> None:
    with pytest.raises(pl.ArgumentError, match="trace_photons"):
        pl.render(ring)


def test_direct_needs_none(ring: pl.Scene) -> None:
    assert np.asarray(pl.render(ring, mode="direct", width=SIDE, height=SIDE, samples=1)).max() > 0.0


def test_picture_names_what_made_it(ring: pl.Scene, ring_map: pl.PhotonMap) -> None:
    image = pl.render(ring, ring_map, width=8, height=8, samples=1)
    assert {"version", "device", "driver", "scene_hash", "settings", "photons"} <= set(image.provenance)
