# SPDX-License-Identifier: Apache-2.0
"""The ways to relax that the error benchmark compares: those of METHODS section 7, and variants of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

Keywords = Mapping[str, Any]

# Sobol emission starts from less noise: fewer steps smooth it, more only blur.
USUAL_STEPS = {"random": 20, "sobol": 5}


@dataclass(frozen=True)
class Method:
    """A name, the keywords of `PhotonMap.relax`, and the number of steps with each emission it is tried on."""

    name: str
    keywords: Keywords
    steps: Mapping[str, int] = field(default_factory=lambda: USUAL_STEPS)


def build_keywords(constraint: str, descriptor: str, neighbors: int, **more: Any) -> dict[str, Any]:
    """Keywords of `relax` without over-relaxation."""
    common = {"constraint": constraint, "descriptor": descriptor, "neighbors": neighbors}
    return {**common, "over_relaxation": (1.0, 1.0), **more}


UNCONSTRAINED = {"constraint": "world", "descriptor": "none", "neighbors": 6}
WORLD_PCA = {"constraint": "world", "descriptor": "pca", "neighbors": 6}
PARAMETER_TENSOR = build_keywords("parameter", "tensor", 20, beta=10.0)

METHODS = (
    Method("unconstrained", UNCONSTRAINED),
    Method("world pca, SJ09 step", WORLD_PCA),
    Method("world tensor, K = 20, λ = 1", build_keywords("world", "tensor", 20)),
    Method("parameter pca, β = 3, K = 6, λ = 1", build_keywords("parameter", "pca", 6, beta=3.0)),
    Method("parameter tensor, β = 10, K = 20, λ = 1", PARAMETER_TENSOR),
)

VARIANTS = (
    Method("unconstrained", UNCONSTRAINED, {"sobol": 20}),
    Method("world pca, K = 20, λ = 1", build_keywords("world", "pca", 20)),
    Method("parameter pca, β = 3, K = 20, λ = 1", build_keywords("parameter", "pca", 20, beta=3.0)),
    Method("parameter tensor, β = 3, K = 6, λ = 1", build_keywords("parameter", "tensor", 6, beta=3.0)),
    Method("parameter tensor, β = 3, K = 20, λ = 1", build_keywords("parameter", "tensor", 20, beta=3.0)),
    Method("parameter tensor, β = 10, K = 20, λ = 1", PARAMETER_TENSOR, {"random": 10, "sobol": 10}),
    Method(
        "parameter tensor, β = 10, K = 20, λ = 1, thresholds 0.5 and 2",
        {**PARAMETER_TENSOR, "thresholds": (0.5, 2.0)},
        {"random": 20, "sobol": 20},
    ),
    Method("parameter tensor, β = 10, K = 20, λ = 1, repelled alike", {**PARAMETER_TENSOR, "repel": "parameter"}),
)
