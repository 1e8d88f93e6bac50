# SPDX-License-Identifier: Apache-2.0
"""The table of extremes: which cases there are, what the program does in each, and what a test run measured."""

from __future__ import annotations

from pathlib import Path

import photonloupe as pl
from conftest import SCENES

DOCUMENT = SCENES.parent / "docs" / "extremes.md"

HEADER = """# At the extremes

Written by `tests/python/test_extremes*.py` on the software device: every case below is run and checked, and the last
column is what it measured. Errors are relative to double precision, or to a closed form, unless it says otherwise.
Nothing here ends in a NaN: a stage gives a finite result or refuses with a message.

| case | what the program does | measured |
|---|---|---|
"""

# In the order of the table.
CASES: dict[str, tuple[str, str]] = {
    "scale": ("scene scaled by 10⁻⁶, 10⁻³, 10³, 10⁶", "the same fluxes; irradiance scales with 1/scale²"),
    "scale-bits": ("scene scaled by 2⁻²⁰, 2²⁰", "the same bits, scaled: positions, fluxes, irradiance"),
    "offset": (
        "scene of size 1 at distance 10⁶ from the origin",
        "kernels work relative to the scene's center; only the float `positions` column is coarse",
    ),
    "grazing": ("light that arrives at 89.98° to 89.99°", "flux of the ring it lights against the closed form"),
    "on-surface": ("light on a surface", "light leaves to both sides; that surface itself receives none"),
    "inside-glass": ("light inside a glass block, ior 1.5", "share held back by total internal reflection"),
    "ior-1": ("ior 1", "light passes straight, nothing is reflected: largest sideways error"),
    "ior-1.0001": ("light inside a glass block, ior 1.0001", "nothing is held back: share that gets out"),
    "ior-4": ("light inside a glass block, ior 4", "share held back by total internal reflection"),
    "bounces": ("64 bounces in that block", "every path accounted for; flux in against flux out"),
    "two-vertices": ("path of two vertices (direct light)", "from the light to the photon: distance of the end points"),
    "zero-area": ("triangles of zero area", "dropped and reported; the photons stay the same bits"),
    "slivers": ("floor patch of slivers 10⁶:1", "no light falls through: flux against a floor without them"),
    "duplicates": ("floor drawn twice", "each photon is stored once, at the same place"),
    "photons-0": ("0 photons", "irradiance 0; neighbors −1 and inf"),
    "photons-few": ("1, 2, k, k + 1 photons, k = 10", "irradiance as the twin's"),
    "one-point": (
        "1,000 photons at one point",
        "neighbors tie by id; irradiance finite there and beside",
    ),
    "one-line": ("1,000 photons on one line", "irradiance as the twin's"),
    "k-1": ("k = 1", "irradiance as the twin's"),
    "k-1000": ("k = 1000 of 300 photons", "all are used: irradiance as the twin's"),
    "flux": ("photon flux 10⁻³⁰ to 10³⁰ W", "irradiance scales along"),
    "intensity": ("light of 10⁻³⁰ and 10³⁰ W/sr", "stored flux scales along"),
    "intensity-limit": ("light of 3·10³⁸ W/sr", "refused by the loader: at most 10³⁰"),
    "not-finite": ("NaN and ±inf in every float column", "refused by column and row: columns tried"),
    "points-not-finite": ("NaN and ±inf in query points and normals", "refused by row: arrays tried"),
    "vertex-not-finite": ("vertex that is NaN, inf or beyond 10³⁰ m", "refused by the loader: values tried"),
    "count-limit": ("2³¹ photons asked for", "refused: at most 2³¹ − 1"),
    "memory-limit": ("2³¹ − 1 photons asked for", "refused with how many would fit"),
    "emitted-limit": ("2³⁰ + 1 photons to emit", "refused: at most 2³⁰"),
    "k-limit": ("k = 0 and 1001", "refused: k is 1 to 1000"),
    "id-limit": ("photon id 2³¹", "refused by row"),
    "parameters-not-finite": ("NaN and ±inf in parameters", "NaN: the photon has none; inf: refused by row and column"),
    "parameters-limit": ("0 and 14 parameters", "refused: 1 to 13"),
    "parameters-range": ("parameters of 10¹⁹, all within 10⁻¹³", "queries and layers refuse and say how to scale"),
    "parameters-unset": (
        "parameters of no photon set",
        "no neighbors in parameter space; layers are the emitters, relaxed as the twin's; no β",
    ),
    "emitter-each": ("an emitter for each of 300 photons", "no neighbors in their layers; no photon moves"),
    "signature": (
        "a parameter of 3 values over 3,000 photons",
        "neighbors tie by id; layers are the values: constraint as the twin's",
    ),
    "parameters-seam": ("parameters on both sides of a periodic seam", "relaxed as if it were nowhere"),
    "beta": ("β = 0, 10⁻³, 10⁶", "constraint and moves as the twin's"),
    "layers-k": ("k = 1 and k = 998 of 300 photons", "neighbors in parameter space and in layers as the twin's"),
    "relax-few": ("0, 1, 2, K + 1, K + 2 photons relaxed, K = 6", "moves as the twin's"),
    "relax-k": ("K = 1 and K = 998 of 300 photons", "moves as the twin's"),
    "relax-k-limit": ("K = 0, 999; constraint from 11, 999 photons", "refused: 1 to 998, 12 to 998"),
    "relax-one-point": (
        "10,000 photons at one point relaxed",
        "isotropy 1, nothing held, no gradient; they part by what floats tell apart",
    ),
    "relax-two-points": ("500 photons at each of two points", "stay finite: largest move as a share of their distance"),
    "relax-one-line": (
        "2,000 photons on one line relaxed",
        "isotropy 0: held across the line, and stay on it; weights as the twin's",
    ),
    "relax-clusters": ("two clusters of 500 photons, 10⁴ sizes apart", "moves as the twin's"),
    "beta-degenerate": (
        "axis ratios of photons at one point, on one line",
        "none: refused by name; 0: refused, no β is large enough",
    ),
    "relax-flux": (
        "flux 10⁻³⁰ to 10³⁰ W relaxed",
        "same moves; fluxes stay to the bit, and keep their sum when diffused",
    ),
    "relax-scale": ("photons scaled by 10⁻⁶, 10⁻³, 10³, 10⁶ relaxed", "moves as the twin's"),
    "relax-scale-bits": ("photons scaled by 2⁻²⁰, 2²⁰ relaxed", "the same bits, scaled"),
    "relax-offset": ("photons 10⁶ from the origin relaxed", "moves as the twin's"),
    "relax-runaway": (
        "10 steps, λ = 2, no limiter, no surface, photons of a sphere",
        "finite; the farthest flies so many radii",
    ),
    "script-photons": ("scripts over 0, 1, 2 and 65 photons", "sums, counts, extremes and PCA as of so many"),
    "script-acos": ("acos and asin outside [−1, 1]", "clamped up to 10⁻⁵, NaN beyond"),
    "script-paths": (
        "path of two vertices, segment of no length",
        "no tortuosity: unset; the others as the closed form",
    ),
    "script-pca": (
        "PCA of equal points, of points on a line, to 10⁻²⁰, 10¹⁸, 10²⁰",
        "no axis; that of the line; at 10²⁰ squares overflow: none",
    ),
    "script-numbers": (
        "scripts' numbers at the ends of floats and integers",
        "NaN spreads, integers wrap, lengths hold",
    ),
    "script-not-finite": ("parameters set to NaN or inf", "unset; counted with the first photon and line"),
    "script-sums": ("sum of 9,000 fluxes from 10⁻³⁰ to 10³⁰", "in blocks and lanes, against double precision"),
    "script-scale": ("scripts over paths scaled by 10⁻⁶ and 10⁶", "the same tortuosity"),
    "script-endless": (
        "a loop without an end in a script",
        "photons stop, stay unset and are counted; the next script runs",
    ),
    "script-limits": (
        "source, nesting, variables, arrays, dimensions, k at and beyond their limits",
        "accepted; refused",
    ),
}


def show(value: float) -> str:
    """Two significant digits: what is left of rounding noise does not change the file."""
    return "0" if value == 0 else f"{value:.1e}"


_measured: dict[str, str] = {}


def add_row(case: str, measured: str) -> None:
    """Note what a case measured; the last of all cases renews the document, on the software device."""
    assert case in CASES, f"{case} is not in the table of cases"
    _measured[case] = measured
    if _measured.keys() == CASES.keys() and pl.Device().info["type"] == "software":
        _write(DOCUMENT)


def _write(path: Path) -> None:
    """Rewrite the file if its content changed."""
    rows = (f"| {CASES[case][0]} | {CASES[case][1]} | {_measured[case]} |\n" for case in CASES)
    text = HEADER + "".join(rows)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
