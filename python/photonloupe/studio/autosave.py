# SPDX-License-Identifier: Apache-2.0
"""Sessions saved aside while a window is open, and found again after a crash."""

from __future__ import annotations

import os
import time
from pathlib import Path

from photonloupe import _engine

_SECONDS = 20.0
_PREFIX = "autosave-"


class Autosave:
    """Saves the session of this process aside when its state changed.

    Parameters
    ----------
    native
        The interface.
    folder
        Where; default the per-user cache. None of the file system's refusals is an error: it is a safety net.
    """

    def __init__(self, native: _engine.Studio, folder: Path | None = None) -> None:
        self._native = native
        cache = _engine.find_cache_folder()
        self._folder = folder or (Path(cache) / "sessions" if cache else None)
        self._saved = ""
        self._next = time.monotonic() + _SECONDS

    @property
    def path(self) -> Path | None:
        """The file of this process; None where there is no cache folder."""
        return None if self._folder is None else self._folder / f"{_PREFIX}{os.getpid()}.loupe"

    def find_left(self) -> Path | None:
        """Return the latest session of a process that is no longer there, if any."""
        if self._folder is None or not self._folder.is_dir():
            return None
        left = [path for path in self._folder.glob(f"{_PREFIX}*.loupe") if not _is_running(path)]
        return max(left, key=lambda path: path.stat().st_mtime, default=None)

    def save_when_due(self) -> None:
        """Save, if the state changed and the last time is long enough ago."""
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + _SECONDS
            self.save()

    def save(self) -> None:
        """Save now, if the state changed."""
        state = self._native.state()
        if self.path is None or state == self._saved:
            return
        try:
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._native.save_session(str(self.path))
            self._saved = state
        except (OSError, _engine.PhotonLoupeError):
            self._native.say("the session cannot be saved aside; save it by hand", True)

    def clear(self) -> None:
        """Remove this process's file: the program ended as it should."""
        if self.path is not None:
            self.path.unlink(missing_ok=True)


def _is_running(path: Path) -> bool:
    number = path.stem.removeprefix(_PREFIX)
    return number.isdigit() and Path(f"/proc/{number}").exists()
