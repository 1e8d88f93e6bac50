// SPDX-License-Identifier: Apache-2.0
// How points spread in a tangent plane: principal axes and their ratio ([SJL15] eq. 5).
#pragma once

#include <limits>
#include <span>

#include <glm/vec3.hpp>

namespace photonloupe::inspect {

// Moments about the mean, divided by the number of points.
struct Spread {
    float along_variance = 0;    // λ1, m²
    float across_variance = 0;   // λ2 ≤ λ1
    glm::vec3 along{}, across{}; // unit eigenvectors, in the plane; along × across is the normal
    float isotropy =
        std::numeric_limits<float>::quiet_NaN(); // t = √(λ2/λ1); NaN: fewer than two points, or all in one place
};

Spread measure_spread(std::span<const glm::vec3> points, const glm::vec3& normal);

} // namespace photonloupe::inspect
