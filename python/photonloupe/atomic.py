# SPDX-License-Identifier: Apache-2.0
"""Puts a finished folder in the place of an old one, so that a killed program leaves one of them whole."""

from __future__ import annotations

import ctypes
import os
import secrets
import shutil
import socket
from pathlib import Path

_AT_FDCWD = -100  # linux/fcntl.h
_RENAME_EXCHANGE = 2  # linux/fs.h
_MARK = ".writing"


def make_sibling(target: Path) -> Path:
    """Make an empty folder beside `target` that `replace_folder` can later put in its place.

    What killed programs left there before is cleared away.
    """
    _clear_leftovers(target)
    owner = f"{socket.gethostname()}-{os.getpid()}-{secrets.token_hex(4)}"
    sibling = target.with_name(f".{target.name}.{owner}{_MARK}")
    sibling.mkdir()
    return sibling


def replace_folder(finished: Path, target: Path) -> None:
    """Put `finished` where `target` is, in one step of the file system, and remove what was there."""
    _flush(finished)
    if not target.exists():
        finished.rename(target)
    elif _exchange(finished, target):
        shutil.rmtree(finished)
    else:
        # File systems without an exchange: the old one steps aside first, and `find_whole` still finds it.
        aside = _get_aside(target)
        target.rename(aside)
        finished.rename(target)
        shutil.rmtree(aside)
    _flush_entry(target.parent)


def find_whole(target: Path) -> Path:
    """Return `target`, or the old version that had stepped aside when its writer was killed."""
    aside = _get_aside(target)
    return aside if not target.exists() and aside.exists() else target


def _get_aside(target: Path) -> Path:
    return target.with_name(f".{target.name}.old")


def _clear_leftovers(target: Path) -> None:
    """Remove half-written siblings whose writer, on this machine, no longer runs."""
    host = socket.gethostname()
    for leftover in target.parent.glob(f".{target.name}.{host}-*{_MARK}"):
        pid = leftover.name.removesuffix(_MARK).split("-")[-2]
        if pid.isdigit() and not Path(f"/proc/{pid}").exists():
            shutil.rmtree(leftover, ignore_errors=True)


def _exchange(a: Path, b: Path) -> bool:
    """Swap two paths atomically; False where the system cannot."""
    rename = getattr(ctypes.CDLL(None, use_errno=True), "renameat2", None)
    if rename is None:
        return False
    return rename(_AT_FDCWD, os.fsencode(a), _AT_FDCWD, os.fsencode(b), _RENAME_EXCHANGE) == 0


def _flush(folder: Path) -> None:
    """Write a folder's files through to the disk, so that a power failure finds them whole too."""
    for parent, _, names in os.walk(folder):
        for name in names:
            _flush_entry(Path(parent, name))
        _flush_entry(Path(parent))


def _flush_entry(path: Path) -> None:
    handle = os.open(path, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
