// SPDX-License-Identifier: Apache-2.0
// Uploads the scene; an empty scene becomes one box that no ray enters.
#include "scene/scene_buffers.h"

#include <algorithm>
#include <cstring>

namespace photonloupe {

namespace {

template <class T>
void append_texels(std::vector<glm::vec4>& texels, const std::vector<T>& values) {
    static_assert(sizeof(T) % sizeof(glm::vec4) == 0);
    const std::size_t first = texels.size();
    texels.resize(first + values.size() * sizeof(T) / sizeof(glm::vec4));
    if (!values.empty())
        std::memcpy(&texels[first], values.data(), values.size() * sizeof(T));
}

std::vector<std::string> list_paint_defines(const Scene& scene) {
    std::vector<std::string> defines;
    if (!scene.textures.empty())
        defines.emplace_back("HAS_TEXTURES");
    if (!scene.corner_colors.empty())
        defines.emplace_back("HAS_VERTEX_COLORS");
    if (scene.report.has_alpha)
        defines.emplace_back("HAS_ALPHA");
    return defines;
}

} // namespace

SceneBuffers upload_scene(gpu::Device& device, const Scene& scene) {
    std::vector<shared::BvhNode> nodes = scene.nodes;
    if (nodes.empty())
        nodes.push_back({glm::vec4(1.0f), glm::vec4(-1.0f)}); // inside out: never entered
    const std::vector<shared::SceneHeader> header{
        {static_cast<std::uint32_t>(1 + nodes.size() * sizeof(shared::BvhNode) / sizeof(glm::vec4)), 0, 0, 0}};
    std::vector<glm::vec4> texels;
    append_texels(texels, header);
    append_texels(texels, nodes);
    append_texels(texels, scene.triangles);
    texels.emplace_back(0.0f); // a step of the traversal loads four texels, the last triangle has three
    SceneBuffers buffers;
    buffers.geometry = gpu::make_buffer(device, texels, "scene geometry");
    buffers.normals = gpu::make_buffer(device, scene.normals, "shading normals");
    buffers.materials = gpu::make_buffer(device, scene.materials, "materials");
    buffers.lights = gpu::make_buffer(device, scene.lights, "lights");
    buffers.emitting = gpu::make_buffer(device, scene.emitting, "emitting triangles");
    buffers.paints = gpu::make_buffer(device, scene.paints, "paints");
    buffers.textures = gpu::make_buffer(device, scene.textures, "textures");
    buffers.atlas = gpu::make_buffer(device, scene.atlas, "texture atlas");
    buffers.corner_coordinates = gpu::make_buffer(device, scene.corner_coordinates, "texture coordinates");
    buffers.corner_colors = gpu::make_buffer(device, scene.corner_colors, "vertex colors");
    buffers.environment = gpu::make_buffer(
        device, scene.environment ? scene.environment->texels : std::vector<glm::vec4>{}, "environment");
    return buffers;
}

std::vector<gpu::Binding> SceneBuffers::bind(std::initializer_list<gpu::Binding> others) const {
    std::vector<gpu::Binding> bindings{{"geometry", geometry},
                                       {"shading_normals", normals},
                                       {"materials", materials},
                                       {"lights", lights},
                                       {"emitting", emitting},
                                       {"environment_map", environment},
                                       {"paints", paints},
                                       {"textures", textures},
                                       {"atlas", atlas},
                                       {"corner_coordinates", corner_coordinates},
                                       {"corner_colors", corner_colors}};
    for (const gpu::Binding& other : others)
        bindings.push_back(other);
    return bindings;
}

std::vector<std::string> list_light_defines(const Scene& scene) {
    constexpr std::pair<std::uint32_t, const char*> DEFINES[] = {{shared::LIGHT_SPOT, "HAS_SPOT_LIGHTS"},
                                                                 {shared::LIGHT_DIRECTIONAL, "HAS_DIRECTIONAL_LIGHTS"},
                                                                 {shared::LIGHT_AREA, "HAS_AREA_LIGHTS"},
                                                                 {shared::LIGHT_ENVIRONMENT, "HAS_ENVIRONMENT"}};
    std::vector<std::string> defines;
    for (const auto& [kind, define] : DEFINES)
        if (std::any_of(scene.lights.begin(), scene.lights.end(),
                        [&](const shared::Light& light) { return find_kind(light) == kind; }))
            defines.emplace_back(define);
    if (scene.environment)
        defines.emplace_back("HAS_ENVIRONMENT_MAP");
    if (scene.report.has_colored_lamps)
        defines.emplace_back("HAS_COLORED_LAMPS");
    return defines;
}

std::vector<std::string> list_passing_defines(const Scene& scene) {
    std::vector<std::string> defines;
    if (scene.report.has_alpha || scene.report.has_media)
        defines = list_paint_defines(scene);
    if (scene.report.has_media)
        defines.emplace_back("HAS_MEDIA");
    return defines;
}

std::vector<std::string> list_scene_defines(const Scene& scene) {
    std::vector<std::string> defines;
    if (scene.report.has_mirror)
        defines.emplace_back("HAS_MIRROR");
    if (scene.report.has_dielectric || scene.report.has_thin)
        defines.emplace_back("HAS_DIELECTRIC");
    if (scene.report.has_rough)
        defines.emplace_back("HAS_ROUGH");
    for (std::string& define : list_paint_defines(scene))
        defines.push_back(std::move(define));
    if (scene.report.has_translucency)
        defines.emplace_back("HAS_TRANSLUCENCY");
    if (scene.report.has_layers)
        defines.emplace_back("HAS_LAYERS");
    if (scene.report.has_dispersion)
        defines.emplace_back("HAS_DISPERSION");
    if (scene.report.has_media)
        defines.emplace_back("HAS_MEDIA");
    else if (scene.report.has_absorption)
        defines.emplace_back("HAS_ABSORPTION");
    return defines;
}

} // namespace photonloupe
