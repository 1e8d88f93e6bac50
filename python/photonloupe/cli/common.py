# SPDX-License-Identifier: Apache-2.0
"""What the verbs share: exit codes, common options, how results are printed."""

from __future__ import annotations

import argparse
import json
import logging
import math
import sys
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from photonloupe.errors import ArgumentError
from photonloupe.scene import Scene, load_scene

LOG = logging.getLogger("photonloupe")

_MOST_TOLD = 4  # features of a file that are left out

EXIT_OK = 0
EXIT_NO = 1
EXIT_BAD_INPUT = 2
EXIT_NO_DEVICE = 3
EXIT_NO_MEMORY = 4
EXIT_INTERNAL = 70  # EX_SOFTWARE of sysexits.h: a mistake of ours
EXIT_INTERRUPTED = 130  # 128 + SIGINT, as shells say it


@dataclass(frozen=True)
class Quality:
    """A point on the front of speed against accuracy."""

    photons: int
    samples: int
    k: int


# Sobol ring caustic, error at its best k: 194,000 photons k = 50, 775,000 photons k = 100 (METHODS section 7).
QUALITIES = {
    "draft": Quality(photons=50_000, samples=1, k=30),
    "balanced": Quality(photons=200_000, samples=4, k=50),
    "final": Quality(photons=1_000_000, samples=16, k=100),
}


def add_common_options(parser: argparse.ArgumentParser) -> None:
    """Add what every verb understands."""
    parser.add_argument("--json", action="store_true", help="print the result as JSON")
    parser.add_argument("--debug", action="store_true", help="on an error, show where in the program it arose")


def add_device_option(parser: argparse.ArgumentParser) -> None:
    """Add ``--device``."""
    parser.add_argument("--device", default="auto", metavar="D", help="index or part of a name; default: the best")


def add_scene_options(parser: argparse.ArgumentParser) -> None:
    """Add what a scene may lack."""
    parser.add_argument(
        "--light",
        action="append",
        default=[],
        metavar="LIGHT",
        help="add 'point X,Y,Z [W/sr]', 'spot X,Y,Z DX,DY,DZ [W/sr [INNER,OUTER degrees]]', "
        "'directional DX,DY,DZ [W/m²]', 'area X,Y,Z DX,DY,DZ W,H [W/(m² sr)]', "
        "'environment [W/(m² sr)]', or 'auto', one that suits the scene",
    )
    parser.add_argument(
        "--environment",
        metavar="FILE.exr",
        help="add light from all around, as an equirectangular image has it: +y above, +x in its middle, then +z",
    )
    parser.add_argument(
        "--environment-intensity", type=float, metavar="FACTOR", help="times the image; default 1, W/(m² sr)"
    )
    parser.add_argument(
        "--environment-rotation",
        type=float,
        metavar="DEGREES",
        help="turn the image about y, counter-clockwise seen from above; default 0",
    )
    parser.add_argument(
        "--time", type=float, metavar="SECONDS", help="pose things as the file's animation has them then"
    )
    parser.add_argument("--floor", action="store_true", help="add a diffuse floor below the scene")


def open_scene(arguments: argparse.Namespace, path: str) -> Scene:
    """Load a scene and add what was asked for."""
    scene = load_scene(path, time=arguments.time)
    for text in arguments.light:
        add_light(scene, text)
    _add_environment(scene, arguments)
    if arguments.floor:
        scene.add_floor()
    return scene


def _add_environment(scene: Scene, arguments: argparse.Namespace) -> None:
    told = {"intensity": arguments.environment_intensity, "rotation": arguments.environment_rotation}
    given = {name: value for name, value in told.items() if value is not None}
    if arguments.environment is not None:
        if "rotation" in given:
            given["rotation"] = math.radians(given["rotation"])
        scene.add_light("environment", image=arguments.environment, **given)
    elif given:
        raise ArgumentError(f"--environment-{min(given)} is about an image; name it with --environment FILE.exr")


def warn_ignored(scene: Scene) -> None:
    """Say once what of the file is not modeled; that plaster does not shine is not worth a warning."""
    ignored = [line for line in scene.report["ignored"] if "specular lobe" not in line]
    if ignored:
        more = f" and {len(ignored) - _MOST_TOLD} more" if len(ignored) > _MOST_TOLD else ""
        told = "; ".join(ignored[:_MOST_TOLD])
        LOG.warning(f"{scene.path}: {told}{more} (photonloupe doctor {scene.path} lists everything)")


# After its kind: what each further part of a light's text says.
_LIGHT_PARTS = {
    "point": ("position", "intensity"),
    "spot": ("position", "direction", "intensity", "cone"),
    "directional": ("direction", "intensity"),
    "area": ("position", "direction", "size", "intensity"),
    "environment": ("intensity",),
    "auto": (),
}


def add_light(scene: Scene, text: str) -> None:
    """Add the light that an option describes.

    Raises
    ------
    ArgumentError
        If it describes none.
    """
    kind, *parts = text.split()[:8] or [""]
    names = _LIGHT_PARTS.get(kind)
    if names is None or len(parts) > len(names):
        raise ArgumentError(f"--light {text!r} is no light; write for example --light 'point 0,2,0 10' or --light auto")
    told: dict[str, Any] = {}
    for name, part in zip(names, parts, strict=False):
        try:
            numbers = [float(number) for number in part.split(",")]
        except ValueError:
            raise ArgumentError(f"--light {text!r}: {part!r} is not numbers with commas between them") from None
        told[name] = numbers[0] if name == "intensity" and len(numbers) == 1 else numbers
    if "cone" in told:
        told["cone"] = [math.radians(angle) for angle in told["cone"]]
    scene.add_light(kind, **told)


def choose_progress() -> bool:
    """Return whether a bar helps: only where someone watches."""
    return sys.stderr.isatty()


def print_result(
    arguments: argparse.Namespace, result: Mapping[str, Any], lines: Sequence[str] | Callable[[], Sequence[str]]
) -> None:
    """Print `result` as JSON if asked, else `lines`."""
    if arguments.json:
        print(json.dumps(result, indent=1, sort_keys=True, default=_encode))
    else:
        print("\n".join(lines() if callable(lines) else lines))


def _encode(value: Any) -> Any:
    if hasattr(value, "tolist"):
        return value.tolist()
    return str(value)


class Stopwatch:
    """Seconds spent in named steps, in order."""

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}

    @contextmanager
    def measure(self, step: str) -> Iterator[None]:
        """Add the time of the enclosed block to `step`."""
        start = time.perf_counter()
        try:
            yield
        finally:
            self.seconds[step] = self.seconds.get(step, 0.0) + time.perf_counter() - start

    def format(self) -> str:
        """Name the steps with their seconds."""
        return ", ".join(f"{step} {seconds:.2f}" for step, seconds in self.seconds.items())


def format_table(rows: Sequence[Sequence[str]]) -> list[str]:
    """Line up columns of text; the first row is the heading."""
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in rows]
