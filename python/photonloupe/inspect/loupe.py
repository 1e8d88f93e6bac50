# SPDX-License-Identifier: Apache-2.0
"""The loupe: the photons around a place, and what is worth knowing of the one at its center."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from photonloupe import _engine
from photonloupe.checks import check_count, check_vector
from photonloupe.errors import ArgumentError
from photonloupe.nearest import check_layer, check_look
from photonloupe.photons import PhotonMap, check_map
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.settings import list_settings, takes_settings

Floats = NDArray[np.float32]


@dataclass(frozen=True)
class LoupeNumbers:
    """What is known of the photon at the center; NaN: undefined, or not measured.

    Attributes
    ----------
    position, power
        (3,) m, (3,) W.
    parameters
        By name.
    interactions, signature
        ``"RT"``: reflected, then transmitted; V: scattered by a medium; the same as a number, [SJL15] eq. 2.
    tortuosity, path_length
        [SJL15] eq. 1; m.
    one_sidedness, drift, pressure
        c_m, m, |f'|/r.
    """

    position: NDArray[np.float64]
    power: Floats
    parameters: dict[str, float]
    interactions: str
    signature: float
    tortuosity: float
    path_length: float
    one_sidedness: float
    drift: float
    pressure: float


@dataclass(frozen=True)
class PathLine:
    """One photon's path: vertices (m, 3), m, and interactions (m,).

    Of these 1 is reflected, 2 transmitted, 3 scattered by a medium, 0 stands at the ends.
    """

    photon: int
    vertices: Floats
    interactions: NDArray[np.uint8]


@dataclass(frozen=True)
class LoupeView:
    """What a loupe shows.

    Attributes
    ----------
    center
        Photon at the center: the nearest of that surface, or the one asked for; None in an empty map.
    ids, distances
        (m,) up to k photons, nearest first, ties by id; m, or in parameter space.
    radius
        World distance of the farthest of them, m.
    positions, colors
        (m, 3) m; (m, 3) linear, None where the map has none.
    has_constraint
        Whether `basis` and `freedom` are the map's constraint; else the basis is `eigenvectors` and nothing is fixed.
    basis, freedom
        (2, 3) u_b, v_b of the center; (2,) 1 - w_u and 1 - w_v.
    eigenvalues, eigenvectors, isotropy
        (2,) λ₁ and λ₂, m²; (2, 3); t = √(λ₂/λ₁), [SJL15] eq. 5: of the photons found, in the center's tangent plane.
    ellipse_axes, ellipse_half_axes
        (m, 2, 3) u_b, v_b and (m, 2) |D·u_b|, |D·v_b| of the photons found, m (METHODS section 5.5); no rows where the
        map was not relaxed.
    numbers
        Of the center.
    paths
        Polylines of the nearest, as many as were asked for.
    """

    center: int | None
    ids: NDArray[np.uint32]
    distances: Floats
    radius: float
    positions: Floats
    colors: Floats | None
    has_constraint: bool
    basis: Floats
    freedom: tuple[float, float]
    eigenvalues: tuple[float, float]
    eigenvectors: Floats
    isotropy: float
    ellipse_axes: Floats
    ellipse_half_axes: Floats
    numbers: LoupeNumbers
    paths: tuple[PathLine, ...]


@takes_settings("loupe")
def loupe(
    photons: PhotonMap,
    point: ArrayLike | int,
    k: int | None = None,
    space: str | None = None,
    beta: float | str | None = None,
    center: int | None = None,
    ranges: Mapping[int | str, tuple[float, float]] | None = None,
    *,
    normal: ArrayLike | None = None,
    paths: int = 0,
    progress: ProgressLike = None,
) -> LoupeView:
    """Look at the photons around a place ([SJL15] section 4, figures 7 and 8).

    Parameters
    ----------
    photons
        The map; its paths are recorded now, where it can have them.
    point
        (3,) world, m, or the id of a photon, which then is not its own neighbor.
    {settings}
    center
        Constrained space around a point: the layer is locked to that of this photon (figure 7 i).
    ranges
        Instead: the layer is all photons whose parameters lie within, ``{name or dimension: (low, high)}``.
    normal
        (3,) of the surface at the point: the center is sought among photons that face the same way.
    paths
        How many of the nearest photons' paths to give.
    progress
        True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    LoupeView

    Raises
    ------
    ArgumentError
        If the point is not finite, an id is not a photon, k is out of range, or the space lacks what it needs.

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> line = np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]])
    >>> photons = pl.PhotonMap.from_arrays(positions=line, normals=[[0, 1, 0]] * 3, power=np.ones((3, 3)))
    >>> view = pl.inspect.loupe(photons, [0.9, 0, 0], k=2)
    >>> view.center, view.ids.tolist()
    (1, [1, 0])
    """
    check_map(photons)
    k, query, reach = check_look(photons, k, space, beta, center, ranges)
    query.update(_check_place(photons, point, normal), k=k)
    if query["space"] == "constrained":
        query.update(check_layer(photons, query["photon"] is not None, reach, center, ranges, progress))
    line_count = check_count("paths", paths, 0, list_settings("loupe")["k"].limits[1])
    if line_count and not photons.can_have_paths:
        raise ArgumentError("this map has no paths and cannot record them; give them to from_arrays")
    if photons.can_have_paths:
        photons.record_paths()
    with follow_progress(progress) as callback:
        row = _engine.look_through_loupe(photons.device._native, photons._native, query, callback)
    return _make_view(photons._native, row, line_count)


def _check_place(photons: PhotonMap, point: ArrayLike | int, normal: ArrayLike | None) -> dict[str, Any]:
    """Tell a photon from a point."""
    if isinstance(point, int | np.integer) and not isinstance(point, bool):
        if len(photons) == 0:
            raise ArgumentError(f"the map is empty; it has no photon {point}")
        return {"photon": check_count("point", int(point), 0, len(photons) - 1), "point": None, "normal": None}
    place = check_vector("point", point)
    if normal is None:
        return {"photon": None, "point": place, "normal": None}
    facing = np.array(check_vector("normal", normal))
    length = float(np.linalg.norm(facing))
    if length == 0.0:
        raise ArgumentError("normal is zero; a normal needs a direction")
    return {"photon": None, "point": place, "normal": (facing / length).tolist()}


def _make_view(native: _engine.PhotonMap, row: dict[str, Any], line_count: int) -> LoupeView:
    numbers = row.pop("numbers")
    numbers["position"] = np.array(numbers["position"], dtype=np.float64)
    numbers["power"] = np.array(numbers["power"], dtype=np.float32)
    ids = row["ids"][:line_count]
    lines = _engine.read_path_lines(native, ids.tolist()) if len(ids) else []
    return LoupeView(
        **row,
        numbers=LoupeNumbers(**numbers),
        paths=tuple(PathLine(int(photon), *line) for photon, line in zip(ids, lines, strict=True)),
    )
