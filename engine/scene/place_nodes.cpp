// SPDX-License-Identifier: Apache-2.0
// Translation, rotation and scale, or a matrix, per node; the wall has bounded the depth and excluded cycles.
#include "scene/place_nodes.h"

#include <algorithm>
#include <cmath>

namespace photonloupe {
namespace {

// Scaled by its largest part first, so that no quaternion of finite numbers over- or underflows.
glm::dmat3 make_rotation(const glm::dvec4& quaternion) {
    double largest = 0.0;
    for (int part = 0; part < 4; ++part)
        largest = std::max(largest, std::abs(quaternion[part]));
    if (!(largest > 0))
        return glm::dmat3(1.0);
    double x = quaternion.x / largest, y = quaternion.y / largest, z = quaternion.z / largest,
           w = quaternion.w / largest;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    x /= length, y /= length, z /= length, w /= length;
    return {{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
            {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
            {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}};
}

template <class Vector>
Vector read_vector(const std::vector<double>& numbers, Vector vector) {
    for (std::size_t i = 0; i < std::min<std::size_t>(numbers.size(), std::size_t(Vector::length())); ++i)
        vector[int(i)] = numbers[i];
    return vector;
}

glm::dmat4 make_local_transform(const tinygltf::Node& node) {
    if (node.matrix.empty())
        return compose_transform(read_vector(node.translation, glm::dvec3(0.0)),
                                 read_vector(node.rotation, glm::dvec4(0, 0, 0, 1)),
                                 read_vector(node.scale, glm::dvec3(1.0)));
    glm::dmat4 local(1.0);
    for (int i = 0; i < 16; ++i)
        local[i / 4][i % 4] = node.matrix[std::size_t(i)];
    return local;
}

std::vector<PlacedNode> place_below(const tinygltf::Model& model, const std::vector<int>& roots) {
    std::vector<PlacedNode> placed, stack;
    const auto push = [&](const std::vector<int>& nodes, const glm::dmat4& parent) {
        for (auto node = nodes.rbegin(); node != nodes.rend(); ++node)
            stack.push_back({std::uint32_t(*node), parent * make_local_transform(model.nodes[std::size_t(*node)])});
    };
    push(roots, glm::dmat4(1.0));
    while (!stack.empty()) {
        placed.push_back(stack.back());
        stack.pop_back();
        push(model.nodes[placed.back().node].children, placed.back().world);
    }
    return placed;
}

} // namespace

std::vector<PlacedNode> place_nodes(const tinygltf::Model& model) {
    return place_below(model, model.scenes.at(0).nodes);
}

std::vector<glm::dmat4> find_node_transforms(const tinygltf::Model& model) {
    std::vector<bool> is_child(model.nodes.size(), false);
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children)
            is_child[std::size_t(child)] = true;
    std::vector<int> roots;
    for (std::size_t i = 0; i < is_child.size(); ++i)
        if (!is_child[i])
            roots.push_back(int(i));
    std::vector<glm::dmat4> transforms(model.nodes.size(), glm::dmat4(1.0));
    for (const PlacedNode& placed : place_below(model, roots))
        transforms[placed.node] = placed.world;
    return transforms;
}

glm::dmat4 compose_transform(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale) {
    const glm::dmat3 turned = make_rotation(rotation);
    glm::dmat4 transform(1.0);
    for (int column = 0; column < 3; ++column)
        transform[column] = glm::dvec4(turned[column] * scale[column], 0.0);
    transform[3] = glm::dvec4(translation, 1.0);
    return transform;
}

std::string name_node(const tinygltf::Model& model, std::uint32_t node, const std::string& fallback,
                      const std::string& what) {
    const std::string& name = model.nodes[node].name;
    if (!name.empty())
        return name;
    return fallback.empty() ? what + " " + std::to_string(node) : fallback;
}

} // namespace photonloupe
