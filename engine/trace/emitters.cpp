// SPDX-License-Identifier: Apache-2.0
// Builds the emission tables and refuses scenes that can store nothing.
#include "trace/emitters.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "core/error.h"
#include "scene/find_media.h"
#include "trace/projection_map.h"

namespace photonloupe {
namespace {

// Pieces of triangles and cells looked at for all lights together, about two seconds; lights for which that leaves
// nothing are not aimed, which costs photons, not minutes.
constexpr std::int64_t PROJECTION_BUDGET = 200'000'000;

double find_largest(const glm::dvec3& v) {
    return std::max({v.x, v.y, v.z});
}

void require_contents(const Scene& scene, Store store) {
    const std::string where = scene.path.string() + ": ";
    if (scene.lights.empty())
        throw SceneError(where + "scene has no emitter; add one with scene.add_light(...) or --light auto");
    if (scene.triangles.empty())
        throw SceneError(where + "scene has no triangles; add a mesh");
    if (!scene.report.has_diffuse && !scene.report.has_media)
        throw SceneError(where + "scene has no receiver; photons are stored on diffuse surfaces and in media, add one "
                                 "(metallicFactor and transmissionFactor below 1)");
    const SceneReport& report = scene.report;
    if (store == Store::caustic && !report.has_mirror && !report.has_dielectric && !report.has_thin &&
        !report.has_layers)
        throw SceneError(where + "scene has no specular surface, so it has no caustic; add a metal or glass "
                                 "material, or trace with store=\"all\" or \"indirect\"");
}

shared::LightEmission describe_emission(const Scene& scene, const shared::Light& light, const EmissionFrame& frame) {
    shared::LightEmission emission{};
    emission.position_kind = {glm::vec3(frame.origin), light.position_kind.w};
    // Light from afar starts outside of all that is closed.
    const bool is_placed = frame.kind != shared::LIGHT_DIRECTIONAL && frame.kind != shared::LIGHT_ENVIRONMENT;
    const shared::Media media = is_placed ? find_media(scene, frame.origin) : shared::Media{0, 0};
    emission.u_axis = glm::vec4(glm::vec3(frame.u), std::bit_cast<float>(media.inner));
    emission.v_axis = glm::vec4(glm::vec3(frame.v), std::bit_cast<float>(media.around));
    emission.axis_sides = glm::vec4(glm::vec3(frame.axis), static_cast<float>(frame.sides));
    emission.cone = {static_cast<float>(frame.inner), static_cast<float>(frame.outer), 0.0f, 0.0f};
    if (frame.kind == shared::LIGHT_ENVIRONMENT)
        emission.cone = {static_cast<float>(frame.disc), static_cast<float>(frame.launch), light.cone.x, 0.0f};
    if (frame.kind == shared::LIGHT_AREA) {
        emission.first_row.z = std::bit_cast<std::uint32_t>(light.cone.y);
        emission.first_row.w = std::bit_cast<std::uint32_t>(light.cone.z);
    }
    return emission;
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
    std::int64_t budget = PROJECTION_BUDGET;
    for (const shared::Light& light : scene.lights) {
        const bool is_aimed = store == Store::caustic;
        const EmissionFrame frame = frame_emission(scene, light, is_aimed);
        bool has_map = frame.kind == shared::LIGHT_DIRECTIONAL ||
                       (is_aimed && frame.is_flat && frame.kind != shared::LIGHT_ENVIRONMENT);
        if (!(frame.find_measure(light) > 0)) // edge-on, say: nothing could be drawn from it
            has_map = false;
        const ProjectionMap map =
            has_map && budget > 0 ? project_light(scene, frame, is_aimed, budget) : make_full_projection();
        shared::LightEmission emission = describe_emission(scene, light, frame);
        append_projection(table, map, emission);
        const double measure = frame.find_measure(light) * map.find_share();
        // Of an image, photons carry all of the largest channel's radiance, and of the others what their texel has.
        powers.push_back((has_image(light) ? glm::dvec3(light.intensity.w) : glm::dvec3(light.intensity)) * measure);
        total += find_largest(powers.back());
        if (frame.kind == shared::LIGHT_POINT || frame.kind == shared::LIGHT_SPOT)
            table.solid_angle += measure;
        table.emitters.push_back(emission);
    }
    if (!std::isfinite(total))
        throw SceneError(scene.path.string() + ": its " + count_lights(scene) +
                         " send more power than numbers hold; make them smaller or weaker");
    if (!(total > 0))
        throw SceneError(scene.path.string() + ": of its " + count_lights(scene) + " none sends anything towards " +
                         (store == Store::caustic ? "a specular surface" : "a surface") +
                         "; check their intensities, colors and directions");
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
