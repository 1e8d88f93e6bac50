# SPDX-License-Identifier: Apache-2.0
"""Compares the flux that lands on receivers with Mitsuba's, light by light and material by material."""

from __future__ import annotations

import argparse
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from energy_scenes import EnergyCase, add_receivers, list_cases
from find_llvm import find_llvm
from numpy.typing import NDArray

import photonloupe as pl
from gltf import GltfWriter

PAGE = Path(__file__).resolve().parents[2] / "docs" / "energy.md"
PASSES = 4
COUNT = 1 << 21  # photons emitted in a pass, on either side
LIMIT = 0.002  # largest difference, of Mitsuba's flux
LONGEST_PATH = 64

Fluxes = dict[str, NDArray[np.float64]]


@dataclass(frozen=True)
class EnergyRow:
    """One receiver of one case: means over the passes and their standard errors, W."""

    name: str
    peer: float
    peer_error: float
    ours: float
    our_error: float

    @property
    def difference(self) -> float:
        """Ours over the peer's, less 1."""
        return self.ours / self.peer - 1.0

    @property
    def error(self) -> float:
        """Standard error of the difference."""
        return float(np.hypot(self.peer_error, self.our_error)) / self.peer

    @property
    def agrees(self) -> bool:
        """Whether the difference is small enough, or no larger than chance makes it."""
        return abs(self.difference) <= max(LIMIT, 4.0 * self.error)


def measure_ours(path: Path, case: EnergyCase, image: Path | None) -> Fluxes:
    """Flux of the middle channel on the receivers, pass by pass."""
    scene = pl.load_scene(path)
    if case.environment:
        scene.add_light("environment", intensity=case.environment, **({"image": image} if image else {}))
    names = [each["name"] for each in scene.objects]
    fluxes: dict[str, list[float]] = {name: [] for name in case.receivers}
    for seed in range(PASSES):
        photons = pl.trace_photons(
            scene, emitted=COUNT, store="all", seed=seed, max_bounces=LONGEST_PATH, columns=["object"]
        )
        for name in case.receivers:
            fluxes[name].append(float(photons.power[photons.object == names.index(name), 1].sum(dtype=np.float64)))
    return {name: np.array(values) for name, values in fluxes.items()}


def write_sky(folder: Path) -> Path:
    """A smooth sky that tells all sides apart: Mitsuba interpolates between texels, ours are constant."""
    import mitsuba as mi  # noqa: PLC0415 - an optional peer

    u, v = np.meshgrid((np.arange(512) + 0.5) / 512, (np.arange(256) + 0.5) / 256)
    sky = 1.0 + 0.6 * np.sin(2.0 * np.pi * u) + 0.3 * np.cos(4.0 * np.pi * u + 1.0) + np.cos(np.pi * v)
    path = folder / "sky.exr"
    mi.Bitmap(np.repeat(sky[..., None] + 1.0, 3, axis=2).astype(np.float32)).write(str(path))
    return path


def compare_case(case: EnergyCase) -> list[EnergyRow]:
    """Both programs on the same file."""
    from peer_energy import make_environment, measure_flux  # noqa: PLC0415 - an optional peer

    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        writer = GltfWriter("case")
        case.build(writer)
        add_receivers(writer, case.receivers)
        writer.write(folder)
        path, image = folder / "case.gltf", write_sky(folder) if case.has_image else None
        sky: dict[str, Any] | None = make_environment(case.environment, image) if case.environment else None
        ours = measure_ours(path, case, image)
        peer = measure_flux(path, list(case.receivers), PASSES, COUNT, sky)
    return [
        EnergyRow(f"{case.name}; on the {name}", *summarize(peer[name]), *summarize(ours[name]))
        for name in case.receivers
    ]


def summarize(values: NDArray[np.float64]) -> tuple[float, float]:
    """Mean and its standard error."""
    return float(values.mean()), float(values.std(ddof=1) / np.sqrt(len(values)))


def format_row(row: EnergyRow) -> str:
    """A line of the table."""
    verdict = "yes" if row.agrees else "**no**"
    figures = f"{row.peer:.5f} ± {row.peer_error:.5f} | {row.ours:.5f} ± {row.our_error:.5f}"
    return f"| {row.name} | {figures} | {row.difference:+.3%} ± {row.error:.3%} | {verdict} |"


def write_page(path: Path, rows: list[EnergyRow]) -> None:
    """Put the table between the page's marks; what stands around it is kept."""
    start, end = "<!-- table -->\n", "<!-- end -->\n"
    text = path.read_text(encoding="utf-8")
    if start not in text or end not in text:
        raise ValueError(f"{path} has no place for the table: it needs the lines {start!r} and {end!r}")
    head = "| case | Mitsuba, W | ours, W | difference | within |\n|---|---|---|---|---|\n"
    table = head + "".join(format_row(row) + "\n" for row in rows)
    before, after = text.split(start)[0], text.split(end)[1]
    path.write_text(before + start + table + end + after, encoding="utf-8")


def main() -> None:
    """Measure, show, and write the page where asked."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("words", nargs="*", help="only cases with one of these in their names")
    parser.add_argument("--write", action="store_true", help=f"put the table into {PAGE.name}")
    arguments = parser.parse_args()
    if reason := find_llvm():
        raise SystemExit(f"no comparison: {reason}")
    rows = []
    for case in list_cases():
        if arguments.words and not any(word in case.name for word in arguments.words):
            continue
        for row in compare_case(case):
            print(format_row(row), flush=True)
            rows.append(row)
    if arguments.write:
        write_page(PAGE, rows)
    if missed := [row.name for row in rows if not row.agrees]:
        raise SystemExit(f"beyond {LIMIT:.1%}: {', '.join(missed)}")


if __name__ == "__main__":
    main()
