# SPDX-License-Identifier: Apache-2.0
"""What one looks at: computed as numbers and drawn as pictures."""

from photonloupe.inspect.parallel_axes import Axis
from photonloupe.inspect.parallel_coordinates import AxisDensity, ParallelCoordinates, parallel_coordinates

__all__ = ["Axis", "AxisDensity", "ParallelCoordinates", "parallel_coordinates"]
