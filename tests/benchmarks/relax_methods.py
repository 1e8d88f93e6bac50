# SPDX-License-Identifier: Apache-2.0
"""The ways to relax that the error benchmark compares: those of METHODS section 7, and variants of them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

EMISSIONS = ("random", "sobol")
SOBOL_THRESHOLDS = (0.5, 2.0)  # METHODS section 7: for the lower noise floor
# Sobol emission starts from less noise: fewer steps smooth it, more only blur.
USUAL_STEPS = {"random": 20, "sobol": 5}


@dataclass(frozen=True)
class Method:
    """A name, the keywords of `PhotonMap.relax` but for the steps, those, and if it is tried on larger maps."""

    name: str
    keywords: dict[str, Any]
    steps: int
    is_main: bool = False


def build_keywords(constraint: str, descriptor: str, neighbors: int, **more: Any) -> dict[str, Any]:
    """Keywords of `relax` without over-relaxation."""
    common = {"constraint": constraint, "descriptor": descriptor, "neighbors": neighbors}
    return {**common, "over_relaxation": (1.0, 1.0), **more}


UNCONSTRAINED = {"constraint": "world", "descriptor": "none", "neighbors": 6, "over_relaxation": (2.0, 1.2)}
UNCONSTRAINED_WIDE = build_keywords("world", "none", 20)
WORLD_PCA = {**UNCONSTRAINED, "descriptor": "pca"}
WORLD_PCA_WIDE = build_keywords("world", "pca", 20)
WORLD_TENSOR = build_keywords("world", "tensor", 20)
WORLD_SPLIT = build_keywords("world", "split", 20)
LAYER_PCA = build_keywords("parameter", "pca", 6, beta=3.0)
LAYER_TENSOR = build_keywords("parameter", "tensor", 20, beta=10.0)
ALIKE = {"repel": "parameter"}


def list_methods(emission: str) -> list[Method]:
    """All ways that are tried with an emission; those of `is_main` first."""
    usual = USUAL_STEPS[emission]
    methods = [
        Method("none, K = 6, λ 2 to 1.2", UNCONSTRAINED, usual, is_main=True),
        Method("world pca, K = 6, λ 2 to 1.2", WORLD_PCA, usual, is_main=True),
        Method("world tensor, K = 20", WORLD_TENSOR, usual, is_main=True),
        Method("parameter pca, β = 3, K = 6", LAYER_PCA, usual, is_main=True),
        Method("parameter tensor, β = 10, K = 20", LAYER_TENSOR, usual, is_main=True),
        Method("parameter tensor, β = 10, K = 20, repel parameter", {**LAYER_TENSOR, **ALIKE}, usual, is_main=True),
        Method("none, K = 6, λ 2 to 1.2", UNCONSTRAINED, 25 - usual),
        Method("none, K = 20", UNCONSTRAINED_WIDE, usual),
        Method("world pca, K = 20", WORLD_PCA_WIDE, usual),
        Method("world split, K = 20", WORLD_SPLIT, usual),
        Method("world tensor, K = 20", WORLD_TENSOR, 25 - usual),
        Method("parameter pca, β = 3, K = 6, repel parameter", {**LAYER_PCA, **ALIKE}, usual),
        Method("parameter pca, β = auto, K = 6", {**LAYER_PCA, "beta": "auto"}, usual),
        Method("parameter tensor, β = 10, K = 20", LAYER_TENSOR, 25 - usual),
        Method("parameter tensor, β = auto, K = 20", {**LAYER_TENSOR, "beta": "auto"}, usual),
    ]
    if emission == "sobol":
        narrow = {"thresholds": SOBOL_THRESHOLDS}
        methods += [
            Method("world tensor, K = 20, thresholds 0.5, 2", {**WORLD_TENSOR, **narrow}, 20),
            Method("parameter tensor, β = 10, K = 20, thresholds 0.5, 2", {**LAYER_TENSOR, **narrow}, 20, is_main=True),
            Method(
                "parameter tensor, β = 10, K = 20, thresholds 0.5, 2, repel parameter",
                {**LAYER_TENSOR, **narrow, **ALIKE},
                20,
            ),
            Method("parameter pca, β = 10, K = 20", build_keywords("parameter", "pca", 20, beta=10.0), usual),
        ]
    return methods
