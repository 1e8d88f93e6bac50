// SPDX-License-Identifier: Apache-2.0
// Normals of triangles and of transformed surfaces, safe from under- and overflow.
#pragma once

#include <optional>

#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

namespace photonloupe {

// Twice the triangle's area times its normal. Exactly zero only for triangles without area
// (as long as the corners' coordinates lie within 2^29 of each other, so that edges are exact in double).
glm::dvec3 compute_area_vector(const glm::vec3& v0, const glm::vec3& v1, const glm::vec3& v2);

// Unit vector; nothing for the zero vector and vectors that are not finite.
std::optional<glm::dvec3> normalize_robustly(const glm::dvec3& v);

// Carries normals through a linear map: the inverse transpose, up to a positive factor.
class NormalTransform {
public:
    explicit NormalTransform(const glm::dmat3& linear);

    bool is_mirrored() const { return m_is_mirrored; }
    glm::dvec3 apply(const glm::dvec3& normal) const { return m_matrix * normal; }

private:
    glm::dmat3 m_matrix;
    bool m_is_mirrored;
};

} // namespace photonloupe
