# SPDX-License-Identifier: Apache-2.0
"""Closed forms of the light in simple scenes, in double precision: what the engine must reproduce.

Numbers refer to METHODS section 8. Floors lie at y = 0; cells are indexed [x, z]; fluxes are W, irradiances W/m².
Lights are isotropic points of `intensity` W/sr, so a light of power 1 W has intensity 1/(4π).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

Doubles = NDArray[np.float64]

# Gauss-Legendre nodes for integrands that are analytic over the interval.
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(32)


def _scale_nodes(low: ArrayLike, high: ArrayLike) -> tuple[Doubles, Doubles]:
    """Quadrature nodes and weights on [low, high], along a new last axis."""
    low, high = np.asarray(low, dtype=np.float64)[..., None], np.asarray(high, dtype=np.float64)[..., None]
    return 0.5 * (low + high) + 0.5 * (high - low) * _NODES, 0.5 * (high - low) * _WEIGHTS


# ---- 1: point light over a plane -------------------------------------------------------------------------------


def plane_irradiance(rho: ArrayLike, height: float, intensity: float) -> Doubles:
    """Irradiance at distance `rho` from the foot of the light."""
    return intensity * height / (height**2 + np.square(np.asarray(rho, dtype=np.float64))) ** 1.5


def plane_disc_flux(radius: float, height: float, intensity: float) -> float:
    """Flux on the disc of `radius` about the foot."""
    return 2.0 * np.pi * intensity * (1.0 - height / np.hypot(height, radius))


def plane_cell_flux(edges_x: ArrayLike, edges_z: ArrayLike, light: Sequence[float], intensity: float) -> Doubles:
    """Flux on every cell, (nx, nz): the solid angle of a rectangle is a sum over its corners."""
    x = np.asarray(edges_x, dtype=np.float64)[:, None] - light[0]
    z = np.asarray(edges_z, dtype=np.float64)[None, :] - light[2]
    height = light[1]
    corner = np.arctan2(x * z, height * np.sqrt(x**2 + z**2 + height**2))
    return intensity * np.diff(np.diff(corner, axis=0), axis=1)


# ---- 2: point light over a plane-parallel slab -----------------------------------------------------------------


def fresnel_reflectance(cos_incident: ArrayLike, ior: float) -> Doubles:
    """Unpolarized reflectance from air into `ior`."""
    cos_i = np.asarray(cos_incident, dtype=np.float64)
    cos_t = np.sqrt(1.0 - (1.0 - cos_i**2) / ior**2)
    perpendicular = (cos_i - ior * cos_t) / (cos_i + ior * cos_t)
    parallel = (ior * cos_i - cos_t) / (ior * cos_i + cos_t)
    return 0.5 * (perpendicular**2 + parallel**2)


@dataclass(frozen=True)
class Slab:
    """Glass of `thickness` and `ior` between a light at `light_height` and the floor.

    Light that was refracted twice, and inside reflected `pairs` times at each face.
    """

    thickness: float
    ior: float
    light_height: float
    intensity: float
    pairs: int = 0

    @property
    def _gap(self) -> float:
        return self.light_height - self.thickness

    @property
    def _crossed(self) -> float:
        """Thickness of glass gone through."""
        return self.thickness * (1 + 2 * self.pairs)

    def transmittance(self, theta: ArrayLike) -> Doubles:
        """Share that takes this way."""
        reflectance = fresnel_reflectance(np.cos(theta), self.ior)
        return (1.0 - reflectance) ** 2 * reflectance ** (2 * self.pairs)

    def landing_distance(self, theta: ArrayLike) -> Doubles:
        """Distance from the axis at which light leaving at angle `theta` lands."""
        inside = np.arcsin(np.sin(theta) / self.ior)
        return self._gap * np.tan(theta) + self._crossed * np.tan(inside)

    def leaving_angle(self, rho: ArrayLike) -> Doubles:
        """Undo `landing_distance`."""
        rho = np.asarray(rho, dtype=np.float64)
        low = np.zeros_like(rho)
        high = np.arctan(rho / self._gap)
        for _ in range(60):  # each step halves the interval: 60 reach the last bit
            middle = 0.5 * (low + high)
            far = self.landing_distance(middle) > rho
            low, high = np.where(far, low, middle), np.where(far, middle, high)
        return 0.5 * (low + high)

    def irradiance(self, rho: ArrayLike) -> Doubles:
        """Irradiance at distance `rho` from the axis."""
        theta = np.maximum(self.leaving_angle(rho), 1e-9)  # the limit on the axis is reached long before
        inside = np.arcsin(np.sin(theta) / self.ior)
        slope = self._gap / np.cos(theta) ** 2
        slope += self._crossed * np.cos(theta) / (self.ior * np.cos(inside) ** 3)
        return self.intensity * self.transmittance(theta) * np.sin(theta) / (self.landing_distance(theta) * slope)

    def disc_flux(self, radius: ArrayLike) -> Doubles:
        """Flux within `radius` of the axis."""
        theta, weight = _scale_nodes(0.0, self.leaving_angle(radius))
        return 2.0 * np.pi * self.intensity * np.sum(weight * self.transmittance(theta) * np.sin(theta), axis=-1)

    def square_flux(self, half: float) -> float:
        """Flux on |x|, |z| <= `half`, in polar coordinates, an eighth at a time."""
        phi, weight = _scale_nodes(0.0, np.pi / 4.0)
        return float(8.0 * np.sum(weight * self.disc_flux(half / np.cos(phi))) / (2.0 * np.pi))

    def cell_flux(self, edges_x: ArrayLike, edges_z: ArrayLike) -> Doubles:
        """Flux on every cell, (nx, nz); three Gauss points a side suffice where cells are small against the height."""
        nodes, weights = np.polynomial.legendre.leggauss(3)
        x, z = np.asarray(edges_x, dtype=np.float64), np.asarray(edges_z, dtype=np.float64)
        flux = np.zeros((len(x) - 1, len(z) - 1))
        half_x, half_z = 0.5 * np.diff(x), 0.5 * np.diff(z)
        for u, wu in zip(nodes, weights, strict=True):
            for v, wv in zip(nodes, weights, strict=True):
                at_x = 0.5 * (x[1:] + x[:-1]) + u * half_x
                at_z = 0.5 * (z[1:] + z[:-1]) + v * half_z
                rho = np.hypot(at_x[:, None], at_z[None, :])
                flux += wu * wv * self.irradiance(rho)
        return flux * half_x[:, None] * half_z[None, :]


# ---- 3, 4, 5: circular mirrors ---------------------------------------------------------------------------------


def cardioid(t: ArrayLike, radius: float) -> Doubles:
    """Caustic of a source on the circle at (-radius, 0), (…, 2): oracle 4, cusp at radius/3."""
    t = np.asarray(t, dtype=np.float64)
    return radius / 3.0 * np.stack([2 * np.cos(t) - np.cos(2 * t), 2 * np.sin(t) - np.sin(2 * t)], axis=-1)


def nephroid(t: ArrayLike, radius: float) -> Doubles:
    """Caustic of parallel light along +x, (…, 2), touched by what met the wall at the angle t: oracle 3."""
    t = np.asarray(t, dtype=np.float64)
    return radius / 4.0 * np.stack([3 * np.cos(t) - np.cos(3 * t), 3 * np.sin(t) - np.sin(3 * t)], axis=-1)


def fold_flux(width: float, length: float, focal_length: float, curvature_radius: float, irradiance: float) -> float:
    """Flux of the two sheets that end at a caustic, on a strip of `width` inside it: oracle 6, W.

    The irradiance at distance s is E s' √(2/(ρ s)), E what the light would give where it does not converge.
    """
    return irradiance * focal_length * np.sqrt(2.0 / curvature_radius) * 2.0 * np.sqrt(width) * length


@dataclass(frozen=True)
class _Rays:
    """Families of reflected light, one row per direction from the light, each a line across the floor.

    Light that leaves at azimuth row i meets the wall for the last time at `points` after the horizontal length
    `wall_length` and goes on along `directions`; it lands at total horizontal length L in [low, high], which the
    slope decides. `angle` is the azimuth interval the row stands for.
    """

    points: Doubles
    directions: Doubles
    wall_length: Doubles
    low: Doubles
    high: Doubles
    cos_incident: Doubles
    focal_length: Doubles
    angle: Doubles
    bounces: int


@dataclass(frozen=True)
class MirrorCylinder:
    """A vertical mirror wall from the floor up to `wall_height`, about the origin; light at (x, height, z).

    Light coming from outside may meet the outer face, pass over the near rim, or pass over both rims.
    `color` is F0 of Schlick's reflectance per channel.
    """

    radius: float
    wall_height: float
    light: tuple[float, float, float]
    intensity: float
    color: tuple[float, float, float] = (1.0, 1.0, 1.0)

    @property
    def _distance(self) -> float:
        return float(np.hypot(self.light[0], self.light[2]))

    @property
    def _rim_factor(self) -> float:
        """Light that meets a wall at length l at rim height lands at this times l."""
        height = self.light[1]
        return height / (height - self.wall_height) if height > self.wall_height else np.inf

    def _sample_azimuths(self, count: int) -> tuple[Doubles, Doubles, Doubles]:
        """Cos α, sin α against the direction to the axis, and the azimuth interval of each of `count` rows."""
        a, radius = self._distance, self.radius
        if a > radius:
            # Even in the angle of incidence, which takes the square root at the tangents away.
            incident = -np.pi / 2 + np.pi * (np.arange(count) + 0.5) / count
            sin_alpha = radius / a * np.sin(incident)
            cos_alpha = np.sqrt(1.0 - sin_alpha**2)
            return cos_alpha, sin_alpha, radius * np.cos(incident) / (a * cos_alpha) * np.pi / count
        alpha = -np.pi + 2.0 * np.pi * (np.arange(count) + 0.5) / count
        return np.cos(alpha), np.sin(alpha), np.full(count, 2.0 * np.pi / count)

    def _trace(self, count: int, *, outer: bool, bounces: int) -> _Rays:
        a, radius = self._distance, self.radius
        light = np.array([self.light[0], self.light[2]])
        inward = -light / a
        sideways = np.array([-inward[1], inward[0]])
        cos_alpha, sin_alpha, angle = self._sample_azimuths(count)
        direction = cos_alpha[:, None] * inward + sin_alpha[:, None] * sideways
        half_chord = np.sqrt(np.maximum(radius**2 - (a * sin_alpha) ** 2, 0.0))
        near, far = a * cos_alpha - half_chord, a * cos_alpha + half_chord
        first = near if outer else far
        low, high = first, first * self._rim_factor
        if not outer and a > radius:
            low = np.maximum(low, near * self._rim_factor)  # passes over the near rim
        point = light + first[:, None] * direction
        for _ in range(bounces - 1):
            direction = self._reflect(point, direction)
            point = point + 2.0 * half_chord[:, None] * direction
        wall_length = first + 2.0 * half_chord * (bounces - 1)
        low = np.maximum(low, wall_length)
        cos_incident = half_chord / radius
        if outer:
            inverse = -2.0 / half_chord - 1.0 / first  # convex: the image is virtual
        else:
            high = np.minimum(high, wall_length + 2.0 * half_chord)  # else it meets the wall again
            inverse = 2.0 / half_chord - 1.0 / first
        return _Rays(
            points=point,
            directions=self._reflect(point, direction),
            wall_length=wall_length,
            low=low,
            high=np.maximum(high, low),
            cos_incident=cos_incident,
            focal_length=1.0 / inverse,
            angle=angle,
            bounces=bounces,
        )

    def _reflect(self, point: Doubles, direction: Doubles) -> Doubles:
        normal = point / self.radius
        return direction - 2.0 * np.sum(direction * normal, axis=1, keepdims=True) * normal

    def _find_families(self, count: int, bounces: int) -> list[_Rays]:
        families = []
        outside = self._distance > self.radius
        if not outside or np.isfinite(self._rim_factor):
            families.append(self._trace(count, outer=False, bounces=bounces))
        if outside and bounces == 1:
            families.append(self._trace(count, outer=True, bounces=1))
        return families

    def _reflectance(self, rays: _Rays, length: Doubles) -> Doubles:
        """Schlick's reflectance of all bounces together, (3, …); the slope of the light enters through L."""
        cosine = np.expand_dims(rays.cos_incident, tuple(range(1, length.ndim))) * length
        cosine /= np.sqrt(length**2 + self.light[1] ** 2)
        grazing = (1.0 - cosine) ** 5
        color = np.array(self.color).reshape(3, *(1 for _ in range(length.ndim)))
        return (color + (1.0 - color) * grazing) ** rays.bounces

    def total_flux(self, bounces: int = 1, *, count: int = 20_000) -> Doubles:
        """Flux that reaches the floor after exactly `bounces` reflections, (3,)."""
        total = np.zeros(3)
        height = self.light[1]
        for rays in self._find_families(count, bounces):
            length, weight = _scale_nodes(rays.low, rays.high)
            density = height * length / (length**2 + height**2) ** 1.5
            total += np.einsum("cij,ij,i->c", self._reflectance(rays, length), weight * density, rays.angle)
        return self.intensity * total

    def cell_flux(self, edges_x: ArrayLike, edges_z: ArrayLike, *, bounces: int = 1, count: int = 20_000) -> Doubles:
        """Flux on every cell after `bounces` reflections, (3, nx, nz): exact along lines, midpoint rule across."""
        x, z = np.asarray(edges_x, dtype=np.float64), np.asarray(edges_z, dtype=np.float64)
        shape = (len(x) - 1, len(z) - 1)
        flux = np.zeros((3, shape[0] * shape[1]))
        for rays in self._find_families(count, bounces):
            lit = np.flatnonzero(rays.high > rays.low)
            for rows in np.array_split(lit, max(1, len(lit) // 1000)):  # a thousand lines fit the cache
                self._add_lines(flux, rays, rows, x, z)
        return self.intensity * flux.reshape(3, *shape)

    def _add_lines(self, flux: Doubles, rays: _Rays, rows: NDArray[np.int64], x: Doubles, z: Doubles) -> None:
        point, direction = rays.points[rows], rays.directions[rows]
        wall, low, high = rays.wall_length[rows, None], rays.low[rows, None], rays.high[rows, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            cuts = [
                (edges - point[:, axis, None]) / direction[:, axis, None] + wall for axis, edges in enumerate((x, z))
            ]
        lengths = np.concatenate([low, *cuts, high], axis=1)
        lengths = np.sort(np.clip(np.nan_to_num(lengths, nan=0.0), low, high), axis=1)
        middle = 0.5 * (lengths[:, 1:] + lengths[:, :-1])
        at = point[:, None, :] + direction[:, None, :] * (middle - wall)[..., None]
        ix, iz = np.searchsorted(x, at[..., 0]) - 1, np.searchsorted(z, at[..., 1]) - 1
        inside = (ix >= 0) & (ix < len(x) - 1) & (iz >= 0) & (iz < len(z) - 1) & (lengths[:, 1:] > lengths[:, :-1])
        height = self.light[1]
        share = -np.diff(height / np.hypot(lengths, height), axis=1) * rays.angle[rows, None]
        picked = _Rays(**{**rays.__dict__, "cos_incident": rays.cos_incident[rows]})
        reflectance = self._reflectance(picked, middle)
        cell = (ix * (len(z) - 1) + iz)[inside]
        for channel in range(3):
            flux[channel] += np.bincount(cell, (share * reflectance[channel])[inside], minlength=flux.shape[1])

    def irradiance(self, points: ArrayLike, *, count: int = 20_000) -> Doubles:
        """Irradiance at floor points (n, 2) after one reflection, (n, 3): oracle 5, summed over wall angles."""
        where = np.asarray(points, dtype=np.float64)
        result = np.zeros((len(where), 3))
        for rays in self._find_families(count, 1):
            for row, target in enumerate(where):
                result[row] += self._sum_reflections(rays, target)
        return self.intensity * result

    def _sum_reflections(self, rays: _Rays, target: Doubles) -> Doubles:
        to = target - rays.points
        miss = to[:, 0] * rays.directions[:, 1] - to[:, 1] * rays.directions[:, 0]
        along = np.sum(to * rays.directions, axis=1)
        crosses = (miss[:-1] * miss[1:] <= 0.0) & (along[:-1] > 0.0) & (along[1:] > 0.0)
        before = np.flatnonzero(crosses)
        # Neighboring rows are so close that everything is linear between them.
        t = miss[before] / (miss[before] - miss[before + 1])

        def blend(values: Doubles) -> Doubles:
            return values[before] * (1.0 - t) + values[before + 1] * t

        beyond = blend(along)
        first = blend(rays.wall_length)
        length = first + beyond
        lit = (length >= blend(rays.low)) & (length <= blend(rays.high))
        height = self.light[1]
        spread = length / (first * np.abs(1.0 - beyond / blend(rays.focal_length)))
        share = np.where(lit, height / (height**2 + length**2) ** 1.5 * spread, 0.0)
        picked = _Rays(**{**rays.__dict__, "cos_incident": blend(rays.cos_incident)})
        return np.sum(self._reflectance(picked, length) * share, axis=1)

    def caustic_curve(self, *, count: int = 20_000) -> Doubles:
        """Points of the caustic on the floor that light reaches, (n, 2), in the order of the wall."""
        rays = self._trace(count, outer=False, bounces=1)
        length = rays.wall_length + rays.focal_length
        lit = (rays.focal_length > 0.0) & (length >= rays.low) & (length <= rays.high)
        return (rays.points + rays.directions * rays.focal_length[:, None])[lit]

    def find_caustic_cells(self, edges_x: ArrayLike, edges_z: ArrayLike, *, margin: int = 2) -> NDArray[np.bool_]:
        """Cells within `margin` cells of the caustic, (nx, nz), where no bin is smooth."""
        x, z = np.asarray(edges_x, dtype=np.float64), np.asarray(edges_z, dtype=np.float64)
        mask = np.zeros((len(x) - 1, len(z) - 1), dtype=bool)
        curve = self.caustic_curve()
        ix, iz = np.searchsorted(x, curve[:, 0]) - 1, np.searchsorted(z, curve[:, 1]) - 1
        for dx in range(-margin, margin + 1):
            for dz in range(-margin, margin + 1):
                jx, jz = ix + dx, iz + dz
                inside = (jx >= 0) & (jx < mask.shape[0]) & (jz >= 0) & (jz < mask.shape[1])
                mask[jx[inside], jz[inside]] = True
        return mask


# ---- 7: ball lens ----------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class BallLens:
    """A ball of `radius` and `ior` about (0, `distance`, 0), parallel light of `irradiance` straight down.

    Light that is refracted twice; b is its distance from the axis where it comes from, y where it lands, below 0 on
    the other side.
    """

    radius: float
    ior: float
    distance: float
    irradiance: float

    def landing(self, b: ArrayLike) -> Doubles:
        """Where light lands; inf where it never does."""
        turn, away = self._bend(b)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(turn < np.pi / 2.0, (away - self.distance * np.sin(turn)) / np.cos(turn), np.inf)

    def _bend(self, b: ArrayLike) -> tuple[Doubles, Doubles]:
        away = np.asarray(b, dtype=np.float64)
        return 2.0 * (np.arcsin(away / self.radius) - np.arcsin(away / (self.radius * self.ior))), away

    def transmittance(self, b: ArrayLike) -> Doubles:
        """Share that passes both faces."""
        sine = np.asarray(b, dtype=np.float64) / self.radius
        return (1.0 - fresnel_reflectance(np.sqrt(1.0 - sine**2), self.ior)) ** 2

    @property
    def focus(self) -> float:
        """Paraxial focus, m behind the middle."""
        return self.radius * self.ior / (2.0 * (self.ior - 1.0))

    def find_flux(self, edges: ArrayLike, *, count: int = 4_000_000) -> Doubles:
        """Flux on each annulus between radii of the floor: the midpoint rule over equal areas of the light."""
        b = self.radius * np.sqrt((np.arange(count) + 0.5) / count)
        flux = self.irradiance * np.pi * self.radius**2 / count * self.transmittance(b)
        return np.histogram(np.abs(self.landing(b)), np.asarray(edges, dtype=np.float64), weights=flux)[0]

    def irradiance_at(self, rho: float, *, count: int = 200_000) -> float:
        """Irradiance at distance `rho` > 0 from the axis: E Σ T b/(ρ |dy/db|) over all b that land there."""
        b = self.radius * (np.arange(count) + 0.5) / count
        y = self.landing(b)
        total = 0.0
        for side in (rho, -rho):
            off = y - side
            for i in np.flatnonzero((off[:-1] * off[1:] <= 0.0) & np.isfinite(off[:-1]) & np.isfinite(off[1:])):
                slope = abs(y[i + 1] - y[i]) / (b[i + 1] - b[i])
                total += float(self.transmittance(b[i]) * b[i] / (rho * slope))
        return self.irradiance * total
