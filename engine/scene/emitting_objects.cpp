// SPDX-License-Identifier: Apache-2.0
// Gathers emitting triangles by object, with the shares of their power.
#include "scene/emitting_objects.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "scene/load_textures.h"
#include "scene/triangle_math.h"

namespace photonloupe {
namespace {

// Textured lamps' triangles are split until a part is about this many texels wide, or there are this many parts of all
// lamps.
constexpr double TEXELS_OF_A_PART = 2.0;
constexpr std::size_t MOST_PARTS = 1u << 16;
constexpr int MOST_LEVELS = 8;
// A part's radiance is the mean of the texture at the middles of this many triangles, a power of 4.
constexpr int SAMPLE_LEVELS = 2;
// Tints this near to white are rounding.
constexpr float SAME_COLOR = 1e-5f;

using Corners = std::array<glm::dvec3, 3>; // weights of a triangle's own corners

bool emits(const shared::Material& material) {
    const glm::vec4& emission = material.emission_transmission;
    return std::max({emission.x, emission.y, emission.z}) > 0;
}

// Into 4^levels equal parts.
template <class Use>
void split(const Corners& corners, int levels, const Use& use) {
    if (levels == 0)
        return use(corners);
    const auto& [a, b, c] = corners;
    const glm::dvec3 ab = 0.5 * (a + b), bc = 0.5 * (b + c), ca = 0.5 * (c + a);
    for (const Corners& part : {Corners{a, ab, ca}, Corners{ab, b, bc}, Corners{ca, bc, c}, Corners{bc, ca, ab}})
        split(part, levels - 1, use);
}

// What one object emits, part by part.
class Lamp {
public:
    // `most_parts`: what textured triangles may be split into.
    Lamp(const Scene& scene, const std::vector<std::uint32_t>& triangles, std::size_t most_parts)
        : m_most_parts(most_parts), m_is_large(triangles.size() > most_parts), m_scene(scene),
          m_material_index(find_material(scene.triangles[triangles.front()])),
          m_material(scene.materials[m_material_index]),
          m_texture(scene.paints.empty() ? 0.0f : scene.paints[m_material_index].colors.w),
          m_alpha_texture(scene.paints.empty() ? 0.0f : scene.paints[m_material_index].colors.x) {
        for (const std::uint32_t triangle : triangles)
            split({glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)},
                  choose_levels(triangle, triangles.size()), [&](const Corners& part) { add_part(triangle, part); });
    }

    // The light, and its triangles appended to the scene's; nothing if it is dark everywhere.
    bool finish(Scene& scene) const {
        if (!(m_weight > 0))
            return false;
        const auto first = static_cast<std::uint32_t>(scene.emitting.size());
        double before = 0;
        for (const Part& part : m_parts) {
            before += part.weight;
            scene.emitting.push_back({{part.corners[0], static_cast<float>(before / m_weight)},
                                      {part.corners[1], 0.0f},
                                      {part.corners[2], 0.0f},
                                      {find_tint(part), 0.0f}});
            const glm::vec3 tint(scene.emitting.back().tint);
            scene.report.has_colored_lamps |= glm::distance(tint, glm::vec3(1.0f)) > SAME_COLOR && is_uneven();
        }
        scene.emitting.back().v0_cumulative.w = 1.0f;
        const auto count = static_cast<std::uint32_t>(m_parts.size());
        const float sides = is_two_sided(m_material) ? 2.0f : 1.0f;
        scene.lights.push_back(
            {{glm::vec3(m_center / m_weight), std::bit_cast<float>(shared::LIGHT_AREA)},
             {glm::vec3(m_power / m_area), 0.0f},
             {0.0f, 0.0f, 0.0f, 0.0f},
             {static_cast<float>(m_area), std::bit_cast<float>(first), std::bit_cast<float>(count), sides}});
        return true;
    }

private:
    struct Part {
        std::array<glm::vec3, 3> corners;
        double weight;         // area times the largest channel of its radiance
        glm::dvec3 color{0.0}; // its radiance over the largest channel
    };

    // All parts together carry the light's mean, each chosen by its weight.
    glm::vec3 find_tint(const Part& part) const {
        glm::vec3 tint(1.0f);
        for (int channel = 0; channel < 3 && is_uneven(); ++channel)
            tint[channel] = m_power[channel] > 0 ? float(part.color[channel] * m_weight / m_power[channel]) : 0.0f;
        return tint;
    }

    // How often a triangle is split in four: as far as its texture's texels ask for.
    int choose_levels(std::uint32_t triangle, std::size_t count) const {
        const float number = m_texture > 0 ? m_texture : has_alpha() ? m_alpha_texture : 0.0f;
        if (number == 0)
            return 0;
        const shared::Texture& texture = m_scene.textures[static_cast<std::size_t>(number) - 1];
        const shared::CornerCoordinates& corners = m_scene.corner_coordinates[triangle];
        const glm::vec4 span = glm::max(glm::abs(corners.c1 - corners.c0), glm::abs(corners.c2 - corners.c0));
        const bool is_second = texture.place.w & shared::TEXTURE_SECOND_COORDINATES;
        const glm::vec2 uv = is_second ? glm::vec2(span.z, span.w) : glm::vec2(span.x, span.y);
        const double texels =
            std::max((std::abs(texture.to_u.x) * uv.x + std::abs(texture.to_u.y) * uv.y) * texture.place.y,
                     (std::abs(texture.to_v.x) * uv.x + std::abs(texture.to_v.y) * uv.y) * texture.place.z);
        int levels = 0;
        while (levels < MOST_LEVELS && texels / std::exp2(levels) > TEXELS_OF_A_PART &&
               (count << 2 * (levels + 1)) <= m_most_parts)
            ++levels;
        return levels;
    }

    bool has_alpha() const { return m_material.alpha.y != shared::ALPHA_OPAQUE; }
    // Of what the surface's radiance and coverage depend on there.
    bool is_uneven() const { return m_texture > 0 || has_alpha(); }

    // Share of the light that alpha leaves.
    double find_coverage(std::uint32_t triangle, const glm::dvec3& weights) const {
        double alpha = m_material.alpha.x;
        if (m_alpha_texture > 0)
            alpha *= sample_texture(m_scene, m_alpha_texture, triangle, weights).w;
        if (!m_scene.corner_colors.empty()) {
            const shared::CornerColors& colors = m_scene.corner_colors[triangle];
            alpha *= weights.x * colors.c0.w + weights.y * colors.c1.w + weights.z * colors.c2.w;
        }
        if (m_material.alpha.y == shared::ALPHA_MASK)
            return alpha >= m_material.alpha.z ? 1.0 : 0.0;
        return std::clamp(alpha, 0.0, 1.0);
    }

    glm::dvec3 find_radiance(std::uint32_t triangle, const Corners& part) const {
        const glm::dvec3 factor(m_material.emission_transmission);
        if (!is_uneven())
            return factor;
        glm::dvec3 sum(0.0);
        int count = 0;
        split(part, m_is_large ? 0 : SAMPLE_LEVELS, [&](const Corners& piece) {
            const glm::dvec3 middle = (piece[0] + piece[1] + piece[2]) / 3.0;
            glm::dvec3 radiance(1.0);
            if (m_texture > 0)
                radiance = glm::dvec3(sample_texture(m_scene, m_texture, triangle, middle));
            sum += has_alpha() ? radiance * find_coverage(triangle, middle) : radiance;
            ++count;
        });
        return factor * sum / double(count);
    }

    void add_part(std::uint32_t index, const Corners& weights) {
        const shared::Triangle& triangle = m_scene.triangles[index];
        Part part{};
        for (std::size_t i = 0; i < 3; ++i)
            part.corners[i] = glm::vec3(weights[i].x * glm::dvec3(triangle.v0_object) +
                                        weights[i].y * glm::dvec3(triangle.v1_material) +
                                        weights[i].z * glm::dvec3(triangle.v2_source));
        const glm::dvec3 radiance = find_radiance(index, weights);
        const double area = 0.5 * glm::length(compute_area_vector(part.corners[0], part.corners[1], part.corners[2]));
        const double largest = std::max({radiance.x, radiance.y, radiance.z});
        part.weight = area * largest;
        part.color = largest > 0 ? radiance / largest : radiance;
        m_area += area;
        m_power += area * radiance;
        if (!(part.weight > 0))
            return;
        m_weight += part.weight;
        m_center += part.weight / 3.0 *
                    (glm::dvec3(part.corners[0]) + glm::dvec3(part.corners[1]) + glm::dvec3(part.corners[2]));
        m_parts.push_back(part);
    }

    std::size_t m_most_parts;
    bool m_is_large; // then a part's middle stands for all of it
    const Scene& m_scene;
    std::uint32_t m_material_index;
    const shared::Material& m_material;
    float m_texture, m_alpha_texture; // numbers in a paint
    std::vector<Part> m_parts;
    double m_area = 0, m_weight = 0;
    glm::dvec3 m_power{0.0}, m_center{0.0};
};

} // namespace

void list_emitting_objects(Scene& scene) {
    std::vector<std::vector<std::uint32_t>> triangles(scene.objects.size());
    for (std::uint32_t i = 0; i < scene.triangles.size(); ++i) {
        const std::uint32_t object = std::bit_cast<std::uint32_t>(scene.triangles[i].v0_object.w);
        if (emits(scene.materials[scene.objects[object].material]))
            triangles[object].push_back(i);
    }
    const auto lamp_count = static_cast<std::size_t>(
        std::count_if(triangles.begin(), triangles.end(), [](const auto& own) { return !own.empty(); }));
    for (std::size_t object = 0; object < triangles.size(); ++object)
        if (!triangles[object].empty() && Lamp(scene, triangles[object], MOST_PARTS / lamp_count).finish(scene))
            scene.light_names.push_back(scene.objects[object].name);
}

} // namespace photonloupe
