// SPDX-License-Identifier: Apache-2.0
// Cross products with one rounding, normalization by powers of two, cofactor matrices.
#include "scene/triangle_math.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace photonloupe {
namespace {

// ab - cd within 1.5 ulp (Kahan), so never 0 unless the products are equal.
double subtract_products(double a, double b, double c, double d) {
    const double cd = c * d;
    const double error = std::fma(-c, d, cd);
    return std::fma(a, b, -cd) + error;
}

double find_largest(const glm::dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

// The power of two that brings `value` to [0.5, 1): scaling by it is exact.
double find_scale(double value) {
    int exponent = 0;
    std::frexp(value, &exponent);
    return std::ldexp(1.0, std::clamp(-exponent, -1022, 1022));
}

} // namespace

glm::dvec3 compute_area_vector(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2) {
    const glm::dvec3 a = glm::dvec3(v1) - glm::dvec3(v0);
    const glm::dvec3 b = glm::dvec3(v2) - glm::dvec3(v0);
    return {subtract_products(a.y, b.z, a.z, b.y), subtract_products(a.z, b.x, a.x, b.z),
            subtract_products(a.x, b.y, a.y, b.x)};
}

std::optional<glm::dvec3> normalize_robustly(const glm::dvec3& v) {
    const double largest = find_largest(v);
    if (!(largest > 0.0) || !std::isfinite(largest))
        return std::nullopt;
    const glm::dvec3 scaled = v * find_scale(largest);
    const double length = std::sqrt(glm::dot(scaled, scaled));
    if (!std::isfinite(length)) // NaN beside a component that is none
        return std::nullopt;
    return scaled / length;
}

NormalTransform::NormalTransform(const glm::dmat3& linear) {
    const double largest = std::max({find_largest(linear[0]), find_largest(linear[1]), find_largest(linear[2])});
    const glm::dmat3 m = linear * (largest > 0.0 ? find_scale(largest) : 1.0);
    const glm::dmat3 cofactors{glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
    m_is_mirrored = glm::dot(m[0], cofactors[0]) < 0;
    m_matrix = m_is_mirrored ? -cofactors : cofactors;
}

} // namespace photonloupe
