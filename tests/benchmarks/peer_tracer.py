# SPDX-License-Identifier: Apache-2.0
"""A photon tracer written with Mitsuba and Dr.Jit: paths stored with vertices and normals, emission aimed."""

from __future__ import annotations

import os
import re
from typing import Any

import drjit as dr
import mitsuba as mi
import numpy as np
from find_llvm import VARIABLE
from scene_data import RING, SLAB, build_meshes

MAX_BOUNCES = 16
CELL_ROWS, PROBES_PER_CELL = 256, 64

mi.set_variant("llvm_ad_rgb")


def describe_versions() -> str:
    """Versions of Mitsuba, Dr.Jit and the LLVM library they run on."""
    llvm = re.search(r"libLLVM\D*([\d.]*\d)", os.environ[VARIABLE])
    return f"Mitsuba {mi.__version__}, Dr.Jit {dr.__version__}, LLVM {llvm[1] if llvm else 'of ' + VARIABLE}"


def make_mesh(name: str, mesh: Any) -> Any:
    """Hand a mesh with its vertex normals to Mitsuba."""
    made = mi.Mesh(name, len(mesh.positions), len(mesh.indices), has_vertex_normals=True)
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = mesh.positions.astype(np.float32).ravel()
    parameters["vertex_normals"] = mesh.normals.astype(np.float32).ravel()
    parameters["faces"] = mesh.indices.astype(np.uint32).ravel()
    parameters.update()
    return made


class DrjitTracer:
    """One of our scenes, its light aimed at the cells of a projection grid that hold specular geometry."""

    def __init__(self, name: str) -> None:
        specular, floor = build_meshes(name)
        self.light = RING.light if name == "ring" else (0.0, SLAB.light_height, 0.0)
        self.glass = name == "slab"
        scene = {"type": "scene", "specular": make_mesh("specular", specular), "floor": make_mesh("floor", floor)}
        self.scene = mi.load_dict(scene)
        self.specular = mi.ShapePtr(next(shape for shape in self.scene.shapes() if shape.id() == "specular"))
        self.cells = self.find_cells()

    def find_cells(self) -> Any:
        """Indices of the cells of equal solid angle through which probe rays met the specular mesh."""
        count = 2 * CELL_ROWS * CELL_ROWS
        probe = dr.arange(mi.UInt32, count * PROBES_PER_CELL)
        rng = mi.PCG32(size=count * PROBES_PER_CELL)
        cell = probe // PROBES_PER_CELL
        direction = self.aim(cell, rng.next_float32(), rng.next_float32())
        hit = self.scene.ray_intersect(mi.Ray3f(mi.Point3f(self.light), direction))
        met = dr.zeros(mi.UInt32, count)
        dr.scatter_reduce(dr.ReduceOp.Or, met, mi.UInt32(1), cell, hit.is_valid() & (hit.shape == self.specular))
        return mi.UInt32(np.flatnonzero(met.numpy()).astype(np.uint32))

    @staticmethod
    def aim(cell: Any, row_part: Any, column_part: Any) -> Any:
        """Direction inside a cell: rows are equal steps of y, columns equal steps of azimuth."""
        columns = 2 * CELL_ROWS
        y = 1.0 - 2.0 * (mi.Float(cell // columns) + row_part) / CELL_ROWS
        azimuth = dr.two_pi * (mi.Float(cell % columns) + column_part) / columns
        across = dr.safe_sqrt(1.0 - y * y)
        return mi.Vector3f(across * dr.cos(azimuth), y, across * dr.sin(azimuth))

    def emit(self, rng: Any, count: int, seed: int, emission: str) -> Any:
        """First directions; "sobol": the first two Sobol dimensions, scrambled by a digital shift."""
        if emission == "sobol":
            index = dr.arange(mi.UInt32, count)
            first = mi.radical_inverse_2(index, seed * 0x9E3779B1 & 0xFFFFFFFF)
            second = mi.sobol_2(index, seed * 0x85EBCA6B & 0xFFFFFFFF)
        else:
            first, second = rng.next_float32(), rng.next_float32()
        place = first * dr.width(self.cells)
        number = dr.minimum(mi.UInt32(place), dr.width(self.cells) - 1)
        return self.aim(dr.gather(mi.UInt32, self.cells, number), place - mi.Float(number), second)

    def trace(self, count: int, seed: int, emission: str) -> dict[str, Any]:
        """Trace and store `count` paths: positions and normals in rows of `count`, one row per vertex."""
        rng = mi.PCG32(size=count, initstate=seed)
        direction = self.emit(rng, count, seed, emission)
        stored = {name: dr.empty(mi.Point3f, (MAX_BOUNCES + 2) * count) for name in ("positions", "normals")}
        lengths, power = self.follow(direction, rng, count, stored["positions"], stored["normals"])
        dr.eval(stored, lengths, power)
        dr.sync_thread()
        return {**stored, "lengths": lengths, "power": power}

    @dr.syntax
    def follow(self, direction: Any, rng: Any, count: int, positions: Any, normals: Any) -> tuple[Any, Any]:
        """The loop over bounces; vertices of each path (0: it met no receiver) and its power."""
        lane = dr.arange(mi.UInt32, count)
        vertex = mi.UInt32(1)
        power = mi.Color3f(1.0)
        landed = mi.Bool(False)
        active = mi.Bool(True)
        dr.scatter(positions, mi.Point3f(self.light), lane)
        dr.scatter(normals, mi.Point3f(direction), lane)
        ray = mi.Ray3f(mi.Point3f(self.light), direction)
        while active:
            hit = self.scene.ray_intersect(ray, mi.RayFlags.ShadingFrame | mi.RayFlags.Minimal, coherent=False)
            active &= hit.is_valid()
            place = vertex * count + lane
            dr.scatter(positions, hit.p, place, active)
            dr.scatter(normals, mi.Point3f(hit.sh_frame.n), place, active)
            vertex += dr.select(active, 1, 0)
            met_specular = active & (hit.shape == self.specular)
            landed |= active & ~met_specular
            active &= met_specular & (vertex < MAX_BOUNCES + 2)
            local = hit.to_local(-ray.d)
            if dr.hint(self.glass, mode="scalar"):
                reflectance, cosine, _, eta = mi.fresnel(local.z, SLAB.ior)
                reflected = rng.next_float32() < reflectance
                leaving = dr.select(reflected, mi.reflect(local), mi.refract(local, cosine, eta))
            else:
                leaving = mi.reflect(local)
                base = mi.Color3f(RING.mirror_color)
                power *= dr.select(active, base + (1.0 - base) * (1.0 - dr.abs(local.z)) ** 5, 1.0)
            ray = hit.spawn_ray(hit.to_world(leaving))
        return dr.select(landed, vertex, 0), power
