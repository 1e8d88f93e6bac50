# SPDX-License-Identifier: Apache-2.0
"""Naive twins of the constraints and of the choice of β: brute force in double precision, one photon at a time."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from relax_twins import (
    Constraint,
    Doubles,
    Members,
    Photons,
    choose_members,
    find_members,
    measure_parameters,
    wrap,
)

# METHODS section 5. Mean offset of a half disc, in radii: 4/(3π) rounded as there.
HALF_DISC_MEAN = 0.4244
# One-sidedness at which a photon begins to be held, and is held in full.
ONE_SIDED = (0.35, 0.80)
FEWEST_NEIGHBORS = 12
# 5 % quantiles of the isotropy of k uniform points, and the margin and the width of the ramp about them.
QUANTILE_NEIGHBORS = (20, 50, 100, 250)
QUANTILES = (0.61, 0.75, 0.82, 0.88)
QUANTILE_MARGIN, RAMP = 0.05, 0.3
# Squared mean offset of k random points in a unit disc, times k.
TENSOR_NOISE = 0.25
TENSOR_RAMP = (2.0, 6.0)
SPLIT_RAMP = (0.2, 0.35)
FEWEST_GAPS = 8


@dataclass(frozen=True)
class Moments:
    """Of the members about one photon, in its tangent plane: mean offset (3,), covariance (2, 2), axes (2, 3)."""

    mean: Doubles
    covariance: Doubles
    axes: Doubles
    one_sidedness: float
    gradient: Doubles  # (3,), 1/m


@dataclass(frozen=True)
class Constraints:
    """The constraint and what it was made from, one row per photon."""

    constraint: Constraint
    gradient: Doubles  # (n, 3), ∇f/f, 1/m
    one_sidedness: Doubles  # (n,)
    members: list[Members]


@dataclass(frozen=True)
class Hold:
    """What a descriptor says of one photon: direction across, if it names one, and w_v."""

    across: Doubles | None
    weight: float


FREE = Hold(None, 0.0)


def clamp(value: float, ramp: tuple[float, float] = (0.0, 1.0)) -> float:
    """Rise linearly from 0 to 1 over the ramp."""
    return float(np.clip((value - ramp[0]) / (ramp[1] - ramp[0]), 0.0, 1.0))


def build_tangents(normal: Doubles) -> Doubles:
    """Two unit vectors across `normal`, (2, 3); which two must never matter."""
    helper = np.eye(3)[np.argmin(np.abs(normal))]
    first = np.cross(normal, helper)
    first /= np.linalg.norm(first)
    return np.stack([first, np.cross(normal, first)])


def find_axes(matrix: Doubles) -> tuple[Doubles, Doubles]:
    """Eigenvalues of a symmetric matrix, greatest first and not below 0, and eigenvectors as rows."""
    values, vectors = np.linalg.eigh(matrix)
    return np.maximum(values[::-1], 0.0), vectors.T[::-1]


def compute_isotropy(covariance: Doubles) -> float:
    """√(λ₂/λ₁) of a covariance (2, 2); 1 where all points are one."""
    (greater, less), _ = find_axes(covariance)
    return float(np.sqrt(less / greater)) if greater > 0.0 else 1.0


def compute_moments(photons: Photons, i: int, members: Members) -> Moments:
    """Mean and covariance of the members' offsets in the tangent plane of i, and the gradient they tell."""
    axes = build_tangents(photons.normals[i])
    if members.places == 0:
        return Moments(np.zeros(3), np.zeros((2, 2)), axes, 0.0, np.zeros(3))
    away = wrap(photons.positions[members.ids] - photons.positions[i], photons.world_periods)
    offsets = away @ axes.T
    shares = members.weights / members.weights.sum()
    mean = shares @ offsets
    spread = offsets - mean
    covariance = (shares[:, None] * spread).T @ spread
    if members.radius == 0.0:
        return Moments(mean @ axes, covariance, axes, 0.0, np.zeros(3))
    one_sidedness = float(np.linalg.norm(mean)) / (HALF_DISC_MEAN * members.radius)
    return Moments(mean @ axes, covariance, axes, one_sidedness, 4.0 * mean @ axes / members.radius**2)


def find_isotropy_ramp(k: int) -> tuple[float, float]:
    """t_lo and t_hi for k neighbors."""
    factors = (1.0 - np.array(QUANTILES)) * np.sqrt(QUANTILE_NEIGHBORS)
    factor = np.interp(np.log(k), np.log(QUANTILE_NEIGHBORS), factors)
    high = float(1.0 - factor / np.sqrt(k) + QUANTILE_MARGIN)
    return high - RAMP, high


def normalize(vector: Doubles) -> Doubles | None:
    """Direction of a vector, None for 0."""
    length = np.linalg.norm(vector)
    return vector / length if length > 0.0 else None


def hold_by_gradient(moments: Moments, ramp: tuple[float, float]) -> Hold:
    """Across is the direction of the mean offset."""
    return Hold(normalize(moments.mean), clamp(moments.one_sidedness, ramp))


def hold_by_pca(moments: Moments, ramp: tuple[float, float]) -> Hold:
    """Across is the second eigenvector of the covariance, or the mean offset where one-sidedness says more."""
    low, high = ramp
    _, vectors = find_axes(moments.covariance)
    thin = Hold(vectors[1] @ moments.axes, clamp(high - compute_isotropy(moments.covariance), (0.0, high - low)))
    edge = hold_by_gradient(moments, ONE_SIDED)
    return edge if edge.weight > thin.weight else thin


def hold_by_tensor(i: int, members: Members, slopes: Doubles, moments: Moments, ramp: tuple[float, float]) -> Hold:
    """Across is the first eigenvector of the structure tensor of the normalized offsets g (n, 3)."""
    own, others = moments.axes @ slopes[i], slopes[members.ids] @ moments.axes.T
    tensor = np.outer(own, own) + (members.weights[:, None] * others).T @ others
    (greatest, _), vectors = find_axes(tensor / (1.0 + members.places))
    return Hold(vectors[0] @ moments.axes, clamp(greatest / (TENSOR_NOISE / members.places), ramp))


def weigh_gaps(gaps: Doubles, weights: Doubles) -> tuple[float, float]:
    """Weighted mean of gaps, and deviation over mean, 0 where the gaps are 0."""
    mean = float(np.average(gaps, weights=weights))
    deviation = float(np.sqrt(np.average((gaps - mean) ** 2, weights=weights)))
    return mean, deviation / mean if mean > 0.0 else 0.0


def hold_by_split(photons: Photons, i: int, members: Members, moments: Moments, ramp: tuple[float, float]) -> Hold:
    """Across is the mean offset; the split lies in the gap that leaves the evenest gaps on both its sides."""
    across = normalize(moments.mean)
    if across is None:
        return FREE
    away = wrap(photons.positions[members.ids] - photons.positions[i], photons.world_periods)
    signed = np.sort(np.concatenate([away @ across, [-members.radius, members.radius]]))
    gaps, middles = np.diff(signed), 0.5 * (signed[1:] + signed[:-1])
    weights = np.maximum(1.0 - (middles / members.radius) ** 2, 0.0)
    best: tuple[float, int, float, float] | None = None
    for split in range(FEWEST_GAPS, len(gaps) - FEWEST_GAPS):  # the gap that is split belongs to neither side
        left, left_share = weigh_gaps(gaps[:split], weights[:split])
        right, right_share = weigh_gaps(gaps[split + 1 :], weights[split + 1 :])
        if best is None or left_share + right_share < best[0]:
            best = (left_share + right_share, split, left, right)
    if best is None:
        return FREE
    _, split, left, right = best
    homogeneity = min(left, right) / max(left, right) if max(left, right) > 0.0 else 1.0
    near = abs(middles[split]) <= 0.5 * (left + right)
    return Hold(across, 1.0 - clamp(homogeneity, ramp) if near else 0.0)


def constrain(
    photons: Photons,
    descriptor: str,
    *,
    neighbors: int = 50,
    space: str = "world",
    beta: float = 3.0,
    ramp: tuple[float, float] | None = None,
) -> Constraints:
    """Which way every photon may move; `ramp` replaces the descriptor's thresholds, low before high."""
    count = len(photons.positions)
    members = find_members(photons, neighbors, space=space, beta=beta)
    moments = [compute_moments(photons, i, members[i]) for i in range(count)]
    slopes = np.array(
        [m.mean / each.radius if each.radius > 0.0 else np.zeros(3) for m, each in zip(moments, members, strict=True)]
    ).reshape(count, 3)
    # The isotropy's ramp is that of the number asked for, also where fewer were found.
    usual = {"pca": find_isotropy_ramp(neighbors), "tensor": TENSOR_RAMP, "split": SPLIT_RAMP, "gradient": ONE_SIDED}
    thresholds = ramp or usual[descriptor]
    basis, weights = np.zeros((count, 2, 3)), np.zeros((count, 2))
    for i in range(count):
        if members[i].places < FEWEST_NEIGHBORS:
            hold, weights[i] = hold_by_gradient(moments[i], ONE_SIDED), 1.0
        elif members[i].radius == 0.0:
            hold = FREE
        else:
            hold = describe(descriptor, photons, i, members[i], moments[i], slopes, thresholds)
            weights[i, 1] = hold.weight
        basis[i] = build_basis(hold.across, moments[i], photons.normals[i])
    return Constraints(
        Constraint(basis, weights),
        np.array([m.gradient for m in moments]).reshape(count, 3),
        np.array([m.one_sidedness for m in moments]),
        members,
    )


def describe(
    descriptor: str,
    photons: Photons,
    i: int,
    members: Members,
    moments: Moments,
    slopes: Doubles,
    ramp: tuple[float, float],
) -> Hold:
    """Ask one descriptor about one photon."""
    if descriptor == "pca":
        return hold_by_pca(moments, ramp)
    if descriptor == "tensor":
        return hold_by_tensor(i, members, slopes, moments, ramp)
    if descriptor == "split":
        return hold_by_split(photons, i, members, moments, ramp)
    if descriptor == "gradient":
        return hold_by_gradient(moments, ramp)
    raise ValueError(descriptor)


def build_basis(across: Doubles | None, moments: Moments, normal: Doubles) -> Doubles:
    """u_b = v_b × n and v_b, (2, 3); v_b looks up the gradient."""
    v = moments.axes[0] if across is None else across
    if v @ moments.mean < 0.0:
        v = -v
    return np.stack([np.cross(v, normal), v])


@dataclass(frozen=True)
class Beta:
    """β, t_β, and the isotropy of every photon, NaN where unset or alone, (n,)."""

    beta: float
    clipped: float
    isotropy: Doubles


def optimal_beta(photons: Photons, k: int = 100, clip: float = 0.05) -> Beta:
    """Choose β from the shape, in the world, of what is near in parameter space: METHODS section 4."""
    isotropy = np.full(len(photons.positions), np.nan)
    is_set = photons.is_set
    for i in np.flatnonzero(is_set):
        others = is_set & (photons.emitter == photons.emitter[i])
        others[i] = False
        ids = np.flatnonzero(others)
        apart = measure_parameters(photons.parameters[ids], photons.parameters[i], photons.periods)
        members = choose_members(ids, apart**2, k)
        if members.places > 0:
            isotropy[i] = compute_isotropy(compute_moments(photons, int(i), members).covariance)
    clipped = float(np.nanquantile(isotropy, clip))
    return Beta(float(np.sqrt(1.0 / clipped)), clipped, isotropy)
