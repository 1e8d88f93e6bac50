// SPDX-License-Identifier: Apache-2.0
// Checks the node graph: a forest of bounded depth whose transforms are finite.
#pragma once

#include <array>
#include <utility>
#include <vector>

#include "scene/gltf_accessors.h"

namespace photonloupe {

// What nodes may refer to, by count.
struct NodeTargets {
    std::size_t mesh_count = 0;
    std::size_t skin_count = 0;
    std::size_t camera_count = 0;
    std::size_t light_count = 0;
};

// EXT_mesh_gpu_instancing: attributes of instances and their components.
constexpr std::array<std::pair<const char*, std::uint32_t>, 3> INSTANCE_ATTRIBUTES{
    {{"TRANSLATION", 3}, {"ROTATION", 4}, {"SCALE", 3}}};

// Writes the approved nodes and one scene: the file's default scene, its first, or all nodes without a parent.
// Refuses cycles and nodes with two parents. Returns how often each mesh is drawn.
std::vector<std::uint64_t> check_nodes(const JsonPlace& root, const NodeTargets& targets, AccessorTable& accessors,
                                       Json& approved, std::vector<std::string>& ignored);

} // namespace photonloupe
