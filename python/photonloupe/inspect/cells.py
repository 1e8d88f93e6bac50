# SPDX-License-Identifier: Apache-2.0
"""Pictures of cells: which photon, or which node of the kd-tree, each surface point that a camera sees belongs to."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from photonloupe import _engine
from photonloupe.camera import Camera, check_camera
from photonloupe.checks import check_count
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.image import Image
from photonloupe.inspect.columns import require_columns
from photonloupe.photons import PhotonMap, check_map
from photonloupe.progress import ProgressLike, follow_progress
from photonloupe.provenance import describe_origin
from photonloupe.rendering import MAX_SIDE
from photonloupe.scene import Scene

# Largest height above the tangent plane as a share of r, of photons of the same surface (METHODS section 2).
SURFACE_FLATNESS = 0.1
MAX_DEPTH = 64


@dataclass(frozen=True)
class SurfaceView:
    """The surfaces a camera sees, by the ray through each pixel's center; NaN and -1 where there is none.

    Attributes
    ----------
    points, normals
        (h, w, 3) m, world; unit, towards the eye.
    objects
        (h, w) index of the object.
    depth
        (h, w) m along the view's axis, inf where nothing is seen.
    """

    points: NDArray[np.float32]
    normals: NDArray[np.float32]
    objects: NDArray[np.int32]
    depth: NDArray[np.float32]


@dataclass(frozen=True)
class NodeBox:
    """A node of the kd-tree: its row in `PhotonMap.tree`, its photons, and the box about them, (2, 3), m."""

    node: int
    photon_count: int
    box: NDArray[np.float64]


@dataclass(frozen=True)
class CellView:
    """What each pixel belongs to.

    Attributes
    ----------
    ids
        (h, w) photon, or row of `PhotonMap.tree`; -1 where no surface is seen, or no photon lies on it.
    depth
        (h, w) m along the view's axis, inf where nothing is seen.
    borders
        (h, w) whether the right or the lower neighbor belongs to another cell.
    image
        The cells in their colors, borders black.
    boxes
        Of kd-tree nodes; empty of photons.
    """

    ids: NDArray[np.int32]
    depth: NDArray[np.float32]
    borders: NDArray[np.bool_]
    image: Image
    boxes: tuple[NodeBox, ...] = ()


def surfaces(
    scene: Scene,
    camera: str | Camera | None = None,
    width: int = 512,
    height: int = 512,
    *,
    through_glass: bool = False,
    device: Device | int | str | None = None,
    progress: ProgressLike = None,
) -> SurfaceView:
    """Find the first surface that each pixel's center sees; nothing is followed through mirrors.

    Parameters
    ----------
    scene
        What `load_scene` returned.
    camera
        Its name, or a `Camera`; by default the scene's first, or one that fits the bounds.
    width, height
        In pixels.
    through_glass
        Whether surfaces that mostly transmit are passed, straight on.
    device
        A `Device`, its name or index; default the best there is.
    progress
        True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    SurfaceView

    Raises
    ------
    ArgumentError
        If the size is out of range or the camera is not there.

    Examples
    --------
    >>> import photonloupe as pl
    >>> scene = pl.load_scene("scenes/ring/ring.gltf")
    >>> pl.inspect.surfaces(scene, "top", 8, 8).points.shape
    (8, 8, 3)
    """
    settings = _check_view(scene, camera, width, height, through_glass)
    with follow_progress(progress) as callback:
        packed, normals, objects = _engine.see_surfaces(open_device(device)._native, scene._native, settings, callback)
    shape = (settings["height"], settings["width"])
    depth = packed[:, 3].reshape(shape)
    is_seen = np.isfinite(depth)
    points = np.where(is_seen[..., None], packed[:, :3].reshape(*shape, 3), np.float32(np.nan))
    facing = np.where(is_seen[..., None], normals.reshape(*shape, 3), np.float32(np.nan))
    return SurfaceView(points, facing, np.where(is_seen, objects.reshape(shape), -1), depth)


def voronoi(
    photons: PhotonMap,
    scene: Scene | None = None,
    camera: str | Camera | None = None,
    width: int = 512,
    height: int = 512,
    *,
    color: str = "encoding",
    same_surface: bool = True,
    through_glass: bool = False,
    progress: ProgressLike = None,
) -> CellView:
    """Find the Voronoi cells of the photons on the surfaces that a camera sees ([SJL15] figure 6).

    Parameters
    ----------
    photons
        The map.
    scene
        By default the one the photons lie in.
    camera, width, height, through_glass
        As in `surfaces`.
    color
        ``"encoding"``: the colors a script gave, else one of its own for each photon; or the name of a column.
    same_surface
        Photons count as in density estimates (METHODS section 2): those that face another way belong to another
        surface, and the distance to one above the tangent plane is ten times its height if that is more. False: the
        nearest photon, whatever it lies on.
    progress
        True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    CellView

    Raises
    ------
    ArgumentError
        If there is no scene, no such camera or column, or the size is out of range.

    Examples
    --------
    >>> import photonloupe as pl
    >>> scene = pl.load_scene("scenes/ring/ring.gltf")
    >>> photons = pl.trace_photons(scene, count=10_000, seed=1)
    >>> pl.inspect.voronoi(photons, scene, "top", 64, 64).image
    <Image 64 × 64, linear>
    """
    scene = _choose_scene(photons, scene)
    settings = _check_view(scene, camera, width, height, through_glass)
    settings["flatness"] = SURFACE_FLATNESS if same_surface else 0.0
    settings["color"] = color
    require_columns(photons, () if color == "encoding" else (color,))
    opened = photons.device
    with follow_progress(progress) as callback:
        row = _engine.find_voronoi_cells(opened._native, photons._native, scene._native, settings, callback)
    return _make_view(row, describe_origin(opened, scene, {"mode": "voronoi", **settings}))


def kd_tree(
    photons: PhotonMap,
    scene: Scene | None = None,
    camera: str | Camera | None = None,
    width: int = 512,
    height: int = 512,
    *,
    depth: int | None = None,
    through_glass: bool = False,
    progress: ProgressLike = None,
) -> CellView:
    """Find which node of the kd-tree each surface point falls in, by the splits above it.

    Parameters
    ----------
    photons
        The map.
    scene
        By default the one the photons lie in.
    camera, width, height, through_glass
        As in `surfaces`.
    depth
        Level of the nodes, 0 the root; by default, and below them, the leaves.
    progress
        True for a bar, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    CellView

    Raises
    ------
    ArgumentError
        If there is no scene, no such camera, or a number is out of range.

    Examples
    --------
    >>> import photonloupe as pl
    >>> scene = pl.load_scene("scenes/ring/ring.gltf")
    >>> photons = pl.trace_photons(scene, count=10_000, seed=1)
    >>> len(pl.inspect.kd_tree(photons, scene, "top", 64, 64, depth=3).boxes)
    8
    """
    scene = _choose_scene(photons, scene)
    settings = _check_view(scene, camera, width, height, through_glass)
    settings["depth"] = None if depth is None else check_count("depth", depth, 0, MAX_DEPTH)
    opened = photons.device
    with follow_progress(progress) as callback:
        row = _engine.find_kd_cells(opened._native, photons._native, scene._native, settings, callback)
    return _make_view(row, describe_origin(opened, scene, {"mode": "kd-tree", **settings}))


def _choose_scene(photons: PhotonMap, scene: Scene | None) -> Scene:
    check_map(photons)
    if scene is None:
        scene = photons.find_surface()
    if scene is None:
        raise ArgumentError("this map knows no scene; say with scene= whose surfaces to look at")
    return scene


def _check_view(
    scene: Scene, camera: str | Camera | None, width: int, height: int, through_glass: bool
) -> dict[str, Any]:
    if not isinstance(scene, Scene):
        raise ArgumentError(f"scene must come from load_scene, not {scene!r}")
    return {
        "camera": check_camera(scene, camera),
        "width": check_count("width", width, 1, MAX_SIDE),
        "height": check_count("height", height, 1, MAX_SIDE),
        "through_glass": bool(through_glass),
    }


def _make_view(row: dict[str, Any], provenance: dict[str, Any]) -> CellView:
    boxes = (
        NodeBox(node, count, np.array(corners, dtype=np.float64).reshape(2, 3))
        for node, count, corners in row.get("boxes", ())
    )
    return CellView(
        ids=row["ids"],
        depth=row["depth"],
        borders=row["borders"].astype(bool),
        image=Image(row["pixels"], provenance=provenance),
        boxes=tuple(boxes),
    )
