// SPDX-License-Identifier: Apache-2.0
// Uploads the scene; an empty scene becomes one box that no ray enters.
#include "scene/scene_buffers.h"

namespace photonloupe {

SceneBuffers upload_scene(gpu::Device& device, const Scene& scene) {
    SceneBuffers buffers;
    std::vector<shared::BvhNode> nodes = scene.nodes;
    if (nodes.empty())
        nodes.push_back({glm::vec4(1.0f), glm::vec4(-1.0f)}); // inside out: never entered
    buffers.nodes = gpu::make_buffer(device, nodes, "BVH nodes");
    buffers.triangles = gpu::make_buffer(device, scene.triangles, "triangles");
    buffers.normals = gpu::make_buffer(device, scene.normals, "shading normals");
    buffers.materials = gpu::make_buffer(device, scene.materials, "materials");
    buffers.lights = gpu::make_buffer(device, scene.lights, "lights");
    return buffers;
}

std::vector<std::string> list_scene_defines(const Scene& scene) {
    std::vector<std::string> defines;
    if (scene.report.has_mirror)
        defines.emplace_back("HAS_MIRROR");
    if (scene.report.has_dielectric || scene.report.has_thin)
        defines.emplace_back("HAS_DIELECTRIC");
    if (scene.report.has_absorption)
        defines.emplace_back("HAS_ABSORPTION");
    return defines;
}

} // namespace photonloupe
