# SPDX-License-Identifier: Apache-2.0
"""Naive twins of relaxation on flat ground: brute force in double precision, one photon at a time."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from twins import MAX_HEIGHT_SHARE, MIN_NORMAL_COSINE

Doubles = NDArray[np.float64]
Ids = NDArray[np.int64]
Mask = NDArray[np.bool_]

# METHODS section 3: keeps the force of near photons finite; steepness of the schedule of λ, equation 2.
SOFTENING = 1e-12
SCHEDULE = 6.0


@dataclass(frozen=True)
class Photons:
    """Photons in a world that repeats after `world_periods` (3,), 0 where it does not; NaN parameters are unset."""

    positions: Doubles  # (n, 3)
    normals: Doubles  # (n, 3), unit
    emitter: Ids  # (n,)
    parameters: Doubles  # (n, m), m may be 0
    periods: Doubles  # (m,), 0 where a dimension does not repeat
    world_periods: Doubles  # (3,)

    @property
    def is_set(self) -> Mask:
        """Photons of which every parameter is set, (n,)."""
        return np.isfinite(self.parameters).all(axis=1) & (self.parameters.shape[1] > 0)


@dataclass(frozen=True)
class Settings:
    """How a relaxation goes; the names are the program's."""

    steps: int = 20
    neighbors: int = 6
    over_relaxation: tuple[float, float] = (2.0, 1.2)  # λmax, λmin
    limit: float | None = 0.3  # ρ
    repel: str = "world"
    beta: float = 3.0


@dataclass(frozen=True)
class Constraint:
    """Which way each photon may move: u_b along and v_b across, (n, 2, 3), and w_u, w_v, (n, 2)."""

    basis: Doubles
    weights: Doubles


@dataclass(frozen=True)
class Members:
    """The neighbors a query takes: ids, nearest first, their weights, distances, radius r and number K'."""

    ids: Ids
    weights: Doubles
    distances: Doubles
    radius: float
    places: int


@dataclass(frozen=True)
class Step:
    """What one step did: the photons after it, and per photon its move, its pressure |f'|/r and its radius."""

    photons: Photons
    moves: Doubles
    pressure: Doubles
    radii: Doubles


def make_photons(
    positions: Doubles,
    *,
    normals: Doubles | None = None,
    emitter: Ids | None = None,
    parameters: Doubles | None = None,
    periods: Doubles | None = None,
    world_periods: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> Photons:
    """Photons on the plane y = const by default, of one emitter, without parameters."""
    count = len(positions)
    values = np.empty((count, 0)) if parameters is None else np.asarray(parameters, dtype=np.float64)
    return Photons(
        np.asarray(positions, dtype=np.float64),
        np.tile((0.0, 1.0, 0.0), (count, 1)) if normals is None else np.asarray(normals, dtype=np.float64),
        np.zeros(count, dtype=np.int64) if emitter is None else np.asarray(emitter, dtype=np.int64),
        values,
        np.zeros(values.shape[1]) if periods is None else np.asarray(periods, dtype=np.float64),
        np.asarray(world_periods, dtype=np.float64),
    )


def wrap(difference: Doubles, period: Doubles) -> Doubles:
    """Bring differences into [-period/2, period/2] where the period is not 0; the last axes match."""
    repeats = period > 0.0
    length = np.where(repeats, period, 1.0)
    return np.where(repeats, difference - length * np.round(difference / length), difference)


def measure_parameters(values: Doubles, value: Doubles, periods: Doubles) -> Doubles:
    """Distance in parameter space of every row of `values` from `value`, NaN where either is unset."""
    return np.sqrt(np.sum(wrap(values - value, periods) ** 2, axis=-1))


def find_parameter_radius(values: Doubles, is_set: Mask, emitter: Ids, k: int, periods: Doubles) -> Doubles:
    """r_q of every photon: how far its k-th neighbor in parameter space is, inf with fewer, (n,)."""
    radii = np.full(len(values), np.inf)
    for i in np.flatnonzero(is_set):
        others = is_set & (emitter == emitter[i])
        others[i] = False
        away = np.sort(measure_parameters(values[others], values[i], periods))
        if len(away) >= k:
            radii[i] = away[k - 1]
    return radii


def find_candidates(
    photons: Photons, i: int, *, space: str, beta: float = 3.0, parameter_radius: float = np.inf
) -> tuple[Ids, Doubles]:
    """Ids of the photons that i may see, in their order, and the measures μ by which they are chosen."""
    away = wrap(photons.positions - photons.positions[i], photons.world_periods)
    height = away @ photons.normals[i]
    measure = np.maximum(np.sum(away**2, axis=1), (height / MAX_HEIGHT_SHARE) ** 2)
    seen = photons.normals @ photons.normals[i] > MIN_NORMAL_COSINE
    seen[i] = False
    if space == "parameter":
        is_set = photons.is_set
        seen &= (photons.emitter == photons.emitter[i]) & (is_set == is_set[i])
        if is_set[i] and np.isfinite(parameter_radius):
            apart = measure_parameters(photons.parameters, photons.parameters[i], photons.periods)
            seen &= apart <= beta * parameter_radius
    elif space != "world":
        raise ValueError(space)
    ids = np.flatnonzero(seen)
    return ids, measure[ids]


def choose_members(ids: Ids, measure: Doubles, k: int) -> Members:
    """Take the k nearest of the candidates; those at the rim share what is left, so that order never matters."""
    order = np.lexsort((ids, measure))
    ids, measure = ids[order], measure[order]
    found = len(ids)
    if found == 0:
        return Members(ids, measure, measure, 0.0, 0)
    if found == 1:
        return Members(ids, np.ones(1), np.sqrt(measure), 2.0 * float(np.sqrt(measure[0])), 1)
    places = min(k, found - 1)
    square = float(measure[places])
    inside, rim = measure < square, measure == square
    weights = np.where(inside, 1.0, np.where(rim, (places - inside.sum()) / rim.sum(), 0.0))
    kept = weights > 0.0
    return Members(ids[kept], weights[kept], np.sqrt(measure[kept]), float(np.sqrt(square)), places)


def find_members(photons: Photons, k: int, *, space: str = "world", beta: float = 3.0) -> list[Members]:
    """Members of every photon's query; `distances` are the square roots of μ."""
    radii = np.full(len(photons.positions), np.inf)
    if space == "parameter":
        radii = find_parameter_radius(photons.parameters, photons.is_set, photons.emitter, k, photons.periods)
    return [
        choose_members(*find_candidates(photons, i, space=space, beta=beta, parameter_radius=float(radius)), k)
        for i, radius in enumerate(radii)
    ]


def compute_over_relaxation(settings: Settings, step: int) -> float:
    """λ of one step, counted from 0: METHODS equation 2."""
    most, least = settings.over_relaxation
    return float(least + (most - least) * np.exp(-SCHEDULE * step**2 / settings.steps**2))


def compute_force(photons: Photons, i: int, members: Members, over_relaxation: float) -> Doubles:
    """Push of the members on photon i, equation 1, in its tangent plane, equation 3; coincident ones give none."""
    if members.places == 0 or members.radius == 0.0:
        return np.zeros(3)
    reach = members.radius * over_relaxation
    apart = wrap(photons.positions[i] - photons.positions[members.ids], photons.world_periods)
    away = np.linalg.norm(apart, axis=1)
    strength = reach / (away + SOFTENING * members.radius) - away / reach
    force = (members.weights * strength) @ apart / members.places
    normal = photons.normals[i]
    return force - normal * (normal @ force)


def limit_move(force: Doubles, radius: float, limit: float | None) -> Doubles:
    """Hold back moves that are long against the radius: equation 5."""
    if limit is None or radius == 0.0:
        return force
    return force * np.exp(-(force @ force) / radius**2 * np.log(2.0) / limit**2)


def relax_step(photons: Photons, settings: Settings, step: int, constraint: Constraint | None = None) -> Step:
    """Move every photon once, all from where they stood before the step."""
    count = len(photons.positions)
    moves, pressure, radii = np.zeros((count, 3)), np.zeros(count), np.zeros(count)
    over_relaxation = compute_over_relaxation(settings, step)
    for i, members in enumerate(find_members(photons, settings.neighbors, space=settings.repel, beta=settings.beta)):
        force = compute_force(photons, i, members, over_relaxation)
        radii[i] = members.radius
        if members.radius > 0.0:
            pressure[i] = np.linalg.norm(force) / members.radius
        if constraint is not None:  # equation 4
            free = 1.0 - constraint.weights[i]
            force = (free * (constraint.basis[i] @ force)) @ constraint.basis[i]
        moves[i] = limit_move(force, members.radius, settings.limit)
    positions = photons.positions + moves
    repeats = photons.world_periods > 0.0
    positions[:, repeats] %= photons.world_periods[repeats]
    return Step(replace(photons, positions=positions), moves, pressure, radii)


def relax(photons: Photons, settings: Settings, constraint: Constraint | None = None) -> tuple[Photons, Doubles]:
    """All steps, and the drift of every photon, (n, 3)."""
    drift = np.zeros_like(photons.positions)
    for step in range(settings.steps):
        result = relax_step(photons, settings, step, constraint)
        photons = result.photons
        drift += result.moves
    return photons, drift


def diffuse_flux(photons: Photons, power: Doubles, k: int, *, space: str = "world", beta: float = 3.0) -> Doubles:
    """Blend fluxes (n, 3) with the neighbors', METHODS section 3; every channel keeps its total."""
    blended = power.copy()
    for i, members in enumerate(find_members(photons, k, space=space, beta=beta)):
        if members.places == 0 or members.radius == 0.0:
            continue
        apart = wrap(photons.positions[members.ids] - photons.positions[i], photons.world_periods)
        weights = members.weights * (1.0 - np.sum(apart**2, axis=1) / members.radius**2)
        blended[i] = (power[i] + weights @ power[members.ids]) / (1.0 + weights.sum())
    totals = blended.sum(axis=0)
    return blended * np.where(totals > 0.0, power.sum(axis=0) / np.where(totals > 0.0, totals, 1.0), 1.0)
