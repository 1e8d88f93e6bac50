// SPDX-License-Identifier: Apache-2.0
// The scene on the device, and which parts of the kernels it requires.
#pragma once

#include <initializer_list>
#include <vector>

#include "gpu/commands.h"
#include "scene/scene.h"

namespace photonloupe {

struct SceneBuffers {
    gpu::Buffer geometry; // shared::SceneHeader, nodes, triangles
    gpu::Buffer normals;
    gpu::Buffer materials;
    gpu::Buffer lights;
    gpu::Buffer emitting;    // triangles of area lights
    gpu::Buffer environment; // EnvironmentMap::texels, or nothing
    gpu::Buffer paints, textures, atlas;
    gpu::Buffer corner_coordinates, corner_colors;

    // All that kernels which follow rays may ask for, and more.
    std::vector<gpu::Binding> bind(std::initializer_list<gpu::Binding> others) const;
};

SceneBuffers upload_scene(gpu::Device& device, const Scene& scene);

// Defines for kernels that draw from lights: the kinds there are besides point lights.
std::vector<std::string> list_light_defines(const Scene& scene);

// Defines for kernels that only ask whether rays pass.
std::vector<std::string> list_passing_defines(const Scene& scene);

// Defines for kernels that follow rays: only what the scene contains is compiled in.
std::vector<std::string> list_scene_defines(const Scene& scene);

} // namespace photonloupe
