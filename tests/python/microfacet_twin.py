# SPDX-License-Identifier: Apache-2.0
"""Rough surfaces from the textbook in double precision: GGX with height-correlated Smith shadowing.

Walter et al. 2007, Heitz 2014. The normal is +y; `arriving` points away from the surface, on its side.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Doubles = NDArray[np.float64]


def reflect_fresnel(cosine: Doubles, ratio: float) -> Doubles:
    """Unpolarized reflectance; `ratio` is the index here over that beyond."""
    inside = 1.0 - ratio**2 * (1.0 - cosine**2)
    beyond = np.sqrt(np.maximum(inside, 0.0))
    cosine = np.maximum(cosine, 1e-12)
    parallel = (cosine - ratio * beyond) / (cosine + ratio * beyond)
    perpendicular = (ratio * cosine - beyond) / (ratio * cosine + beyond)
    return np.where(inside <= 0.0, 1.0, 0.5 * (parallel**2 + perpendicular**2))


def find_facet_density(m: Doubles, alpha: float) -> Doubles:
    tangent2 = (m[..., 0] ** 2 + m[..., 2] ** 2) / m[..., 1] ** 2
    return 1.0 / (np.pi * alpha**2 * m[..., 1] ** 4 * (1.0 + tangent2 / alpha**2) ** 2)


def find_hidden(w: Doubles, alpha: float) -> Doubles:
    tangent2 = (w[..., 0] ** 2 + w[..., 2] ** 2) / w[..., 1] ** 2
    return 0.5 * (np.sqrt(1.0 + alpha**2 * tangent2) - 1.0)


def normalize(v: Doubles) -> Doubles:
    return v / np.linalg.norm(v, axis=-1, keepdims=True)


def reflect_rough(arriving: Doubles, leaving: Doubles, roughness: float) -> Doubles:
    """Share of the arriving light per steradian off facets that reflect all, f·cos; zero below the surface."""
    alpha = roughness**2
    m = normalize(arriving + leaving)
    shadowing = 1.0 / (1.0 + find_hidden(arriving, alpha) + find_hidden(leaving, alpha))
    value = find_facet_density(m, alpha) * shadowing / (4.0 * arriving[1])
    return np.where(leaving[..., 1] > 0.0, value, 0.0)


def scatter_glass(arriving: Doubles, leaving: Doubles, roughness: float, ratio: float) -> Doubles:
    """The same of a dielectric, reflected above and refracted below, as flux (no solid-angle factor of radiance)."""
    alpha = roughness**2
    above = leaving[..., 1] > 0.0
    m = np.where(above[..., None], arriving + leaving, ratio * arriving + leaving)
    m = normalize(m)
    m = np.where(m[..., 1:2] < 0.0, -m, m)
    here, there = m @ arriving, np.sum(m * leaving, axis=-1)
    reflectance = reflect_fresnel(np.maximum(here, 0.0), ratio)
    shadowing = 1.0 / (1.0 + find_hidden(arriving, alpha) + find_hidden(leaving, alpha))
    common = find_facet_density(m, alpha) * shadowing * here / arriving[1]
    reflected = common * reflectance / (4.0 * here)
    refracted = common * (1.0 - reflectance) * np.abs(there) / (ratio * here + there) ** 2
    value = np.where(above, reflected, np.where(there < 0.0, refracted, 0.0))
    return np.where(here > 0.0, value, 0.0)


def scatter_thin(arriving: Doubles, leaving: Doubles, roughness: float, ior: float) -> Doubles:
    """Of a thin sheet: both faces at once, what passes is the reflection's mirror image."""
    image = leaving * np.where(leaving[..., 1:2] < 0.0, [[1.0, -1.0, 1.0]], 1.0)
    once = reflect_fresnel(normalize(arriving + image) @ arriving, 1.0 / ior)
    reflectance = 2.0 * once / (1.0 + once)
    return reflect_rough(arriving, image, roughness) * np.where(leaving[..., 1] > 0.0, reflectance, 1.0 - reflectance)
