// SPDX-License-Identifier: Apache-2.0
// The periodogram of points in a rectangle, by direct summation on the device: what measures of blue noise start from.
#pragma once

#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "core/progress.h"
#include "gpu/device.h"

namespace photonloupe::inspect {

// Power at whole frequencies; that of −k equals that of k, so only one of the two is there, and k = 0 is left out.
struct Spectrum {
    std::vector<glm::ivec2> frequencies; // cycles over each side, rows of y upwards
    std::vector<double> power;           // |Σ_j exp(−2πi k·x_j)|² / point count: 1 on average for random points
};

// At larger frequencies the rounding of coordinates, 2^-30 of a side, would show in the fourth digit.
inline constexpr double MAX_SPECTRUM_RADIUS = 4096.0;

// Points are given in sides of the rectangle, [0, 1]², and repeat beyond it. Sums keep a fixed order.
Spectrum measure_spectrum(gpu::Device& device, std::span<const glm::dvec2> points, glm::dvec2 radius,
                          const Progress& progress = {});

} // namespace photonloupe::inspect
