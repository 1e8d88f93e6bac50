// SPDX-License-Identifier: Apache-2.0
// Translation, rotation and scale, or a matrix, per node; the wall has bounded the depth and excluded cycles.
#include "scene/place_nodes.h"

#include <algorithm>
#include <cmath>

namespace photonloupe {
namespace {

// Scaled by its largest part first, so that no quaternion of finite numbers over- or underflows.
glm::dmat3 make_rotation(const std::vector<double>& quaternion) {
    double largest = 0.0;
    for (const double part : quaternion)
        largest = std::max(largest, std::abs(part));
    double x = quaternion[0] / largest, y = quaternion[1] / largest, z = quaternion[2] / largest,
           w = quaternion[3] / largest;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    x /= length, y /= length, z /= length, w /= length;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

glm::dmat4 make_local_transform(const tinygltf::Node& node) {
    glm::dmat4 local(1.0);
    if (node.matrix.size() == 16) {
        for (int i = 0; i < 16; ++i)
            local[i / 4][i % 4] = node.matrix[std::size_t(i)];
        return local;
    }
    const glm::dmat3 rotation = node.rotation.size() == 4 ? make_rotation(node.rotation) : glm::dmat3(1.0);
    for (int column = 0; column < 3; ++column) {
        const double scale = node.scale.size() == 3 ? node.scale[std::size_t(column)] : 1.0;
        local[column] = glm::dvec4(rotation[column] * scale, 0.0);
        local[3][column] = node.translation.size() == 3 ? node.translation[std::size_t(column)] : 0.0;
    }
    return local;
}

} // namespace

std::vector<PlacedNode> place_nodes(const tinygltf::Model& model) {
    std::vector<PlacedNode> placed, stack;
    const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
            stack.push_back({std::uint32_t(*node), parent * make_local_transform(model.nodes[std::size_t(*node)])});
    };
    push(model.scenes.at(0).nodes, glm::dmat4(1.0));
    while (!stack.empty()) {
        placed.push_back(stack.back());
        stack.pop_back();
        push(model.nodes[placed.back().node].children, placed.back().world);
    }
    return placed;
}

std::string name_node(const tinygltf::Model& model, std::uint32_t node, const std::string& fallback,
                      const std::string& what) {
    const std::string& name = model.nodes[node].name;
    if (!name.empty())
        return name;
    return fallback.empty() ? what + " " + std::to_string(node) : fallback;
}

} // namespace photonloupe
