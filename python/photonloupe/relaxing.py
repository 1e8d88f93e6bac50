# SPDX-License-Identifier: Apache-2.0
"""Photon relaxation: constraints that say which way photons may move, and the steps that move them."""

from __future__ import annotations

import logging
import math
from collections.abc import Sequence
from typing import Any, Generic, TypedDict, TypeVar, Unpack

import numpy as np

from photonloupe import _engine
from photonloupe.checks import check_choice, check_count, check_number
from photonloupe.device import open_device
from photonloupe.device_photons import DevicePhotons
from photonloupe.errors import ArgumentError
from photonloupe.isotropy import optimal_beta
from photonloupe.progress import ProgressLike, follow_progress

LOG = logging.getLogger("photonloupe")

# What is relaxed: a photon map, which relaxing gives back.
PhotonsT = TypeVar("PhotonsT", bound=DevicePhotons)

SPACES = ("world", "parameter")
DESCRIPTORS = ("none", "gradient", "pca", "tensor", "split")
SEARCHES = ("exact", "carried")
SURFACES = ("auto", "tangent")

MAX_STEPS = 10_000
MAX_NEIGHBORS = 998  # the one after them gives the radius, and the photon itself counts: 1000 in all
# Fewer photons say nothing about a neighborhood (METHODS section 5.2).
FEWEST_CONSTRAINT_NEIGHBORS = 12
CONSTRAINT_NEIGHBORS = {"split": 150}
DEFAULT_CONSTRAINT_NEIGHBORS = 50
# Axis ratio t that 5 % of uniform points stay below (METHODS 5.2); 1 - c/√k between them, with c linear in log k.
_ISOTROPY_K = (20.0, 50.0, 100.0, 250.0)
_ISOTROPY_QUANTILES = (0.61, 0.75, 0.82, 0.88)
_ISOTROPY_MARGIN = 0.05
_ISOTROPY_SPAN = 0.3
# Largest eigenvalue over that of noise; homogeneity of spacings (METHODS 5.3, 5.4).
TENSOR_THRESHOLDS = (2.0, 6.0)
SPLIT_THRESHOLDS = (0.35, 0.2)
# Edge of one-sidedness, fixed in the kernel (METHODS 5.2).
GRADIENT_THRESHOLDS = (0.35, 0.8)
MAX_BETA = 1e18


def find_pca_thresholds(k: int) -> tuple[float, float]:
    """Axis ratios t that leave a photon free and that fix it, for k neighbors (METHODS section 5.2)."""
    factors = (1.0 - np.array(_ISOTROPY_QUANTILES)) * np.sqrt(_ISOTROPY_K)
    c = float(np.interp(math.log(k), np.log(_ISOTROPY_K), factors))
    free_at = 1.0 - c / math.sqrt(k) + _ISOTROPY_MARGIN
    return free_at, free_at - _ISOTROPY_SPAN


def find_thresholds(descriptor: str, k: int) -> tuple[float, float]:
    """Values of a descriptor that leave a photon free and that fix it."""
    if descriptor == "pca":
        return find_pca_thresholds(k)
    return {"tensor": TENSOR_THRESHOLDS, "split": SPLIT_THRESHOLDS}.get(descriptor, GRADIENT_THRESHOLDS)


def check_beta(value: Any, photons: DevicePhotons, progress: ProgressLike = None) -> float:
    """Return β as a number, found from the map when it is ``"auto"``."""
    if isinstance(value, str):
        check_choice("beta", value, ("auto",))
        return float(optimal_beta(photons, progress=progress))
    return check_number("beta", value, 0.0, MAX_BETA)


class RelaxKeywords(TypedDict, total=False):
    """What `PhotonMap.relax` can be told beside steps and neighbors; it says what each means."""

    constraint: str
    descriptor: str | None
    beta: float | str | None
    repel: str
    over_relaxation: Sequence[float] | float | None
    limit: float | None
    constraint_neighbors: int | None
    thresholds: Sequence[float] | None
    diffuse_flux: bool
    search: str
    surface: str
    period: Sequence[float] | None


class AllRelaxKeywords(RelaxKeywords, total=False):
    """What `Relaxation` can be told."""

    steps: int | None
    neighbors: int | None


def check_settings(
    photons: DevicePhotons,
    progress: ProgressLike,
    *,
    steps: int | None = None,
    neighbors: int | None = None,
    constraint: str = "auto",
    descriptor: str | None = None,
    beta: float | str | None = None,
    repel: str = "world",
    over_relaxation: Sequence[float] | float | None = None,
    limit: float | None = 0.3,
    constraint_neighbors: int | None = None,
    thresholds: Sequence[float] | None = None,
    diffuse_flux: bool = False,
    search: str = "exact",
    surface: str = "auto",
    period: Sequence[float] | None = None,
) -> dict[str, Any]:
    """Check all of a relaxation's settings and fill in those that nothing was said of; see `PhotonMap.relax`."""
    has_parameters = "parameters" in photons.recorded
    check_choice("constraint", constraint, ("auto", *SPACES))
    space = ("parameter" if has_parameters else "world") if constraint == "auto" else constraint
    check_choice("repel", repel, SPACES)
    for name, value in (("constraint", space), ("repel", repel)):
        if value == "parameter" and not has_parameters:
            raise ArgumentError(f'{name}="parameter" needs parameters; set_parameters() or a script sets them')
    best = find_best(str(photons.settings.get("emission", "random")))
    descriptor = check_choice("descriptor", best["descriptor"] if descriptor is None else descriptor, DESCRIPTORS)
    k = CONSTRAINT_NEIGHBORS.get(descriptor, DEFAULT_CONSTRAINT_NEIGHBORS)
    k = check_count(
        "constraint_neighbors",
        k if constraint_neighbors is None else constraint_neighbors,
        FEWEST_CONSTRAINT_NEIGHBORS,
        MAX_NEIGHBORS,
    )
    needs_beta = "parameter" in (repel, space if descriptor != "none" else "world")
    beta = best["beta"] if beta is None else beta
    return {
        "steps": check_count("steps", best["steps"] if steps is None else steps, 0, MAX_STEPS),
        "neighbors": check_count("neighbors", best["neighbors"] if neighbors is None else neighbors, 1, MAX_NEIGHBORS),
        "constraint": space,
        "descriptor": descriptor,
        "beta": _choose_beta(beta, needs_beta, photons, progress),
        "repel": repel,
        "over_relaxation": _check_over_relaxation(
            best["over_relaxation"] if over_relaxation is None else over_relaxation
        ),
        "limit": None if limit is None else check_number("limit", limit, 1e-6, 1e6),
        "constraint_neighbors": k,
        "thresholds": _check_thresholds(find_thresholds(descriptor, k) if thresholds is None else thresholds),
        "diffuse_flux": bool(diffuse_flux),
        "search": check_choice("search", search, SEARCHES),
        "surface": check_choice("surface", surface, SURFACES),
        "period": _check_period(period),
    }


def _choose_beta(beta: Any, is_needed: bool, photons: DevicePhotons, progress: ProgressLike) -> float:
    """β where layers decide, 0 where they don't; a wrong one is refused all the same."""
    if beta == "auto" and not is_needed:
        return 0.0
    checked = check_beta(beta, photons, progress)
    return checked if is_needed else 0.0


def _read_numbers(name: str, value: Any, count: int) -> tuple[Any, ...]:
    """Take apart what should be `count` numbers."""
    try:
        numbers = tuple(value)
    except TypeError:
        numbers = ()
    if len(numbers) != count:
        raise ArgumentError(f"{name} must be {count} numbers, not {value!r}")
    return numbers


def find_best(emission: str) -> dict[str, Any]:
    """Return the settings with the least error of all tried on the ring (docs/relaxation.md)."""
    return {
        "steps": 5 if emission == "sobol" else 20,
        "neighbors": 20,
        "over_relaxation": (1.0, 1.0),
        "descriptor": "tensor",
        "beta": 10.0,
    }


def _check_over_relaxation(value: Sequence[float] | float) -> list[float]:
    pair = (value, value) if isinstance(value, int | float) else _read_numbers("over_relaxation", value, 2)
    return [check_number("over_relaxation", entry, 1e-3, 1e3) for entry in pair]


def _check_thresholds(value: Sequence[float]) -> list[float]:
    pair = _read_numbers("thresholds", value, 2)
    free_at, fixed_at = (check_number("thresholds", entry, -1e30, 1e30) for entry in pair)
    if free_at == fixed_at:
        raise ArgumentError(f"thresholds are both {free_at:g}; between them the weight rises from 0 to 1")
    return [free_at, fixed_at]


def _check_period(value: Sequence[float] | None) -> list[float]:
    if value is None:
        return [0.0, 0.0, 0.0]
    return [check_number("period", entry, 0.0, 1e30) for entry in _read_numbers("period", value, 3)]


class Relaxation(Generic[PhotonsT]):
    """A relaxation that is stepped by hand.

    Making one measures the constraint; `step` moves the photons once. Keywords are those of `PhotonMap.relax`.

    Parameters
    ----------
    photons
        The map to relax; it stays as it is.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> spots = np.random.default_rng(0).random((500, 3)) * [1, 0, 1]
    >>> photons = pl.PhotonMap.from_arrays(positions=spots, normals=[[0, 1, 0]] * 500, power=np.ones((500, 3)))
    >>> relaxation = pl.Relaxation(photons, steps=3, descriptor="none")
    >>> relaxation.step()["step"], relaxation.step()["step"], relaxation.step_count
    (0, 1, 2)
    >>> len(relaxation.photons)
    500
    """

    def __init__(
        self, photons: PhotonsT, *, progress: ProgressLike = None, **settings: Unpack[AllRelaxKeywords]
    ) -> None:
        self._source = photons
        self._settings = check_settings(photons, progress, **settings)
        self._rows: list[dict[str, Any]] = []
        self._device = open_device(photons.device)
        self._scene = photons.find_surface() if self._settings["surface"] == "auto" else None
        native_scene = None if self._scene is None else self._scene._native
        native_settings = {
            **self._settings,
            "limit": self._settings["limit"] or 0.0,
            # The engine divides by the number of steps, even where none is made.
            "steps": max(self._settings["steps"], 1),
        }
        with follow_progress(progress) as callback:
            self._native = _engine.start_relaxation(
                self._device._native, photons.upload(), native_scene, native_settings, callback
            )
        for note in self.notes:
            LOG.warning(note)

    def __repr__(self) -> str:
        told = self._settings
        return (
            f"<Relaxation of {len(self._source):,} photons: step {self.step_count} of {self.steps}, "
            f"{told['neighbors']} neighbors, {told['descriptor']} in {told['constraint']} space>"
        )

    @property
    def settings(self) -> dict[str, Any]:
        """All settings, those that nothing was said of filled in."""
        return dict(self._settings)

    @property
    def notes(self) -> list[str]:
        """What makes the parameters useless here, with the cure; the relaxation goes on as in world space."""
        return list(self._native.notes)

    @property
    def steps(self) -> int:
        """Number of steps the relaxation was planned for; over-relaxation fades over them."""
        return int(self._settings["steps"])

    @property
    def step_count(self) -> int:
        """Number of steps made."""
        return len(self._rows)

    def step(self, *, progress: ProgressLike = None) -> dict[str, Any]:
        """Move all photons once.

        Returns
        -------
        dict
            ``step`` from 0, ``tau`` (METHODS eq. 2), ``mean_move`` and ``largest_move`` (|move|/r), ``mean_pressure``
            (|f'|/r), ``mean_displacement`` (m), ``flux_drift`` (relative, before the total was restored).
        """
        with follow_progress(progress) as callback:
            row = dict(self._native.step(callback))
        self._rows.append(row)
        return row

    @property
    def report(self) -> dict[str, Any]:
        """Settings, one row per step, and where photons move: on their surface, or in tangent planes."""
        return self._describe(self._native.read()[2])

    @property
    def photons(self) -> PhotonsT:
        """The map as it is now, with constraint, drift and pressure."""
        native, state, off_surface = self._native.read()
        columns = {name: np.asarray(values) for name, values in state.items()}
        return self._source.replace_positions(native, columns, self._describe(off_surface))

    def _describe(self, off_surface: int) -> dict[str, Any]:
        return {
            "settings": dict(self._settings),
            "steps": [dict(row) for row in self._rows],
            "surface": "tangent planes" if self._scene is None else str(self._scene.path),
            "notes": self.notes,
            "off_surface": int(len(self._source) if self._scene is None else off_surface),
        }


def relax_photons(photons: PhotonsT, progress: ProgressLike, **settings: Unpack[AllRelaxKeywords]) -> PhotonsT:
    """Run a whole relaxation; see `PhotonMap.relax`."""
    relaxation = Relaxation(photons, progress=progress, **settings)
    for _ in range(relaxation.steps):
        relaxation.step(progress=progress)
    return relaxation.photons
