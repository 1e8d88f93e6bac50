// SPDX-License-Identifier: Apache-2.0
// Nodes where an animation has them at a time.
#pragma once

#include <vector>

#include <tiny_gltf.h>

#include "scene/gltf_animations.h"

namespace photonloupe {

// Before the first key and after the last one a channel holds still (glTF 2.0, section 3.11).
void pose_nodes(tinygltf::Model& model, const std::vector<AnimationChannel>& channels, double time);

} // namespace photonloupe
