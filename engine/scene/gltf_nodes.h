// SPDX-License-Identifier: Apache-2.0
// Checks the node graph: a forest of bounded depth whose transforms are finite.
#pragma once

#include <vector>

#include "core/json_place.h"

namespace photonloupe {

// What nodes may refer to, by count.
struct NodeTargets {
    std::size_t mesh_count = 0;
    std::size_t camera_count = 0;
    std::size_t light_count = 0;
};

// Writes the approved nodes and one scene: the file's default scene, its first, or all nodes without a parent.
// Refuses cycles and nodes with two parents. Returns how often each mesh is drawn.
std::vector<std::uint64_t> check_nodes(const JsonPlace& root, const NodeTargets& targets, Json& approved,
                                       std::vector<std::string>& ignored);

} // namespace photonloupe
