// SPDX-License-Identifier: Apache-2.0
// Checks skins and the weights of morph targets.
#pragma once

#include <vector>

#include "scene/gltf_accessors.h"

namespace photonloupe {

// Writes the approved skins; those that no approved node uses stay empty, whatever is in them.
void check_skins(const JsonPlace& root, AccessorTable& accessors, Json& approved);

// Weights of morph targets: any number of finite numbers.
std::vector<double> read_weights(const JsonPlace& place);

} // namespace photonloupe
