// SPDX-License-Identifier: Apache-2.0
// Composes node transforms in double precision.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/mat4x4.hpp>
#include <tiny_gltf.h>

namespace photonloupe {

// A node of the scene that is drawn, and its transform to the world.
struct PlacedNode {
    std::uint32_t node = 0; // index in the file
    glm::dmat4 world{1.0};
};

// All nodes of the model's scene, parents before children, in the file's order.
std::vector<PlacedNode> place_nodes(const tinygltf::Model& model);

// Of every node by index, whether the scene draws it or not.
std::vector<glm::dmat4> find_node_transforms(const tinygltf::Model& model);

// Translation, a quaternion of any length (no rotation if it has none), scale.
glm::dmat4 compose_transform(const glm::dvec3& translation, const glm::dvec4& rotation, const glm::dvec3& scale);

// A node's name, or the fallback, or "what 3".
std::string name_node(const tinygltf::Model& model, std::uint32_t node, const std::string& fallback,
                      const std::string& what);

} // namespace photonloupe
