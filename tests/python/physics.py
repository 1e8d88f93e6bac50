# SPDX-License-Identifier: Apache-2.0
"""What the physics tests share: the oracle of each scene, and photons counted in the oracle's cells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from generate import BOWL, RING, SLAB, CylinderScene
from oracles import MirrorCylinder, Slab

if TYPE_CHECKING:
    from photonloupe import PhotonMap

# A whole number of blocks and a power of two, on which Sobol points are at their most even.
FOUR_MILLION = 1 << 22
MAX_BOUNCES = 16
# A slab passes 2·10⁻¹⁰ of what it passes at once after five pairs of inner reflections.
SLAB_ORDERS = 5


def build_cylinder_oracle(scene: CylinderScene) -> MirrorCylinder:
    return MirrorCylinder(scene.radius, scene.wall_height, scene.light, scene.intensity, scene.mirror_color)


def find_cylinder_flux(scene: CylinderScene) -> NDArray[np.float64]:
    """Flux on the floor after any number of reflections up to the limit, (3,)."""
    oracle = build_cylinder_oracle(scene)
    return np.sum([oracle.total_flux(bounces) for bounces in range(1, MAX_BOUNCES + 1)], axis=0)


def find_slab_flux() -> NDArray[np.float64]:
    """Flux on the floor by all ways through the slab, (3,)."""
    orders = (
        Slab(SLAB.thickness, SLAB.ior, SLAB.light_height, SLAB.intensity, pairs).square_flux(SLAB.floor_half)
        for pairs in range(SLAB_ORDERS)
    )
    return np.full(3, sum(orders))


@dataclass(frozen=True)
class BinCase:
    """Cells of one scene, the flux the oracle gives each in the red channel, and cells where it may not be used."""

    name: str
    edges: NDArray[np.float64]
    flux: NDArray[np.float64]
    excluded: NDArray[np.bool_]

    def count_photons(self, photons: PhotonMap) -> NDArray[np.float64]:
        """Photons in each cell, (nx, nz)."""
        x, z = photons.positions[:, 0], photons.positions[:, 2]
        return np.histogram2d(x, z, bins=(self.edges, self.edges))[0]

    def count_expected(self, photons: PhotonMap) -> NDArray[np.float64]:
        """How many photons the oracle puts into each cell; every photon carries the same red flux."""
        return self.flux / float(photons.power[0, 0])


def build_cylinder_bins(scene: CylinderScene, half: float, cells: int) -> BinCase:
    """Cells of a mirror scene; gold and silver reflect all red light, so that photons of any bounce are alike."""
    oracle = build_cylinder_oracle(scene)
    edges = np.linspace(-half, half, cells + 1)
    # Further reflections bring 2 % of the light, evenly enough for fewer lines.
    flux = oracle.cell_flux(edges, edges)[0]
    flux += sum(
        oracle.cell_flux(edges, edges, bounces=bounces, count=5_000)[0] for bounces in range(2, MAX_BOUNCES + 1)
    )
    return BinCase(scene.name, edges, flux, oracle.find_caustic_cells(edges, edges))


def build_slab_bins(cells: int) -> BinCase:
    edges = np.linspace(-SLAB.floor_half, SLAB.floor_half, cells + 1)
    flux = sum(
        Slab(SLAB.thickness, SLAB.ior, SLAB.light_height, SLAB.intensity, pairs).cell_flux(edges, edges)
        for pairs in range(SLAB_ORDERS)
    )
    return BinCase("slab", edges, np.asarray(flux), np.zeros((cells, cells), dtype=bool))


__all__ = [
    "BOWL",
    "FOUR_MILLION",
    "RING",
    "SLAB",
    "BinCase",
    "build_cylinder_bins",
    "build_slab_bins",
    "find_cylinder_flux",
    "find_slab_flux",
]
