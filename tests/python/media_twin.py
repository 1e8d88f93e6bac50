# SPDX-License-Identifier: Apache-2.0
"""Media without the engine: materials for tests, a slab by NumPy, an infinite medium by its closed forms."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from gltf import make_glass

Doubles = NDArray[np.float64]


def make_medium(
    scattering: tuple[float, ...],
    absorption: tuple[float, ...] = (0.0, 0.0, 0.0),
    anisotropy: float = 0.0,
    ior: float = 1.0,
) -> dict[str, Any]:
    """Coefficients in 1/m."""
    material = make_glass("medium", ior, 1.0)
    material["extensions"]["KHR_materials_volume"] |= {
        "attenuationColor": [float(np.exp(-a)) for a in absorption],
        "attenuationDistance": 1.0,
    }
    material["extras"] = {"photonloupe": {"scattering": list(scattering), "anisotropy": anisotropy}}
    return material


def find_phase(cosine: Doubles, g: float) -> Doubles:
    """Henyey and Greenstein's, per steradian."""
    return (1.0 - g**2) / (4.0 * np.pi * (1.0 + g**2 - 2.0 * g * cosine) ** 1.5)


def scatter_cosine(g: float, u: Doubles) -> Doubles:
    if g == 0.0:
        return 2.0 * u - 1.0
    return (1.0 + g**2 - ((1.0 - g**2) / (1.0 - g + 2.0 * g * u)) ** 2) / (2.0 * g)


def reflect_fresnel(cosine: Doubles, ratio: float) -> Doubles:
    """Unpolarized; `ratio` is the index here over that beyond."""
    sine2 = ratio**2 * (1.0 - cosine**2)
    beyond = np.sqrt(np.maximum(0.0, 1.0 - sine2))
    parallel = (cosine - ratio * beyond) / (cosine + ratio * beyond)
    across = (ratio * cosine - beyond) / (ratio * cosine + beyond)
    return np.where(sine2 >= 1.0, 1.0, 0.5 * (parallel**2 + across**2))


def pass_slab(
    count: int, depth: float, albedo: float, g: float, ior: float = 1.0, seed: int = 0
) -> tuple[float, float, float]:
    """Shares of light that arrives straight: reflected, transmitted, absorbed; `depth` in mean free paths."""
    rng = np.random.default_rng(seed)
    surface = float(reflect_fresnel(np.array(1.0), 1.0 / ior))
    weight, z, cosine = np.full(count, 1.0 - surface), np.zeros(count), np.ones(count)
    reflected, transmitted, absorbed = surface * count, 0.0, 0.0
    while len(weight):
        z = z + cosine * rng.exponential(size=len(z))
        outside = (z < 0.0) | (z > depth)
        while outside.any():
            kept = reflect_fresnel(np.abs(cosine[outside]), ior)
            leaving = weight[outside] * (1.0 - kept)
            is_back = z[outside] > depth
            transmitted += float(leaving[is_back].sum())
            reflected += float(leaving[~is_back].sum())
            weight[outside] *= kept
            z[outside] = np.where(is_back, 2.0 * depth - z[outside], -z[outside])
            cosine[outside] *= -1.0
            outside = ((z < 0.0) | (z > depth)) & (weight > 0.0)
        weight = np.where((z < 0.0) | (z > depth), 0.0, weight)
        absorbed += float(weight.sum()) * (1.0 - albedo)
        weight = weight * albedo
        # Roulette keeps the sum in the mean.
        lives = rng.random(len(weight)) < np.minimum(1.0, weight / 0.1)
        weight, z, cosine = np.maximum(weight, 0.1)[lives], z[lives], cosine[lives]
        turned = scatter_cosine(g, rng.random(len(weight)))
        sines = np.sqrt(np.maximum(0.0, (1.0 - cosine**2) * (1.0 - turned**2)))
        cosine = np.clip(cosine * turned + sines * np.cos(2.0 * np.pi * rng.random(len(weight))), -1.0, 1.0)
    return reflected / count, transmitted / count, absorbed / count


def find_point_fluence(radius: float, albedo: float) -> float:
    """Fluence of a source of 1 W in an infinite medium that scatters evenly, extinction 1/m, W/m².

    The transform of the fluence is A/(1 - cA) with A = atan(k)/k (Case and Zweifel 1967); of that A is what was never
    scattered, whose closed form is known.
    """
    from scipy.integrate import quad  # noqa: PLC0415 - only these tests need SciPy

    def transform(k: float) -> float:
        a = np.arctan(k) / k if k > 1e-8 else 1.0
        return k * albedo * a * a / (1.0 - albedo * a)

    limit = 400.0
    inner = quad(transform, 0.0, limit, weight="sin", wvar=radius, limit=4000)[0]
    outer = quad(transform, limit, np.inf, weight="sin", wvar=radius, limlst=500)[0]
    return float(np.exp(-radius) / (4.0 * np.pi * radius**2) + (inner + outer) / (2.0 * np.pi**2 * radius))
