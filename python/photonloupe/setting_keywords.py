# SPDX-License-Identifier: Apache-2.0
"""Types of the stages' keywords, written by tests/python/manual_tables.py from the engine's tables."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypedDict


class TraceKeywords(TypedDict, total=False):
    """`engine/*/settings.h` says what each means."""

    emitted: int | str | None
    seed: int | None
    emission: str | None
    store: str | None
    max_bounces: int | None


class RelaxKeywords(TypedDict, total=False):
    """`engine/*/settings.h` says what each means."""

    constraint: str | None
    descriptor: str | None
    beta: float | str | None
    repel: str | None
    over_relaxation: Sequence[float] | float | None
    limit: float | str | None
    constraint_neighbors: int | str | None
    thresholds: Sequence[float] | str | None
    diffuse_flux: bool | None
    search: str | None
    surface: str | None
    period: Sequence[float] | None


class AllRelaxKeywords(RelaxKeywords, total=False):
    """`engine/*/settings.h` says what each means."""

    steps: int | str | None
    neighbors: int | None


class IrradianceKeywords(TypedDict, total=False):
    """`engine/*/settings.h` says what each means."""

    k: int | str | None
    kernel: str | None


class RenderKeywords(TypedDict, total=False):
    """`engine/*/settings.h` says what each means."""

    width: int | None
    height: int | None
    samples: int | None
    mode: str | None
    k: int | str | None
    kernel: str | None
    max_bounces: int | None
    seed: int | None
