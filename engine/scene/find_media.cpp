// SPDX-License-Identifier: Apache-2.0
// Goes from the place straight out of the scene: a back that no front came before belongs to what the place is in.
#include "scene/find_media.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <glm/geometric.hpp>

namespace photonloupe {
namespace {

// Along no edge or diagonal that anybody models.
const glm::dvec3 OUTWARD =
    glm::normalize(glm::dvec3(0.5257311, 0.7236068, 0.4472136) + glm::dvec3(0.0137, 0.0071, 0.0193));

struct Crossing {
    double distance = 0;
    std::uint32_t triangle = 0;
    std::uint32_t object = 0;
    bool is_back = false;
};

// Möller and Trumbore 1997, in double.
bool meet(const glm::dvec3& place, const glm::dvec3& v0, const glm::dvec3& v1, const glm::dvec3& v2,
          Crossing& crossing) {
    const glm::dvec3 e1 = v1 - v0, e2 = v2 - v0, p = glm::cross(OUTWARD, e2), s = place - v0, q = glm::cross(s, e1);
    const double determinant = glm::dot(e1, p);
    const double u = glm::dot(s, p) / determinant, v = glm::dot(OUTWARD, q) / determinant;
    crossing.distance = glm::dot(e2, q) / determinant;
    crossing.is_back = determinant < 0;
    return u >= 0 && v >= 0 && u + v <= 1 && crossing.distance > 0; // false for NaN: a triangle seen edge-on
}

std::vector<Crossing> list_crossings(const Scene& scene, const glm::dvec3& place) {
    std::vector<Crossing> crossings;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
        const shared::Triangle& triangle = scene.triangles[i];
        if (!is_solid(scene.materials[find_material(triangle)]))
            continue;
        Crossing crossing{0, static_cast<std::uint32_t>(i), std::bit_cast<std::uint32_t>(triangle.v0_object.w)};
        if (meet(place, glm::dvec3(triangle.v0_object), glm::dvec3(triangle.v1_material),
                 glm::dvec3(triangle.v2_source), crossing))
            crossings.push_back(crossing);
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.distance < b.distance; });
    return crossings;
}

} // namespace

shared::Media find_media(const Scene& scene, const glm::dvec3& place) {
    if (!scene.report.has_media)
        return {0, 0};
    std::vector<std::uint32_t> entered, left; // objects that the way goes into, boundaries of those it began in
    for (const Crossing& crossing : list_crossings(scene, place)) {
        const auto own = std::find(entered.begin(), entered.end(), crossing.object);
        if (!crossing.is_back)
            entered.push_back(crossing.object);
        else if (own != entered.end())
            entered.erase(own);
        else
            left.push_back(crossing.triangle + 1);
    }
    return {left.empty() ? 0 : left[0], left.size() < 2 ? 0 : left[1]};
}

} // namespace photonloupe
