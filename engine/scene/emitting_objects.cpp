// SPDX-License-Identifier: Apache-2.0
// Gathers emitting triangles by object, with the shares of their areas.
#include "scene/emitting_objects.h"

#include <algorithm>
#include <bit>

#include <glm/geometric.hpp>

#include "scene/triangle_math.h"

namespace photonloupe {
namespace {

double find_area(const shared::Triangle& triangle) {
    return 0.5 * glm::length(compute_area_vector(triangle.v0_object, triangle.v1_material, triangle.v2_source));
}

bool emits(const shared::Material& material) {
    const glm::vec4& emission = material.emission_transmission;
    return std::max({emission.x, emission.y, emission.z}) > 0;
}

} // namespace

void list_emitting_objects(Scene& scene) {
    std::vector<std::vector<std::uint32_t>> triangles(scene.objects.size());
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const std::uint32_t object = std::bit_cast<std::uint32_t>(scene.triangles[i].v0_object.w);
        if (emits(scene.materials[scene.objects[object].material]))
            triangles[object].push_back(i);
    }
    for (std::size_t object = 0; object < triangles.size(); ++object) {
        double total = 0, before = 0;
        for (const std::uint32_t i : triangles[object])
            total += find_area(scene.triangles[i]);
        if (!(total > 0))
            continue;
        const shared::Material& material = scene.materials[scene.objects[object].material];
        const auto first = static_cast<std::uint32_t>(scene.emitting.size());
        glm::dvec3 center(0.0);
        for (const std::uint32_t i : triangles[object]) {
            const shared::Triangle& triangle = scene.triangles[i];
            const double area = find_area(triangle);
            before += area;
            center +=
                (glm::dvec3(triangle.v0_object) + glm::dvec3(triangle.v1_material) + glm::dvec3(triangle.v2_source)) *
                (area / (3 * total));
            scene.emitting.push_back({{glm::vec3(triangle.v0_object), static_cast<float>(before / total)},
                                      {glm::vec3(triangle.v1_material), 0.0f},
                                      {glm::vec3(triangle.v2_source), 0.0f}});
        }
        scene.emitting.back().v0_cumulative.w = 1.0f;
        const auto count = static_cast<std::uint32_t>(triangles[object].size());
        const float sides = is_two_sided(material) ? 2.0f : 1.0f;
        scene.lights.push_back(
            {{glm::vec3(center), std::bit_cast<float>(shared::LIGHT_AREA)},
             {glm::vec3(material.emission_transmission), 0.0f},
             {0.0f, 0.0f, 0.0f, 0.0f},
             {static_cast<float>(total), std::bit_cast<float>(first), std::bit_cast<float>(count), sides}});
        scene.light_names.push_back(scene.objects[object].name);
    }
}

} // namespace photonloupe
