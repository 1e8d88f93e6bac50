# SPDX-License-Identifier: Apache-2.0
"""Compute devices: which there are, and which one the work runs on."""

from __future__ import annotations

from functools import lru_cache
from typing import Any

from photonloupe import _engine
from photonloupe.errors import ArgumentError


class Device:
    """One Vulkan device, opened.

    Parameters
    ----------
    selector
        ``"auto"`` (first discrete GPU, else integrated, else software), an index of `devices`,
        or part of a device's name.

    Raises
    ------
    DeviceError
        If there is no Vulkan loader, or no usable device fits; the message lists those found.

    Examples
    --------
    >>> import photonloupe as pl
    >>> device = pl.Device("auto")
    >>> device.info["name"]  # doctest: +SKIP
    'llvmpipe (LLVM 15.0.6, 256 bits)'
    """

    def __init__(self, selector: int | str = "auto") -> None:
        if isinstance(selector, bool) or not isinstance(selector, int | str):
            raise ArgumentError(f"a device is chosen by 'auto', an index or part of a name, not {selector!r}")
        self._native = _engine.Device(str(selector))

    @property
    def info(self) -> dict[str, Any]:
        """Index, name, type, driver, api_version, memory (bytes) and why it was chosen."""
        return dict(self._native.info)

    def self_test(self) -> dict[str, Any]:
        """Run one small dispatch and check its result: ``{"ok": bool, "milliseconds": float, …}``."""
        return dict(self._native.self_test())

    def forget_results(self) -> None:
        """Let every stage run again, also one that is asked what it was asked before: for measuring."""
        self._native.forget()

    def timings(self) -> list[dict[str, Any]]:
        """Time per stage since the last call: stage, milliseconds, dispatches."""
        return [dict(row) for row in self._native.timings()]

    def __repr__(self) -> str:
        info = self.info
        return f"<Device {info.get('index')}: {info.get('name')} ({info.get('type')})>"


def devices() -> list[dict[str, Any]]:
    """Describe every Vulkan device of this machine.

    Returns
    -------
    list of dict
        index, name, type, driver, api_version, memory (bytes), usable, reason (why not).

    Raises
    ------
    DeviceError
        If there is no Vulkan loader.
    """
    return [dict(row) for row in _engine.list_devices()]


@lru_cache(maxsize=8)
def _open_device(selector: str) -> Device:
    return Device(selector)


def open_device(device: Device | int | str | None = None) -> Device:
    """Return `device` itself, or the shared device that a name, an index or None (``"auto"``) stands for."""
    if isinstance(device, Device):
        return device
    if device is not None and (isinstance(device, bool) or not isinstance(device, int | str)):
        raise ArgumentError(f"device must be a Device, 'auto', an index or part of a name, not {device!r}")
    return _open_device("auto" if device is None else str(device))
