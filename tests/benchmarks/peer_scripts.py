# SPDX-License-Identifier: Apache-2.0
"""What scripts compute, as a researcher writes it without the script language: NumPy, Numba and Taichi."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float32]
# One path is 4 vertices: emitter, two interactions, storage point.
VERTICES = 4
Work = Callable[[], Any]


def make_paths(count: int) -> tuple[Floats, Floats]:
    """Vertices and unit normals of `count` random paths, (count, 4, 3) each."""
    generator = np.random.default_rng(1)
    vertices = generator.random((count, VERTICES, 3), dtype=np.float32)
    normals = generator.normal(size=(count, VERTICES, 3)).astype(np.float32)
    normals /= np.linalg.norm(normals, axis=2, keepdims=True)
    return vertices, normals


# The same work as scripts, written as plainly.
TORTUOSITY = """
alpha = 50; expose alpha range 1, 1000
declarePhotonParameter(3, 0, 1);
for (i = 0; i < getNumPhotons(); i++) {
    m = getNumPathVertices(i);
    if (m < 3) continue;
    sum = 0;
    for (j = 1; j < m - 1; j++) {
        x0 = getPathVertex(i, j, X) - getPathVertex(i, j - 1, X);
        y0 = getPathVertex(i, j, Y) - getPathVertex(i, j - 1, Y);
        z0 = getPathVertex(i, j, Z) - getPathVertex(i, j - 1, Z);
        x1 = getPathVertex(i, j + 1, X) - getPathVertex(i, j, X);
        y1 = getPathVertex(i, j + 1, Y) - getPathVertex(i, j, Y);
        z1 = getPathVertex(i, j + 1, Z) - getPathVertex(i, j, Z);
        sum += acos(dot(x0, y0, z0, x1, y1, z1) / (magnitude(x0, y0, z0) * magnitude(x1, y1, z1)));
    }
    sum /= Pi * (m - 2);
    setPhotonParameter(i, 3, sum);
    turn = alpha * 2 * Pi * sum;
    setPhotonColorEncoding(i, hue(turn, 0), hue(turn, 1), hue(turn, 2));
}
"""
PPCA = """
declarePhotonParameter(3, -Pi, Pi);
declarePhotonParameter(4, -Pi, Pi);
function push(x, y, z, turns) {
    theta = acos(z); phi = atan2(x, y) * turns;
    pushPCA2D(theta * sin(phi), theta * cos(phi));
}
for (i = 0; i < getNumPhotons(); i++) {
    m = getNumPathVertices(i);
    if (m < 2) continue;
    resetPCA2D();
    x = getPathVertex(i, 1, X) - getPathVertex(i, 0, X);
    y = getPathVertex(i, 1, Y) - getPathVertex(i, 0, Y);
    z = getPathVertex(i, 1, Z) - getPathVertex(i, 0, Z);
    size = magnitude(x, y, z);
    push(x / size, y / size, z / size, 1);
    for (j = 1; j < m; j++) push(getPathNormal(i, j, X), getPathNormal(i, j, Y), getPathNormal(i, j, Z), 2);
    if (!decomposePCA2D()) continue;
    spread = sqrt(getPCAEigenvalue(0));
    setPhotonParameter(i, 3, getPCAEigenvector(0, X) * spread);
    setPhotonParameter(i, 4, getPCAEigenvector(0, Y) * spread);
}
"""
ALPHA = 50.0


def find_colors(gamma: Floats) -> Floats:
    """Hue of α turns of a parameter, NumPy."""
    turns = 2 * np.pi * (ALPHA * gamma[:, None] - np.arange(3) / 3)
    return (0.5 + 0.5 * np.cos(turns)).astype(np.float32)


def find_tortuosity(vertices: Floats) -> Floats:
    """Mean angle between successive segments over π ([SJL15] eq. 1), NumPy."""
    segments = np.diff(vertices, axis=1)
    lengths = np.linalg.norm(segments, axis=2)
    cosines = np.einsum("ijk,ijk->ij", segments[:, :-1], segments[:, 1:]) / (lengths[:, :-1] * lengths[:, 1:])
    angles = np.arccos(np.clip(cosines, -1.0, 1.0))
    return angles.sum(axis=1) / np.float32(math.pi * (VERTICES - 2))


def find_ppca(vertices: Floats, normals: Floats) -> Floats:
    """First principal axis of the planar primal direction and path normals, times √λ ([SJL15] section 5.3), NumPy."""
    primal = vertices[:, 1] - vertices[:, 0]
    primal = primal / np.linalg.norm(primal, axis=1, keepdims=True)
    directions = np.concatenate([primal[:, None], normals[:, 1:]], axis=1)
    theta = np.arccos(np.clip(directions[..., 2], -1.0, 1.0))
    phi = np.arctan2(directions[..., 0], directions[..., 1])
    phi[:, 1:] *= 2.0
    points = np.stack([theta * np.sin(phi), theta * np.cos(phi)], axis=2)
    centered = points - points.mean(axis=1, keepdims=True)
    a = np.mean(centered[..., 0] ** 2, axis=1)
    b = np.mean(centered[..., 0] * centered[..., 1], axis=1)
    c = np.mean(centered[..., 1] ** 2, axis=1)
    half = 0.5 * (a - c)
    largest = 0.5 * (a + c) + np.sqrt(half * half + b * b)
    angle = 0.5 * np.arctan2(2.0 * b, a - c)
    axis = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    axis *= np.where((axis * points[:, 0]).sum(axis=1) < 0.0, -1.0, 1.0)[:, None].astype(np.float32)
    return axis * np.sqrt(largest)[:, None]


def build_numba() -> tuple[Callable[[Floats, Floats, Floats], None], Callable[[Floats, Floats, Floats], None]]:
    """Compile both, parallel over the paths: (vertices, out, colors) and (vertices, normals, out)."""
    import numba  # noqa: PLC0415 - an optional peer

    @numba.njit(parallel=True, fastmath=False)
    def tortuosity(vertices: Floats, out: Floats, colors: Floats) -> None:
        for i in numba.prange(len(vertices)):
            total = np.float32(0.0)
            for j in range(1, VERTICES - 1):
                x0 = vertices[i, j, 0] - vertices[i, j - 1, 0]
                y0 = vertices[i, j, 1] - vertices[i, j - 1, 1]
                z0 = vertices[i, j, 2] - vertices[i, j - 1, 2]
                x1 = vertices[i, j + 1, 0] - vertices[i, j, 0]
                y1 = vertices[i, j + 1, 1] - vertices[i, j, 1]
                z1 = vertices[i, j + 1, 2] - vertices[i, j, 2]
                lengths = math.sqrt(x0 * x0 + y0 * y0 + z0 * z0) * math.sqrt(x1 * x1 + y1 * y1 + z1 * z1)
                total += math.acos(min(1.0, max(-1.0, (x0 * x1 + y0 * y1 + z0 * z1) / lengths)))
            gamma = total / (math.pi * (VERTICES - 2))
            out[i] = gamma
            for c in range(3):
                colors[i, c] = 0.5 + 0.5 * math.cos(2 * math.pi * (ALPHA * gamma - c / 3))

    @numba.njit(parallel=True, fastmath=False)
    def ppca(vertices: Floats, normals: Floats, out: Floats) -> None:
        for i in numba.prange(len(vertices)):
            us = np.empty(VERTICES, np.float32)
            vs = np.empty(VERTICES, np.float32)
            x = vertices[i, 1, 0] - vertices[i, 0, 0]
            y = vertices[i, 1, 1] - vertices[i, 0, 1]
            z = vertices[i, 1, 2] - vertices[i, 0, 2]
            length = math.sqrt(x * x + y * y + z * z)
            for j in range(VERTICES):
                if j > 0:
                    x, y, z, length = normals[i, j, 0], normals[i, j, 1], normals[i, j, 2], 1.0
                theta = math.acos(min(1.0, max(-1.0, z / length)))
                phi = math.atan2(x, y) * (2.0 if j > 0 else 1.0)
                us[j] = theta * math.sin(phi)
                vs[j] = theta * math.cos(phi)
            u, v = us.mean(), vs.mean()
            a = b = c = 0.0
            for j in range(VERTICES):
                a += (us[j] - u) ** 2 / VERTICES
                b += (us[j] - u) * (vs[j] - v) / VERTICES
                c += (vs[j] - v) ** 2 / VERTICES
            largest = 0.5 * (a + c) + math.sqrt(0.25 * (a - c) ** 2 + b * b)
            angle = 0.5 * math.atan2(2.0 * b, a - c)
            along, across = math.cos(angle), math.sin(angle)
            sign = -1.0 if along * us[0] + across * vs[0] < 0.0 else 1.0
            out[i, 0] = sign * along * math.sqrt(largest)
            out[i, 1] = sign * across * math.sqrt(largest)

    return tortuosity, ppca


def build_taichi(vertices: Floats, normals: Floats) -> tuple[Work, Work, Callable[[], tuple[Floats, Floats]]]:
    """Upload the paths to Taichi on Vulkan; two kernels with their wait, and a function that fetches the results."""
    import taichi as ti  # noqa: PLC0415 - an optional peer

    ti.init(arch=ti.vulkan, log_level=ti.ERROR)
    count = len(vertices)
    places = ti.Vector.field(3, ti.f32, shape=(count, VERTICES))
    facings = ti.Vector.field(3, ti.f32, shape=(count, VERTICES))
    gamma = ti.field(ti.f32, shape=count)
    colors = ti.Vector.field(3, ti.f32, shape=count)
    axes = ti.Vector.field(2, ti.f32, shape=count)
    places.from_numpy(vertices)
    facings.from_numpy(normals)

    @ti.kernel
    def tortuosity():
        for i in range(count):
            total = 0.0
            for j in range(1, VERTICES - 1):
                s = places[i, j] - places[i, j - 1]
                t = places[i, j + 1] - places[i, j]
                cosine = s.dot(t) / (s.norm() * t.norm())
                total += ti.acos(ti.min(1.0, ti.max(-1.0, cosine)))
            bent = total / (math.pi * (VERTICES - 2))
            gamma[i] = bent
            for c in ti.static(range(3)):
                colors[i][c] = 0.5 + 0.5 * ti.cos(2 * math.pi * (ALPHA * bent - c / 3))

    @ti.kernel
    def ppca():
        for i in range(count):
            us = ti.Vector([0.0] * VERTICES)
            vs = ti.Vector([0.0] * VERTICES)
            for j in ti.static(range(VERTICES)):
                w = (places[i, 1] - places[i, 0]).normalized() if ti.static(j == 0) else facings[i, j]
                theta = ti.acos(ti.min(1.0, ti.max(-1.0, w[2])))
                phi = ti.atan2(w[0], w[1]) * (1.0 if ti.static(j == 0) else 2.0)
                us[j] = theta * ti.sin(phi)
                vs[j] = theta * ti.cos(phi)
            du = us - us.sum() / VERTICES
            dv = vs - vs.sum() / VERTICES
            a, b, c = du.dot(du) / VERTICES, du.dot(dv) / VERTICES, dv.dot(dv) / VERTICES
            largest = 0.5 * (a + c) + ti.sqrt(0.25 * (a - c) ** 2 + b * b)
            angle = 0.5 * ti.atan2(2.0 * b, a - c)
            axis = ti.Vector([ti.cos(angle), ti.sin(angle)])
            sign = -1.0 if axis[0] * us[0] + axis[1] * vs[0] < 0.0 else 1.0
            axes[i] = sign * axis * ti.sqrt(largest)

    def run_tortuosity() -> None:
        tortuosity()
        ti.sync()

    def run_ppca() -> None:
        ppca()
        ti.sync()

    return run_tortuosity, run_ppca, lambda: (gamma.to_numpy(), axes.to_numpy())
