// SPDX-License-Identifier: Apache-2.0
// How evenly photons lie, whatever their density: what the studio plots for each step of a relaxation.
#pragma once

#include <cstdint>
#include <limits>
#include <span>

namespace photonloupe {

inline constexpr std::uint32_t EVENNESS_SAMPLE = 1000;   // photons looked at
inline constexpr std::uint32_t EVENNESS_NEIGHBORS = 101; // distances of each, nearest first

struct Evenness {
    // Variance of log r₂₅² - 2 log r₅₀² + log r₁₀₀², r_k the distance to the k-th neighbour, over its value for random
    // points, ψ₁(25) - ψ₁(100): 1 for white noise. A density that rises as a power of the distance drops out.
    double low_frequency = std::numeric_limits<double>::quiet_NaN();
    // Relative deviation of the Epanechnikov estimate of 20 photons from that of 100.
    double noise = std::numeric_limits<double>::quiet_NaN();
};

// Of rows of EVENNESS_NEIGHBORS distances each; by medians, so that few edges don't count. NaN with fewer than 200
// rows.
Evenness measure_evenness(std::span<const float> distances);

} // namespace photonloupe
