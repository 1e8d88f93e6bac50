# SPDX-License-Identifier: Apache-2.0
"""Scenes that photons of one's own lie on: a finely faceted sphere, a square with a border."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import photonloupe as pl
from gltf import GltfWriter, Mesh, make_diffuse

Doubles = NDArray[np.float64]

GOLDEN = 0.5 * (1.0 + np.sqrt(5.0))
CORNERS = np.array([(0.0, s, t * GOLDEN) for s in (-1.0, 1.0) for t in (-1.0, 1.0)])


def build_icosahedron() -> tuple[Doubles, NDArray[np.int64]]:
    """Twelve unit corners and twenty triangles that face outward."""
    corners = np.concatenate([np.roll(CORNERS, turn, axis=1) for turn in range(3)])
    corners /= np.linalg.norm(corners[0])
    side = np.linalg.norm(corners[:, None] - corners, axis=2)
    is_edge = np.isclose(side, side[side > 0.1].min())
    faces = []
    for a, b, c in np.argwhere(is_edge[:, :, None] & is_edge[:, None, :] & is_edge[None]):
        outward = np.linalg.det(corners[[a, b, c]]) > 0.0
        if a < b and a < c and outward:
            faces.append((a, b, c))
    return corners, np.array(faces)


def build_sphere(divisions: int) -> Mesh:
    """Unit sphere of 20 · 4^divisions triangles, with exact normals."""
    corners, faces = build_icosahedron()
    for _ in range(divisions):
        ends = np.sort(faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
        edges, which = np.unique(ends, axis=0, return_inverse=True)
        middles = corners[edges].sum(axis=1)
        middles /= np.linalg.norm(middles, axis=1, keepdims=True)
        ab, bc, ca = (len(corners) + which.reshape(-1, 3)).T
        a, b, c = faces.T
        faces = np.concatenate(
            [np.stack(each, axis=1) for each in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
        )
        corners = np.concatenate([corners, middles])
    return Mesh(corners, corners, faces)


def find_planes(mesh: Mesh) -> tuple[Doubles, Doubles]:
    """Outward normals of the facets of a convex mesh, (t, 3), and their distances from the origin, (t,)."""
    a, b, c = (mesh.positions[mesh.indices[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return normal, np.sum(normal * a, axis=1)


def measure_height(mesh: Mesh, positions: Doubles) -> Doubles:
    """How far points are above a convex mesh, (n,): negative inside, 0 on a facet."""
    normal, distance = find_planes(mesh)
    parts = np.array_split(positions, max(1, len(positions) // 200))  # a few hundred planes' worth at a time
    return np.concatenate([(part @ normal.T - distance).max(axis=1) for part in parts])


def cast_onto_facets(mesh: Mesh, directions: Doubles) -> Doubles:
    """Where rays from the origin leave a convex mesh, (n, 3)."""
    normal, distance = find_planes(mesh)
    parts = np.array_split(directions, max(1, len(directions) // 200))
    reach = np.concatenate([1.0 / (part @ normal.T / distance).max(axis=1) for part in parts])
    return directions * reach[:, None]


def load_surface(folder: Path, *meshes: Mesh) -> pl.Scene:
    """Load diffuse meshes, objects 0, 1 …, and a light that no test asks for."""
    writer = GltfWriter("surface")
    for number, mesh in enumerate(meshes):
        writer.add_mesh(f"surface {number}", mesh, make_diffuse("plaster", 0.5))
    writer.add_point_light("lamp", (0.0, 3.0, 0.0), 1.0)
    writer.write(folder)
    return pl.load_scene(folder / "surface.gltf")


def place_photons(
    scene: pl.Scene, positions: Doubles, normals: Doubles, on: NDArray[np.int64] | None = None
) -> pl.PhotonMap:
    """Photons of flux 1 on object 0 of a scene, or on those given."""
    count = len(positions)
    return pl.PhotonMap.from_arrays(
        positions=positions,
        normals=normals,
        power=np.ones((count, 3)),
        object=np.zeros(count, dtype=np.int64) if on is None else on,
        surface=scene,
    )
