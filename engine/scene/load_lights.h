// SPDX-License-Identifier: Apache-2.0
// Places point lights and perspective cameras in the world.
#pragma once

#include "scene/place_nodes.h"
#include "scene/scene.h"

namespace photonloupe {

// Needs the scene's origin.
void load_lights(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes, Scene& scene);
void load_cameras(const tinygltf::Model& model, const std::vector<PlacedNode>& nodes, Scene& scene);

} // namespace photonloupe
