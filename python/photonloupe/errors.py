# SPDX-License-Identifier: Apache-2.0
"""The exceptions users can catch: every message says what, where and what to do."""

from __future__ import annotations

from collections.abc import Sequence

from photonloupe._engine import ArgumentError, Cancelled, DeviceError, DeviceMemoryError, PhotonLoupeError, SceneError

__all__ = [
    "ArgumentError",
    "Cancelled",
    "DeviceError",
    "DeviceMemoryError",
    "FileFormatError",
    "PhotonLoupeError",
    "SceneError",
    "ScriptError",
]


class FileFormatError(PhotonLoupeError, OSError):
    """A file is missing, damaged or not what its name says."""


class ScriptError(PhotonLoupeError):
    """A script does not check or failed while running.

    Parameters
    ----------
    message
        The first diagnostic as one sentence.
    diagnostics
        Every diagnostic, in the order of the source.
    """

    def __init__(self, message: str, diagnostics: Sequence[object] = ()) -> None:
        super().__init__(message)
        self.diagnostics = list(diagnostics)
