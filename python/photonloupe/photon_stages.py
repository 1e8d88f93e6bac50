# SPDX-License-Identifier: Apache-2.0
"""What can be asked of a photon map and done with it: neighbors, irradiance, scripts, constraints, relaxation."""

from __future__ import annotations

import os
from collections.abc import Mapping
from typing import Any, Self, Unpack

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import queries
from photonloupe.device_photons import DevicePhotons
from photonloupe.nearest import find_neighbors
from photonloupe.photon_columns import Float3
from photonloupe.progress import ProgressLike
from photonloupe.relaxing import relax_photons
from photonloupe.scripting import Script, ScriptRun, run_script
from photonloupe.setting_keywords import IrradianceKeywords, RelaxKeywords
from photonloupe.settings import takes_settings


class PhotonStages(DevicePhotons):
    """The stages of the main flow that begin with photons."""

    @takes_settings("loupe")
    def neighbors(
        self,
        points: ArrayLike,
        k: int,
        *,
        space: str | None = None,
        beta: float | str | None = None,
        center: int | None = None,
        ranges: Mapping[int | str, tuple[float, float]] | None = None,
        progress: ProgressLike = None,
    ) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
        """Find the k nearest photons, nearest first, ties by id.

        Parameters
        ----------
        points
            Points (n, 3) in m, or ids (n,) of photons; a photon is not its own neighbor. In parameter space
            (n, m) values, or ids.
        {settings}
        center
            Constrained space around points: the layer is that of this photon.
        ranges
            Instead: the layer is all photons whose parameters lie within, ``{name or dimension: (low, high)}``,
            dimensions counted from 3; a periodic parameter may run from high over the seam to low.
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

        In the world distances are in m. In parameter space those to an id are to photons of its emitter only. A layer
        is of the same emitter; photons without parameters are one of their own (METHODS section 4).

        Returns
        -------
        ids : (n, k) int32
            Padded with -1 where there are fewer photons.
        distances : (n, k) float32
            In m, or in parameter space, padded with inf.

        Raises
        ------
        ArgumentError
            If a point is not finite, an id is not a photon, k is out of range, or the space lacks what it needs.

        Examples
        --------
        >>> import numpy as np, photonloupe as pl
        >>> line = np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]])
        >>> photons = pl.PhotonMap.from_arrays(positions=line, normals=[[0, 1, 0]] * 3, power=np.ones((3, 3)))
        >>> photons.neighbors([1], 3)[0].tolist()
        [[0, 2, -1]]
        """
        return find_neighbors(self, points, k, space=space, beta=beta, center=center, ranges=ranges, progress=progress)

    @takes_settings("irradiance")
    def irradiance(
        self,
        points: ArrayLike,
        normals: ArrayLike,
        *,
        progress: ProgressLike = None,
        **settings: Unpack[IrradianceKeywords],
    ) -> Float3:
        """Estimate the irradiance from the k nearest photons of the same surface (METHODS section 2).

        Parameters
        ----------
        points, normals
            (n, 3) each: m, directions; one normal (3,) serves all points.
        {settings}
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

        Returns
        -------
        (n, 3) float32
            W/m² per channel; 0 where no photon is accepted.

        Raises
        ------
        ArgumentError
            If a point or normal is not finite, a normal is zero, or k or kernel is not offered.
        """
        return queries.estimate_irradiance(self, points, normals, progress=progress, **settings)

    def fluence(self, points: ArrayLike, *, k: int | None = None, progress: ProgressLike = None) -> Float3:
        """Estimate the fluence inside of media from the k nearest photons there (METHODS section 13).

        Parameters
        ----------
        points
            (n, 3), m.
        k
            How many photons an estimate gathers; default as for `irradiance`.
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

        Returns
        -------
        (n, 3) float32
            W/m² per channel, of light from all sides that the map stores; 0 without photons in media. Near the border
            of a medium the balls reach beyond it, and the estimate is low.

        Raises
        ------
        ArgumentError
            If a point is not finite, k is out of range, or the map knows of no scene.
        """
        return queries.estimate_fluence(self, points, k, progress)

    def run_script(
        self,
        script: str | os.PathLike[str] | Script,
        *,
        values: Mapping[str, Any] | None = None,
        keep: bool = False,
        seed: int = 1,
        limits: Mapping[str, float] | None = None,
        progress: ProgressLike = None,
        **exposed: Any,
    ) -> ScriptRun:
        """Run a photon script: it gives the photons parameters and colors (docs/script.md).

        Parameters
        ----------
        script
            A file, if it is a `Path` or one line that ends in ``.photon``; else the text itself; or what
            `compile_script` made of it.
        values
            Exposed variables by name; as keywords too, where the name is free.
        keep
            Keep the parameters and colors there are, and replace only what the script sets; otherwise all of them go.
        seed
            Of the script's `random`.
        limits
            ``fuel``: steps of loops without a known end a photon may take (1e6), ``exhausted``: photons that may run
            out before a pass stops (1000), ``seconds`` a pass may take (60).
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.
        **exposed
            Exposed variables.

        Returns
        -------
        ScriptRun
            Parameters, colors, histograms, prints, exposed values, report. The map's columns are replaced.

        Raises
        ------
        ScriptError
            With all `diagnostics`; the map is as it was.
        ArgumentError
            If a value is out of its range or not exposed.

        Examples
        --------
        >>> import photonloupe as pl
        >>> photons = pl.trace_photons(pl.load_scene("scenes/ring/ring.gltf"), count=10_000, seed=1)
        >>> run = photons.run_script('''
        ...     declarePhotonParameter(3, 0, 2, "height");
        ...     for (i = 0; i < getNumPhotons(); i++) setPhotonParameter(i, 3, getPhotonPosition(i, Y));
        ... ''')
        >>> run.parameter_names, photons.parameters.shape == (len(photons), 1)
        (('height',), True)
        """
        return run_script(self, script, values, keep=keep, seed=seed, limits=limits, progress=progress, **exposed)

    def constrain(self, *, progress: ProgressLike = None, **settings: Unpack[RelaxKeywords]) -> Self:
        """Measure which way each photon may move, without moving any (METHODS section 5).

        Parameters
        ----------
        **settings
            ``constraint``, ``descriptor``, ``beta``, ``constraint_neighbors``, ``thresholds`` as in `relax`.
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

        Returns
        -------
        PhotonMap
            The same photons with `constraint_basis`, `constraint_weights`, `gradient`, `one_sidedness`.
        """
        return relax_photons(self, progress, **{**settings, "steps": 0})

    @takes_settings("relax")
    def relax(
        self,
        steps: int | None = None,
        neighbors: int | None = None,
        *,
        progress: ProgressLike = None,
        **settings: Unpack[RelaxKeywords],
    ) -> Self:
        """Move the photons apart until the noise is gone, as far as their constraints allow ([SJ09], METHODS 3 to 5).

        With nothing said, the settings with the least error of all measured (docs/relaxation.md).

        Parameters
        ----------
        {settings}
        progress
            True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

        Returns
        -------
        PhotonMap
            A new map with `drift`, `pressure`, the constraint, and the report in `relaxation`.

        Raises
        ------
        ArgumentError
            If a setting is out of its range, or parameters are asked for that the map does not have.

        Examples
        --------
        >>> import photonloupe as pl
        >>> photons = pl.trace_photons(pl.load_scene("scenes/ring/ring.gltf"), count=10_000, seed=1)
        >>> relaxed = photons.relax(steps=2)
        >>> len(relaxed) == len(photons)
        True
        """
        return relax_photons(self, progress, **{**settings, "steps": steps, "neighbors": neighbors})
