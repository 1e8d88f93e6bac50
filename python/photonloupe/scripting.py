# SPDX-License-Identifier: Apache-2.0
"""Scripts: what a text says before it runs, and what a run gave (docs/script.md)."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_number
from photonloupe.columns import PATH_NAMES
from photonloupe.device_photons import DevicePhotons
from photonloupe.errors import ArgumentError, FileFormatError, ScriptError
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.settings import list_settings

SUFFIX = ".photon"
# Limits of a run (docs/script.md): steps of unbounded loops a photon, photons that may run out of them, seconds a pass.
LIMITS: dict[str, float] = {"fuel": 1_000_000, "exhausted": 1_000, "seconds": 60.0}
MAX_FUEL = 2**31 - 1
# A file is read no further than shows that it is too long.
_MOST_BYTES = 1 << 20


@dataclass(frozen=True)
class Diagnostic:
    """One error or warning; lines and columns count from 1, `end_column` is behind the last character."""

    code: str
    severity: str  # "error", "warning"
    message: str
    note: str  # may be empty
    line: int
    column: int
    end_line: int
    end_column: int
    text: str  # as the terminal shows it, with the source line and carets

    def __str__(self) -> str:
        return self.text


@dataclass(frozen=True)
class ExposedVariable:
    """A variable that can be given from outside, within its range."""

    name: str
    low: float
    high: float
    step: float  # 0 where none was given
    integer: bool
    default: float | None  # what the script assigns, where that is a constant


@dataclass(frozen=True)
class Histogram:
    """What a script's `histogram` calls of one name counted."""

    counts: NDArray[np.int64]  # (bins,)
    edges: NDArray[np.float64]  # (bins + 1,)
    below: int
    above: int
    non_finite: int


@dataclass(frozen=True)
class ScriptRun:
    """What a run gave: parameters, colors, histograms, prints, the exposed variables and a report."""

    parameters: NDArray[np.float32]  # (n, m), NaN: unset
    parameter_names: tuple[str, ...]
    parameter_bounds: NDArray[np.float32]  # (m, 2)
    colors: NDArray[np.float32] | None  # (n, 3), NaN: unset; None where the map has none
    histograms: dict[str, Histogram]
    prints: tuple[str, ...]
    exposed: dict[str, float]
    report: dict[str, Any]
    diagnostics: tuple[Diagnostic, ...]  # warnings


class Script:
    """A checked script. It may hold errors: `diagnostics` lists them, running it raises them.

    Made by `compile_script`; no device is needed.

    Examples
    --------
    >>> import photonloupe as pl
    >>> script = pl.compile_script("radius = 1; expose radius range 0, 2;")
    >>> [(variable.name, variable.high) for variable in script.exposed], script.diagnostics
    ([('radius', 2.0)], ())
    """

    def __init__(self, text: bytes, name: str) -> None:
        self._native = _engine.Script(text, name)
        self.name = name
        self.text = text.decode("utf-8", "replace")
        self.diagnostics = tuple(Diagnostic(**row) for row in self._native.diagnostics)
        self.exposed = tuple(ExposedVariable(**row) for row in self._native.exposed)

    @property
    def has_errors(self) -> bool:
        """Whether it cannot run."""
        return any(diagnostic.severity == "error" for diagnostic in self.diagnostics)

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns of the photon map it reads."""
        return tuple(self._native.columns)

    @property
    def passes(self) -> list[dict[str, Any]]:
        """Its loops over photons: line, kind (parallel, serial), reasons, reductions, neighbor queries."""
        return list(self._native.passes)

    @property
    def hash(self) -> str:
        """Hash of the text."""
        return str(self._native.hash)

    def glsl(self) -> list[str]:
        """Return the text of every compute pass."""
        self.require()
        return list(self._native.glsl())

    def spirv(self) -> list[bytes]:
        """Return every compute pass as SPIR-V."""
        self.require()
        return list(self._native.spirv())

    def require(self) -> None:
        """Raise what is wrong with it, if anything is.

        Raises
        ------
        ScriptError
            With all diagnostics, when one is an error.
        """
        if self.has_errors:
            raise ScriptError("\n".join(str(diagnostic) for diagnostic in self.diagnostics), self.diagnostics)

    def __repr__(self) -> str:
        errors = sum(diagnostic.severity == "error" for diagnostic in self.diagnostics)
        return f"<Script {self.name}: {len(self.passes)} loops over photons, {errors} errors>"


def compile_script(script: str | os.PathLike[str] | Script) -> Script:
    """Check a script and plan its passes, without any device.

    Parameters
    ----------
    script
        A file, if it is a `Path` or one line that ends in ``.photon``; else the text itself.

    Returns
    -------
    Script
        With `diagnostics`, errors among them; nothing is raised for those.

    Raises
    ------
    FileFormatError
        If the file cannot be read.
    """
    if isinstance(script, Script):
        return script
    if isinstance(script, os.PathLike):
        return _read_script(Path(script))
    if not isinstance(script, str):
        raise ArgumentError(f"script must be a text or a path, not {script!r}")
    if script.endswith(SUFFIX) and "\n" not in script:
        return _read_script(Path(script))
    return Script(script.encode("utf-8", "surrogatepass"), "script")


def _read_script(path: Path) -> Script:
    try:
        with path.open("rb") as file:
            text = file.read(_MOST_BYTES)
    except OSError as error:
        raise FileFormatError(f"{path} cannot be read: {error.strerror or error}") from error
    return Script(text, path.name)


def check_values(script: Script, values: Mapping[str, Any]) -> dict[str, float]:
    """Check values for exposed variables; see `PhotonMap.run_script`.

    Raises
    ------
    ArgumentError
        Naming the variable: it is not exposed, is no number, or is out of its range.
    """
    exposed = {variable.name: variable for variable in script.exposed}
    checked: dict[str, float] = {}
    for name, value in values.items():
        if name not in exposed:
            there = f"it exposes {', '.join(exposed)}" if exposed else "it exposes nothing"
            raise ArgumentError(f"{script.name} has no exposed variable {name!r}; {there}")
        variable = exposed[name]
        number = check_number(name, value, variable.low, variable.high)
        if variable.integer and number != int(number):
            raise ArgumentError(f"{name} = {value!r} is not a whole number; it runs over {_format_range(variable)}")
        checked[name] = number
    return checked


def _format_range(variable: ExposedVariable) -> str:
    step = f" in steps of {variable.step:g}" if variable.step else ""
    return f"{variable.low:g} to {variable.high:g}{step}"


def _check_limits(limits: Mapping[str, float] | None) -> dict[str, float]:
    given = dict(limits or {})
    unknown = sorted(set(given) - set(LIMITS))
    if unknown:
        raise ArgumentError(f"there is no limit {unknown[0]!r}; limits are {', '.join(LIMITS)}")
    taken = {**LIMITS, **given}
    return {
        "fuel": check_count("fuel", taken["fuel"], 1, MAX_FUEL),
        "exhausted": check_count("exhausted", taken["exhausted"], 1, MAX_FUEL),
        "seconds": check_number("seconds", taken["seconds"], 1e-3, 1e6),
    }


def run_script(
    photons: DevicePhotons,
    script: str | os.PathLike[str] | Script,
    values: Mapping[str, Any] | None,
    *,
    keep: bool,
    seed: int,
    limits: Mapping[str, float] | None,
    progress: ProgressLike,
    **exposed: Any,
) -> ScriptRun:
    """Run a script over a map; see `PhotonMap.run_script`."""
    compiled = compile_script(script)
    compiled.require()
    both = sorted(set(values or {}) & set(exposed))
    if both:
        raise ArgumentError(f"{both[0]} is given twice, in values and by itself")
    settings = {
        "values": check_values(compiled, {**(values or {}), **exposed}),
        "keep": bool(keep),
        "seed": list_settings("trace")["seed"].check(seed),
        **_check_limits(limits),
    }
    if any(name in PATH_NAMES for name in compiled.columns):
        photons.record_paths()
    with follow_progress(progress) as callback:
        found = compiled._native.run(photons.device._native, photons._native, settings, callback)
    made_by = {"name": compiled.name, "hash": compiled.hash, "values": found["exposed"], "seed": settings["seed"]}
    photons.take_script({**made_by, "keep": settings["keep"]})
    recorded = photons.recorded
    return ScriptRun(
        parameters=photons.parameters if "parameters" in recorded else np.zeros((len(photons), 0), dtype=np.float32),
        parameter_names=photons.parameter_names,
        parameter_bounds=photons.parameter_bounds,
        colors=photons.colors if "colors" in recorded else None,
        histograms={row.pop("name"): _make_histogram(row) for row in found["histograms"]},
        prints=tuple(found["prints"]),
        exposed=dict(found["exposed"]),
        report=found["report"],
        diagnostics=compiled.diagnostics,
    )


def _make_histogram(row: dict[str, Any]) -> Histogram:
    counts = np.asarray(row["counts"], dtype=np.int64)
    edges = np.linspace(row["low"], row["high"], len(counts) + 1)
    return Histogram(counts, edges, row["below"], row["above"], row["non_finite"])
