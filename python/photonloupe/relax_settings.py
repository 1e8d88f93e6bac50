# SPDX-License-Identifier: Apache-2.0
"""What relaxation can be told: names, ranges, and what holds where nothing is said."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, TypedDict

import numpy as np

from photonloupe.checks import check_choice, check_count, check_number
from photonloupe.device_photons import DevicePhotons
from photonloupe.errors import ArgumentError
from photonloupe.isotropy import optimal_beta
from photonloupe.progress import ProgressLike

SPACES = ("world", "parameter")
DESCRIPTORS = ("none", "gradient", "pca", "tensor", "split")
SEARCHES = ("exact", "carried")
SURFACES = ("auto", "tangent")

MAX_STEPS = 10_000
MAX_NEIGHBORS = 998  # the one after them gives the radius, and the photon itself counts: 1000 in all
# Fewer photons say nothing about a neighborhood (METHODS section 5.2).
FEWEST_CONSTRAINT_NEIGHBORS = 12

# What holds where nothing is said: the settings with the least error of all tried on the ring (docs/relaxation.md).
DEFAULTS: dict[str, Any] = {
    "neighbors": 20,
    "constraint": "auto",
    "descriptor": "tensor",
    "beta": 10.0,
    "repel": "world",
    "over_relaxation": (1.0, 1.0),
    "limit": 0.3,
    "diffuse_flux": False,
    "search": "exact",
    "surface": "auto",
    "period": (0.0, 0.0, 0.0),
}
# The same of what depends on the map's emission, and on the descriptor.
DEFAULT_STEPS = {"sobol": 5, "random": 20}
DEFAULT_CONSTRAINT_NEIGHBORS = dict.fromkeys(DESCRIPTORS, 50) | {"split": 150}

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
    constraint: str = DEFAULTS["constraint"],
    descriptor: str | None = None,
    beta: float | str | None = None,
    repel: str = DEFAULTS["repel"],
    over_relaxation: Sequence[float] | float | None = None,
    limit: float | None = DEFAULTS["limit"],
    constraint_neighbors: int | None = None,
    thresholds: Sequence[float] | None = None,
    diffuse_flux: bool = DEFAULTS["diffuse_flux"],
    search: str = DEFAULTS["search"],
    surface: str = DEFAULTS["surface"],
    period: Sequence[float] | None = None,
) -> dict[str, Any]:
    """Check all of a relaxation's settings and fill in those that nothing was said of; see `PhotonMap.relax`."""

    def choose(name: str, value: Any) -> Any:
        return DEFAULTS[name] if value is None else value

    has_parameters = "parameters" in photons.recorded
    check_choice("constraint", constraint, ("auto", *SPACES))
    space = ("parameter" if has_parameters else "world") if constraint == "auto" else constraint
    check_choice("repel", repel, SPACES)
    for name, value in (("constraint", space), ("repel", repel)):
        if value == "parameter" and not has_parameters:
            raise ArgumentError(f'{name}="parameter" needs parameters; set_parameters() or a script sets them')
    best_steps = DEFAULT_STEPS.get(str(photons.settings.get("emission")), DEFAULT_STEPS["random"])
    descriptor = check_choice("descriptor", choose("descriptor", descriptor), DESCRIPTORS)
    k = DEFAULT_CONSTRAINT_NEIGHBORS[descriptor] if constraint_neighbors is None else constraint_neighbors
    k = check_count("constraint_neighbors", k, FEWEST_CONSTRAINT_NEIGHBORS, MAX_NEIGHBORS)
    needs_beta = "parameter" in (repel, space if descriptor != "none" else "world")
    return {
        "steps": check_count("steps", best_steps if steps is None else steps, 0, MAX_STEPS),
        "neighbors": check_count("neighbors", choose("neighbors", neighbors), 1, MAX_NEIGHBORS),
        "constraint": space,
        "descriptor": descriptor,
        "beta": _choose_beta(choose("beta", beta), needs_beta, photons, progress),
        "repel": repel,
        "over_relaxation": _check_over_relaxation(choose("over_relaxation", over_relaxation)),
        "limit": None if limit is None else check_number("limit", limit, 1e-6, 1e6),
        "constraint_neighbors": k,
        "thresholds": _check_thresholds(find_thresholds(descriptor, k) if thresholds is None else thresholds),
        "diffuse_flux": bool(diffuse_flux),
        "search": check_choice("search", search, SEARCHES),
        "surface": check_choice("surface", surface, SURFACES),
        "period": _check_period(choose("period", period)),
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


def _check_over_relaxation(value: Sequence[float] | float) -> list[float]:
    pair = (value, value) if isinstance(value, int | float) else _read_numbers("over_relaxation", value, 2)
    return [check_number("over_relaxation", entry, 1e-3, 1e3) for entry in pair]


def _check_thresholds(value: Sequence[float]) -> list[float]:
    pair = _read_numbers("thresholds", value, 2)
    free_at, fixed_at = (check_number("thresholds", entry, -1e30, 1e30) for entry in pair)
    if free_at == fixed_at:
        raise ArgumentError(f"thresholds are both {free_at:g}; between them the weight rises from 0 to 1")
    return [free_at, fixed_at]


def _check_period(value: Sequence[float]) -> list[float]:
    return [check_number("period", entry, 0.0, 1e30) for entry in _read_numbers("period", value, 3)]
