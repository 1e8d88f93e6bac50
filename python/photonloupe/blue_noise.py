# SPDX-License-Identifier: Apache-2.0
"""How blue the noise of points is: their spectrum, their spacing, how evenly they fill windows (METHODS section 10)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from photonloupe import _engine
from photonloupe.checks import check_number, check_vectors
from photonloupe.device import Device, open_device
from photonloupe.errors import ArgumentError
from photonloupe.point_counts import measure_count_variance
from photonloupe.point_spacing import Doubles, PointDomain, compute_packing_distance, find_least_distance
from photonloupe.progress import ProgressLike, follow_progress

# Below it the power tells relaxed points from random ones (METHODS section 3).
LOW_FREQUENCY = 0.25
# Three times the first peak of a blue noise.
DEFAULT_FREQUENCY = 3.0
FREQUENCY_RANGE = (1e-3, 1e3)
# Points times frequencies that are measured when nothing is said: some 10 s on the software device with two cores.
DEFAULT_WORK = 5e9
# Sums, frequencies and power take 36 bytes each.
MAX_FREQUENCY_COUNT = 2**24
# The engine's MAX_SPECTRUM_RADIUS.
MAX_CYCLES = 4_096


@dataclass(frozen=True)
class BlueNoise:
    """How evenly points lie; for random points (white noise) every power and variance is 1.

    Attributes
    ----------
    frequency
        (bins,) middle of each ring of frequencies, in cycles per mean spacing 1/√density: dimensionless, so that
        a hexagonal lattice has its first peak at √(2/√3) ≈ 1.0746. A ring is one cycle over √area wide.
    power
        (bins,) radially averaged power: mean over the ring of P(k) = |Σ_j exp(−2πi k·x_j)|² / n; k = 0 is left out.
    anisotropy
        (bins,) s²/power², s² = Σ (P − power)²/(m − 1) over the m frequencies of the ring's half plane: 1 for noise
        without direction (10·log₁₀: 0 dB), more where the ring has peaks, 0 where it is all alike.
    relative_radius
        Least distance of two points over that of the hexagonal lattice of the same density,
        2 r_max = √(2/(√3 density)): 1 is the largest possible, 0 means that points coincide.
    low_frequency_power
        Mean P(k) over the frequencies below 0.25: relaxed photons reach 0.02 to 0.035. None where there is no such
        frequency (fewer than 17 points in a square) or `frequencies` ended before.
    window_count
        (windows,) points expected in the windows of `count_variance`, which are discs: of 1, 4, 16, 64 those of which
        two discs fit along either side.
    count_variance
        (windows,) variance of the number of points in windows over its mean, corrected for their finite share of the
        domain so that random points have 1.
    """

    frequency: Doubles
    power: Doubles
    anisotropy: Doubles
    relative_radius: float
    low_frequency_power: float | None
    window_count: Doubles
    count_variance: Doubles


def measure_blue_noise(
    points: ArrayLike,
    *,
    period: ArrayLike | None = None,
    frequencies: float | None = None,
    device: Device | int | str | None = None,
    progress: ProgressLike = None,
) -> BlueNoise:
    """Measure how evenly points fill a rectangle.

    Parameters
    ----------
    points
        (n, 2) in m; anywhere, at any scale.
    period
        (2,) sides in m of the rectangle that the points repeat with. By default the domain is the points' bounding
        rectangle and does not repeat; a lattice then seems denser than it is, by the half spacings cut off around it.
    frequencies
        Largest frequency to measure, in the unit of `BlueNoise.frequency`. By default 3; less where that takes
        more than 5·10⁹ waves (beyond some 19,000 points) or more than 4,096 cycles over a side, but never under 0.25.
        The work grows with its square and with that of n.
    device
        A `Device`, its name or index; default the best there is.
    progress
        True for a bar with the time left, or a callback ``(stage, fraction)`` that returns False to stop.

    Returns
    -------
    BlueNoise

    Raises
    ------
    ArgumentError
        If a point is not finite, there is none, the domain has no area, or `frequencies` asks for more than the
        engine offers.
    DeviceError
        If no device is usable.

    Notes
    -----
    The periodogram and its radial mean and anisotropy are those of Ulichney, "Dithering with Blue Noise" (Proc. IEEE
    76, 1988); the relative radius that of Lagae and Dutré, "A Comparison of Methods for Generating Poisson Disk
    Distributions" (CGF 27, 2008).

    Examples
    --------
    >>> import numpy as np, photonloupe as pl
    >>> grid = np.stack(np.meshgrid(np.arange(16.0), np.arange(16.0)), axis=-1).reshape(-1, 2)
    >>> noise = pl.measure_blue_noise(grid, period=(16, 16))
    >>> float(noise.frequency[np.argmax(noise.power)]), round(noise.relative_radius, 4)
    (1.0, 0.9306)
    """
    domain = _find_domain(check_vectors("points", points, width=2), period)
    rings = _choose_rings(domain, frequencies)
    opened = open_device(device)
    with follow_progress(progress) as callback:
        radius = (rings + 0.5) * domain.sides
        waves, power = _engine.measure_spectrum(opened._native, domain.points, radius.tolist(), callback)
    count = len(domain.points)
    cycles = np.sqrt(np.square(np.asarray(waves) / domain.sides).sum(axis=1))
    windows, variance = measure_count_variance(domain)
    return BlueNoise(
        *_average_rings(cycles, np.asarray(power), rings, count),
        relative_radius=find_least_distance(domain) / compute_packing_distance(count),
        low_frequency_power=_average_low(cycles / np.sqrt(count), np.asarray(power), (rings + 0.5) / np.sqrt(count)),
        window_count=windows,
        count_variance=variance,
    )


def _find_domain(points: Doubles, period: ArrayLike | None) -> PointDomain:
    if len(points) == 0:
        raise ArgumentError("points has no rows; a spectrum needs at least one point")
    with np.errstate(over="ignore"):
        local = points - points.min(axis=0)
    size = local.max(axis=0) if period is None else _check_period(period)
    if not np.isfinite(local).all():
        raise ArgumentError("points lie farther apart than a double can say; scale them down")
    if not size.all():
        raise ArgumentError(f"the {len(points)} points span no area; give the domain with period=")
    inside = local if period is None else np.fmod(local, size)
    # The product of the sides need not be a double; beyond what doubles hold, the choice of frequencies refuses.
    with np.errstate(over="ignore", divide="ignore"):
        aspect = np.sqrt(size[0]) / np.sqrt(size[1])
        sides = np.array((aspect, 1.0 / aspect))
    return PointDomain(np.ascontiguousarray(inside / size), sides, period is not None)


def _check_period(period: ArrayLike) -> Doubles:
    try:
        size = np.asarray(period, dtype=np.float64)
    except (TypeError, ValueError):
        raise ArgumentError("period must be two numbers, the sides of the domain") from None
    if size.shape != (2,) or not np.isfinite(size).all() or (size <= 0.0).any():
        raise ArgumentError(f"period must be two finite sides above 0, not {period!r}")
    return size


def _choose_rings(domain: PointDomain, frequencies: float | None) -> int:
    """Return how many rings of frequencies to measure."""
    count = len(domain.points)
    if frequencies is None:
        # Frequencies of a half disc: π/2 n f².
        affordable = np.sqrt(2.0 / np.pi * DEFAULT_WORK) / count
        offered = (MAX_CYCLES / domain.sides.max() - 1.0) / np.sqrt(count)
        largest = min(DEFAULT_FREQUENCY, max(LOW_FREQUENCY, min(affordable, offered)))
    else:
        largest = check_number("frequencies", frequencies, *FREQUENCY_RANGE)
    rings = max(1, round(largest * np.sqrt(count)))
    wave_count = np.pi / 2.0 * (rings + 0.5) ** 2
    if wave_count > MAX_FREQUENCY_COUNT:
        fit = np.sqrt(2.0 / np.pi * MAX_FREQUENCY_COUNT / count)
        raise ArgumentError(
            f"frequencies up to {largest:g} are {wave_count:.3g} for {count} points, more than {MAX_FREQUENCY_COUNT}; "
            f"up to {fit:.3g} would fit"
        )
    if (rings + 0.5) * domain.sides.max() > MAX_CYCLES:
        raise ArgumentError(
            f"the domain is too long for its width: frequencies up to {largest:g} have more than {MAX_CYCLES} cycles "
            "over its length; ask for lower ones or cut it into shorter pieces"
        )
    return rings


def _average_rings(cycles: Doubles, power: Doubles, rings: int, count: int) -> tuple[Doubles, Doubles, Doubles]:
    """Average over rings one cycle wide: frequency, power, anisotropy."""
    ring = np.floor(cycles + 0.5).astype(np.int64)
    inside = (ring >= 1) & (ring <= rings)
    ring, power = ring[inside] - 1, power[inside]
    members = np.bincount(ring, minlength=rings)
    mean = np.bincount(ring, power, minlength=rings) / np.maximum(members, 1)
    variance = np.bincount(ring, np.square(power - mean[ring]), minlength=rings) / np.maximum(members - 1, 1)
    anisotropy = np.divide(variance, np.square(mean), out=np.zeros(rings), where=mean > 0.0)
    return np.arange(1, rings + 1) / np.sqrt(count), mean, anisotropy


def _average_low(frequency: Doubles, power: Doubles, measured: float) -> float | None:
    low = frequency < LOW_FREQUENCY
    return float(power[low].mean()) if low.any() and measured >= LOW_FREQUENCY else None
