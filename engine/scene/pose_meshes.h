// SPDX-License-Identifier: Apache-2.0
// Where a node's mesh stands: once, at many instances, or bent by the joints of a skin.
#pragma once

#include <optional>
#include <vector>

#include "scene/place_nodes.h"
#include "scene/primitive_reader.h"

namespace photonloupe {

// The transforms to the world of a node's mesh: the node's own, or one per instance (EXT_mesh_gpu_instancing).
std::vector<glm::dmat4> place_instances(const tinygltf::Node& node, const glm::dmat4& world,
                                        const std::vector<AccessorColumn>& columns);

// Per skin and joint: from the mesh at rest to the world, with the joints where their nodes are.
std::vector<std::vector<glm::dmat4>> pose_joints(const tinygltf::Model& model,
                                                 const std::vector<AccessorColumn>& columns);

// The transform of one vertex; nothing if it names a joint that the skin lacks.
std::optional<glm::dmat4> blend_joints(const std::vector<glm::dmat4>& joints, const PrimitiveReader& reader,
                                       std::uint32_t vertex);

} // namespace photonloupe
