# SPDX-License-Identifier: Apache-2.0
"""Checks of arguments that several functions share; each refusal is one sentence."""

from __future__ import annotations

import math
import operator
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe.errors import ArgumentError


def check_count(name: str, value: Any, low: int, high: int) -> int:
    """Return `value` as an int in [`low`, `high`], or raise `ArgumentError`."""
    try:
        number = operator.index(value)
    except TypeError:
        raise ArgumentError(f"{name} must be a whole number, not {value!r}") from None
    if isinstance(value, bool) or not low <= number <= high:
        raise ArgumentError(f"{name} must be from {low} to {high}, not {value!r}")
    return number


def check_number(name: str, value: Any, low: float, high: float) -> float:
    """Return `value` as a finite float in [`low`, `high`], or raise `ArgumentError`."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} must be a number, not {value!r}") from None
    if not (math.isfinite(number) and low <= number <= high):
        raise ArgumentError(f"{name} must be from {low:g} to {high:g}, not {value!r}")
    return number


def check_choice(name: str, value: Any, choices: Iterable[str]) -> str:
    """Return `value` if it is one of `choices`, or raise `ArgumentError` that names them."""
    known = tuple(choices)
    if value not in known:
        raise ArgumentError(f"{name} must be one of {', '.join(known)}, not {value!r}")
    return str(value)


def check_path(name: str, value: Any) -> Path:
    """Return `value` as a path, or raise `ArgumentError`."""
    try:
        return Path(value)
    except TypeError:
        raise ArgumentError(f"{name} must be the path of a file, not {value!r}") from None


def check_size(size: Sequence[int], low: int, high: int) -> tuple[int, int]:
    """Return width and height in [`low`, `high`], or raise `ArgumentError`."""
    try:
        width, height = size
    except (TypeError, ValueError):
        raise ArgumentError(f"size must be (width, height), not {size!r}") from None
    return check_count("size[0]", width, low, high), check_count("size[1]", height, low, high)


def check_vectors(name: str, values: ArrayLike, width: int = 3) -> NDArray[np.float64]:
    """Return `values` as finite (n, `width`) float64, or raise `ArgumentError` naming the first bad row."""
    try:
        array = np.ascontiguousarray(values, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError(f"{name} must be numbers of shape (n, {width})") from None
    if array.ndim != 2 or array.shape[1] != width:
        raise ArgumentError(f"{name} must have shape (n, {width}), not {array.shape}")
    check_finite(name, array)
    return array


def check_vector(
    name: str, values: Any, low: float = -sys.float_info.max, high: float = sys.float_info.max, width: int = 3
) -> list[float]:
    """Return `width` finite numbers in [`low`, `high`], or raise `ArgumentError`."""
    try:
        numbers = list(values)
    except TypeError:
        numbers = []
    if len(numbers) != width:
        raise ArgumentError(f"{name} must be {'two' if width == 2 else 'three'} numbers, not {values!r}")
    return [check_number(name, number, low, high) for number in numbers]


def check_rows(ids: ArrayLike, count: int) -> NDArray[np.int64]:
    """Return ids of `count` photons, given as a mask or as whole numbers, or raise `ArgumentError`."""
    given = np.asarray(ids)
    if given.ndim != 1:
        raise ArgumentError(f"ids or mask must have shape (n,), not {given.shape}")
    if given.dtype == np.bool_:
        if len(given) != count:
            raise ArgumentError(f"the mask has {len(given)} entries, the map {count} photons")
        return np.flatnonzero(given)
    if given.dtype.kind not in "iu" and len(given):
        raise ArgumentError(f"ids must be whole numbers or a mask, not {given.dtype}")
    outside = (given < 0) | (given >= count)
    if outside.any():
        row = int(np.argmax(outside))
        raise ArgumentError(f"ids[{row}] = {given[row]} is not a photon; they run from 0 to {count - 1}")
    return given.astype(np.int64)


def check_finite(name: str, array: NDArray[Any]) -> None:
    """Raise `ArgumentError` that names the first row of `array` with a NaN or an infinity."""
    finite = np.isfinite(array)
    if finite.all():
        return
    place = np.unravel_index(int(np.argmin(finite)), array.shape)
    row = "".join(f"[{int(i)}]" for i in place)
    kind = "NaN" if np.isnan(array[place]) else "infinite"
    raise ArgumentError(f"{name}{row} is {kind}; remove or replace that row")
