# SPDX-License-Identifier: Apache-2.0
"""Photon relaxation: constraints that say which way photons may move, and the steps that move them."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from typing import Any, Generic, TypeVar, Unpack

from photonloupe import _engine
from photonloupe.device_photons import DevicePhotons
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.scene import Scene
from photonloupe.setting_keywords import AllRelaxKeywords
from photonloupe.settings import check_settings, takes_settings

LOG = logging.getLogger("photonloupe")

# What is relaxed: a photon map, which relaxing gives back.
PhotonsT = TypeVar("PhotonsT", bound=DevicePhotons)


class Relaxation(Generic[PhotonsT]):
    """A relaxation that is stepped by hand.

    Making one measures the constraint; `step` moves the photons once. Keywords are those of `PhotonMap.relax`.

    Parameters
    ----------
    photons
        The map to relax; it stays as it is.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> spots = np.random.default_rng(0).random((500, 3)) * [1, 0, 1]
    >>> photons = pl.PhotonMap.from_arrays(positions=spots, normals=[[0, 1, 0]] * 500, power=np.ones((500, 3)))
    >>> relaxation = pl.Relaxation(photons, steps=3, descriptor="none")
    >>> relaxation.step()["step"], relaxation.step()["step"], relaxation.step_count
    (0, 1, 2)
    >>> len(relaxation.photons)
    500
    """

    @takes_settings("relax")
    def __init__(
        self, photons: PhotonsT, *, progress: ProgressLike = None, **settings: Unpack[AllRelaxKeywords]
    ) -> None:
        self._source = photons
        checked = check_settings("relax", settings)
        self._rows: list[dict[str, Any]] = []
        self._scene = _find_surface(photons, checked)
        with follow_progress(progress) as callback:
            self._native = _engine.start_relaxation(
                photons.device._native, photons._native, _take_native(self._scene), checked, callback
            )
        self._settings = dict(self._native.settings)
        _warn(self.notes)

    def __repr__(self) -> str:
        told = self._settings
        return (
            f"<Relaxation of {len(self._source):,} photons: step {self.step_count} of {self.steps}, "
            f"{told['neighbors']} neighbors, {told['descriptor']} in {told['constraint']} space>"
        )

    @property
    def settings(self) -> dict[str, Any]:
        """All settings, those that nothing was said of filled in."""
        return dict(self._settings)

    @property
    def notes(self) -> list[str]:
        """What makes the parameters useless here, with the cure; the relaxation goes on as in world space."""
        return list(self._native.notes)

    @property
    def steps(self) -> int:
        """Number of steps the relaxation was planned for; over-relaxation fades over them."""
        return int(self._settings["steps"])

    @property
    def step_count(self) -> int:
        """Number of steps made."""
        return len(self._rows)

    def step(self, *, progress: ProgressLike = None) -> dict[str, Any]:
        """Move all photons once.

        Returns
        -------
        dict
            ``step`` from 0, ``tau`` (METHODS eq. 2), ``mean_move`` and ``largest_move`` (|move|/r), ``mean_pressure``
            (|f'|/r), ``mean_displacement`` (m), ``flux_drift`` (relative, before the total was restored).
        """
        with follow_progress(progress) as callback:
            row = dict(self._native.step(callback))
        self._rows.append(row)
        return row

    @property
    def report(self) -> dict[str, Any]:
        """Settings, one row per step, and where photons move: on their surface, or in tangent planes."""
        told = {"settings": self.settings, "steps": self._rows, "notes": self.notes}
        return describe_relaxation({**told, "off_surface": self._native.off_surface}, self._scene)

    @property
    def photons(self) -> PhotonsT:
        """The map as it is now, with constraint, drift and pressure."""
        return self._source.replace(self._native.read(), self.report)


def relax_photons(photons: PhotonsT, progress: ProgressLike, **settings: Unpack[AllRelaxKeywords]) -> PhotonsT:
    """Run a whole relaxation; see `PhotonMap.relax`."""
    checked = check_settings("relax", settings)
    scene = _find_surface(photons, checked)
    with follow_progress(progress) as callback:
        native, told = _engine.relax_photons(
            photons.device._native, photons._native, _take_native(scene), checked, callback
        )
    _warn(told["notes"])
    return photons.replace(native, describe_relaxation(told, scene))


def describe_relaxation(told: Mapping[str, Any], scene: Scene | None) -> dict[str, Any]:
    """Say what a relaxation was, did and met."""
    return {
        "settings": dict(told["settings"]),
        "steps": [dict(row) for row in told["steps"]],
        "surface": "tangent planes" if scene is None else str(scene.path),
        "notes": list(told["notes"]),
        "off_surface": int(told["off_surface"]),
    }


def _find_surface(photons: DevicePhotons, settings: Mapping[str, Any]) -> Scene | None:
    return photons.find_surface() if settings["surface"] == "auto" else None


def _take_native(scene: Scene | None) -> _engine.Scene | None:
    return None if scene is None else scene._native


def _warn(notes: Sequence[str]) -> None:
    for note in notes:
        LOG.warning(note)
