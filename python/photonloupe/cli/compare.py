# SPDX-License-Identifier: Apache-2.0
"""``photonloupe compare``: how far two pictures are apart, and whether that is too far."""

from __future__ import annotations

import argparse

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from photonloupe.checks import check_number
from photonloupe.cli.common import EXIT_NO, EXIT_OK, print_result
from photonloupe.image import check_image_path, decode_srgb

SUMMARY = "measure how far two pictures are apart"
DESCRIPTION = "RMSE, relMSE and FLIP of A against the reference B; exit code 1 where a limit is passed."

# matplotlib's `magma` at nine even steps (CC0), sRGB: what FLIP's own pictures use.
_MAGMA = np.array(
    [
        (0.0015, 0.0005, 0.0139),
        (0.1117, 0.0653, 0.2769),
        (0.3166, 0.0717, 0.4855),
        (0.5128, 0.1482, 0.5076),
        (0.7164, 0.2150, 0.4753),
        (0.9043, 0.3196, 0.3881),
        (0.9865, 0.5356, 0.3822),
        (0.9969, 0.7696, 0.5349),
        (0.9871, 0.9914, 0.7495),
    ]
)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add the verb's options."""
    parser.add_argument("image", metavar="A", help=".exr or .png")
    parser.add_argument("reference", metavar="B", help="of the same kind and size")
    parser.add_argument("--max-rmse", type=float, metavar="X", help="exit 1 above it")
    parser.add_argument("--max-flip", type=float, metavar="X", help="exit 1 above it, 0 to 1")
    parser.add_argument("-o", "--output", metavar="FILE", help="difference picture: .png FLIP map, .exr A − B")


def _build_picture(difference: pl.ImageDifference) -> NDArray[np.float64]:
    steps = np.linspace(0.0, 1.0, len(_MAGMA))
    colors = [np.interp(difference.error_map, steps, _MAGMA[:, channel]) for channel in range(3)]
    return decode_srgb(np.stack(colors, axis=-1))


def run(arguments: argparse.Namespace) -> int:
    """Run the verb."""
    limits = {
        "rmse": arguments.max_rmse,
        "flip": arguments.max_flip,
    }
    for name, limit in limits.items():
        if limit is not None:
            check_number(f"--max-{name}", limit, 0.0, float(np.finfo(np.float32).max))
    output = check_image_path(arguments.output) if arguments.output else None
    image, reference = pl.load_image(arguments.image), pl.load_image(arguments.reference)
    difference = image.compare(reference)
    measured = {"rmse": difference.rmse, "relmse": difference.relmse, "flip": difference.flip}
    above = [name for name, limit in limits.items() if limit is not None and measured[name] > limit]
    if output is not None:
        signed = np.asarray(image, dtype=np.float64) - np.asarray(reference)
        pixels = signed if output.suffix.lower() == ".exr" else _build_picture(difference)
        pl.Image(pixels, provenance={"version": pl.__version__, "difference": measured}).save(output)
    kind = "HDR-FLIP" if image.linear else "FLIP"
    lines = [f"RMSE {difference.rmse:.6g}  relMSE {difference.relmse:.6g}  {kind} {difference.flip:.6g}"]
    lines += [f"{name} {measured[name]:.6g} is above the limit {limits[name]:g}" for name in above]
    print_result(arguments, {**measured, "above": above, "output": output}, lines)
    return EXIT_NO if above else EXIT_OK
