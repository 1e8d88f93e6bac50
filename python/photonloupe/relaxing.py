# SPDX-License-Identifier: Apache-2.0
"""Photon relaxation: constraints that say which way photons may move, and the steps that move them."""

from __future__ import annotations

import logging
from typing import Any, Generic, TypeVar, Unpack

import numpy as np

from photonloupe import _engine
from photonloupe.device import open_device
from photonloupe.device_photons import DevicePhotons
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.relax_settings import complete_settings
from photonloupe.setting_keywords import AllRelaxKeywords
from photonloupe.settings import takes_settings

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
        self._settings = complete_settings(photons, progress, **settings)
        self._rows: list[dict[str, Any]] = []
        self._device = open_device(photons.device)
        self._scene = photons.find_surface() if self._settings["surface"] == "auto" else None
        native_scene = None if self._scene is None else self._scene._native
        with follow_progress(progress) as callback:
            self._native = _engine.start_relaxation(
                self._device._native, photons.upload(), native_scene, self._settings, callback
            )
        for note in self.notes:
            LOG.warning(note)

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
        return self._describe(self._native.read()[2])

    @property
    def photons(self) -> PhotonsT:
        """The map as it is now, with constraint, drift and pressure."""
        native, state, off_surface = self._native.read()
        columns = {name: np.asarray(values) for name, values in state.items()}
        return self._source.replace_positions(native, columns, self._describe(off_surface))

    def _describe(self, off_surface: int) -> dict[str, Any]:
        return {
            "settings": dict(self._settings),
            "steps": [dict(row) for row in self._rows],
            "surface": "tangent planes" if self._scene is None else str(self._scene.path),
            "notes": self.notes,
            "off_surface": int(len(self._source) if self._scene is None else off_surface),
        }


def relax_photons(photons: PhotonsT, progress: ProgressLike, **settings: Unpack[AllRelaxKeywords]) -> PhotonsT:
    """Run a whole relaxation; see `PhotonMap.relax`."""
    relaxation = Relaxation(photons, progress=progress, **settings)
    for _ in range(relaxation.steps):
        relaxation.step(progress=progress)
    return relaxation.photons
