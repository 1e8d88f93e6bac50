// SPDX-License-Identifier: Apache-2.0
// Builds the emission tables and refuses scenes that can store nothing.
#include "trace/emitters.h"

#include <algorithm>

#include "trace/projection_map.h"

namespace photonloupe {
namespace {

double find_largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

void require_contents(const Scene& scene, Store store) {
    const std::string where = scene.path.string() + ": ";
    if (scene.lights.empty())
        throw SceneError(where + "scene has no emitter; add a KHR_lights_punctual point light");
    if (scene.triangles.empty())
        throw SceneError(where + "scene has no triangles; add a mesh");
    if (!scene.report.has_diffuse)
        throw SceneError(where + "scene has no receiver; photons are stored on diffuse surfaces, add one "
                                 "(metallicFactor and transmissionFactor below 1)");
    if (store == Store::caustic && !scene.report.has_mirror && !scene.report.has_dielectric && !scene.report.has_thin)
        throw SceneError(where + "scene has no specular surface, so it has no caustic; add a metal or glass "
                                 "material, or trace with store=\"all\" or \"indirect\"");
}

void append_projection(EmitterTable& table, const ProjectionMap& map, shared::LightEmission& emission) {
    emission.grid = {map.rows, map.columns, static_cast<std::uint32_t>(table.cells.size()),
                     static_cast<std::uint32_t>(map.cells.size())};
    emission.first_row.x = static_cast<std::uint32_t>(table.cell_rows.size());
    table.cells.insert(table.cells.end(), map.cells.begin(), map.cells.end());
    table.cell_rows.insert(table.cell_rows.end(), map.row_members.begin(), map.row_members.end());
}

} // namespace

EmitterTable build_emitters(const Scene& scene, Store store) {
    require_contents(scene, store);
    EmitterTable table;
    std::vector<glm::dvec3> powers;
    double total = 0;
    for (const shared::Light& light : scene.lights) {
        const ProjectionMap map = store == Store::caustic ? project_specular(scene, light) : make_full_projection();
        shared::LightEmission emission{};
        emission.position_kind = light.position_kind;
        append_projection(table, map, emission);
        powers.push_back(glm::dvec3(light.intensity) * map.solid_angle());
        total += find_largest(powers.back());
        table.solid_angle += map.solid_angle();
        table.emitters.push_back(emission);
    }
    if (!(total > 0))
        throw SceneError(scene.path.string() + ": no light sends anything towards a specular surface; "
                                               "check the lights' intensities and colors");
    double before = 0;
    std::vector<shared::LightEmission> shining; // a light that sends nothing must never be drawn, not even by rounding
    for (std::size_t i = 0; i < powers.size(); ++i) {
        const double probability = find_largest(powers[i]) / total;
        if (!(probability > 0))
            continue;
        before += probability;
        shared::LightEmission& emission = shining.emplace_back(table.emitters[i]);
        emission.first_row.y = static_cast<std::uint32_t>(i);
        emission.flux_cumulative = glm::vec4(glm::vec3(powers[i] / probability), static_cast<float>(before));
    }
    table.emitters = std::move(shining);
    return table;
}

} // namespace photonloupe
