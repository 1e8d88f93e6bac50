// SPDX-License-Identifier: Apache-2.0
// Two-dimensional principal components in closed form, in double precision.
#include "inspect/spread.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace photonloupe::inspect {
namespace {

struct Tangents {
    glm::dvec3 u, v;
};

// Without a branch (Duff et al., JCGT 6(1), 2017).
Tangents build_tangents(const glm::dvec3& n) {
    const double sign = n.z < 0 ? -1.0 : 1.0;
    const double a = -1.0 / (sign + n.z), b = n.x * n.y * a;
    return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}};
}

} // namespace

Spread measure_spread(std::span<const glm::vec3> points, const glm::vec3& normal) {
    const Tangents plane = build_tangents(glm::dvec3(normal));
    const double count = static_cast<double>(std::max<std::size_t>(points.size(), 1));
    // Counted from one of them: of points in one place nothing is left, where rounding would leave a direction.
    const glm::dvec3 base(points.empty() ? glm::vec3(0.0f) : points[0]);
    glm::dvec3 mean(0.0);
    for (const glm::vec3& point : points)
        mean += (glm::dvec3(point) - base) / count;
    double uu = 0, uv = 0, vv = 0;
    for (const glm::vec3& point : points) {
        const glm::dvec3 away = glm::dvec3(point) - base - mean;
        const double u = glm::dot(away, plane.u), v = glm::dot(away, plane.v);
        uu += u * u / count;
        uv += u * v / count;
        vv += v * v / count;
    }
    const double middle = 0.5 * (uu + vv), reach = std::hypot(0.5 * (uu - vv), uv);
    const double greater = middle + reach;
    // The product of the eigenvalues over the greater one: their difference would lose the small one's digits.
    const double less = greater > 0 ? std::max((uu * vv - uv * uv) / greater, 0.0) : 0.0;
    const double angle = 0.5 * std::atan2(2 * uv, uu - vv);
    Spread spread{static_cast<float>(greater), static_cast<float>(less)};
    spread.along = glm::vec3(std::cos(angle) * plane.u + std::sin(angle) * plane.v);
    spread.across = glm::vec3(-std::sin(angle) * plane.u + std::cos(angle) * plane.v);
    if (points.size() >= 2 && greater > 0)
        spread.isotropy = static_cast<float>(std::sqrt(less / greater));
    return spread;
}

} // namespace photonloupe::inspect
