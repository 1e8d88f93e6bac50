# SPDX-License-Identifier: Apache-2.0
"""Parameter spaces that somebody could invent: many columns, one, discrete, degenerate, heavy-tailed, half unset."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl

Doubles = NDArray[np.float64]
Random = np.random.Generator

# Columns that are independent of each other: a vec4 more or less, and the most.
WIDTHS = (1, 2, 3, 4, 6, 13)
# A direction needs somewhere to come from; the ring's lamp (scenes/ring), or near enough for other scenes.
LAMP = np.array([0.0, 1.6, 2.0])
CLUSTERS, CLUSTER_SIZE = 100, 1e-4
SEED = 17


@dataclass(frozen=True)
class OddParameters:
    """What `PhotonMap.set_parameters` takes: values (n, m), m names, m flags, and bounds (m, 2) where one repeats."""

    values: Doubles
    names: tuple[str, ...]
    periodic: tuple[bool, ...]
    bounds: tuple[tuple[float, float], ...] | None = None

    def set_on(self, photons: pl.PhotonMap) -> None:
        """Give them to a map."""
        photons.set_parameters(self.values, self.names, self.bounds, self.periodic)


def name_columns(values: Doubles) -> OddParameters:
    """Columns q1, q2 … that do not repeat."""
    width = values.shape[1]
    return OddParameters(values, tuple(f"q{i + 1}" for i in range(width)), (False,) * width)


def read_places(photons: pl.PhotonMap) -> Doubles:
    """Where the photons lie, in units of the root of their mean squared distance from the middle, (n, 3)."""
    places = photons.positions.astype(np.float64)
    places -= places.mean(axis=0)
    return places / max(float(np.sqrt(np.mean(np.sum(places**2, axis=1)))), 1e-30)


def make_uniform(width: int) -> Callable[[pl.PhotonMap, Random], Doubles]:
    """So many columns of independent noise."""
    return lambda photons, random: random.random((len(photons), width))


def make_scalar(photons: pl.PhotonMap, _: Random) -> Doubles:
    """One number: how far from the middle."""
    return np.linalg.norm(read_places(photons), axis=1)[:, None]


def make_signature(photons: pl.PhotonMap, random: Random) -> Doubles:
    """Whole numbers of few digits, some rare."""
    return random.choice([1.0, 4.0, 8.0, 13.0, 80.0], (len(photons), 1), p=[0.6, 0.25, 0.1, 0.049, 0.001])


def make_constant(photons: pl.PhotonMap, _: Random) -> Doubles:
    """Says nothing."""
    return np.full((len(photons), 2), 0.7)


def make_one_column(photons: pl.PhotonMap, random: Random) -> Doubles:
    """Four columns of which only the third says something."""
    values = np.full((len(photons), 4), -3.0)
    values[:, 2] = random.random(len(photons))
    return values


def make_ties(photons: pl.PhotonMap, _: Random) -> Doubles:
    """Rounded to eighths."""
    return np.round(read_places(photons) * 8.0) / 8.0


def make_heavy_tails(photons: pl.PhotonMap, random: Random) -> Doubles:
    """Cauchy: a few are 10,000 times as far out as most."""
    return random.standard_cauchy((len(photons), 3))


def make_mixed_scales(photons: pl.PhotonMap, random: Random) -> Doubles:
    """Thousandths beside thousands."""
    return random.random((len(photons), 3)) * [1e-3, 1.0, 1e3]


def make_clusters(photons: pl.PhotonMap, random: Random) -> Doubles:
    """A hundred specks."""
    middles = random.random((CLUSTERS, 4))[random.integers(0, CLUSTERS, len(photons))]
    return middles + CLUSTER_SIZE * random.normal(size=middles.shape)


def make_half_unset(photons: pl.PhotonMap, random: Random) -> Doubles:
    """Where they lie, but every other photon, by chance, has no place."""
    values = read_places(photons)[:, [0, 2]]
    values[random.random(len(values)) < 0.5] = np.nan
    return values


def make_smooth(photons: pl.PhotonMap, _: Random) -> Doubles:
    """Six smooth functions of two coordinates."""
    x, _, z = read_places(photons).T
    return np.stack([x, z, x * z, np.sin(2.0 * x), np.cos(3.0 * z), np.exp(-(x**2) - z**2)], axis=1)


def make_noisy_direction(photons: pl.PhotonMap, random: Random) -> Doubles:
    """A unit vector toward the lamp and two columns of noise."""
    toward = LAMP - photons.positions
    toward /= np.linalg.norm(toward, axis=1, keepdims=True)
    return np.concatenate([toward, 0.1 * random.normal(size=(len(toward), 2))], axis=1)


def make_normal(photons: pl.PhotonMap, random: Random) -> Doubles:
    """Six columns of noise that knows no borders."""
    return random.normal(size=(len(photons), 6))


def make_periodic(photons: pl.PhotonMap, random: Random) -> OddParameters:
    """Azimuth in turns, a random phase, both repeating at 1, and the distance from the middle."""
    x, _, z = read_places(photons).T
    turns = np.mod(np.arctan2(z, x) / (2.0 * np.pi), 1.0)
    values = np.stack([turns, random.random(len(photons)), np.hypot(x, z)], axis=1)
    bounds = ((0.0, 1.0), (0.0, 1.0), (0.0, float(values[:, 2].max())))
    return OddParameters(values, ("azimuth", "phase", "away"), (True, True, False), bounds)


MAKERS: dict[str, Callable[[pl.PhotonMap, Random], Doubles | OddParameters]] = {
    **{f"uniform {width}": make_uniform(width) for width in WIDTHS},
    "scalar": make_scalar,
    "signature": make_signature,
    "constant": make_constant,
    "one column": make_one_column,
    "ties": make_ties,
    "heavy tails": make_heavy_tails,
    "mixed scales": make_mixed_scales,
    "clusters": make_clusters,
    "half unset": make_half_unset,
    "periodic": make_periodic,
    "smooth 6": make_smooth,
    "noisy direction": make_noisy_direction,
    "normal 6": make_normal,
}


def make_parameters(name: str, photons: pl.PhotonMap) -> OddParameters:
    """One of `MAKERS` for a map; the same photons get the same."""
    made = MAKERS[name](photons, np.random.default_rng(SEED))
    return made if isinstance(made, OddParameters) else name_columns(made)
