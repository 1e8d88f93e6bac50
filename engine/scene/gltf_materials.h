// SPDX-License-Identifier: Apache-2.0
// Checks materials, lights and cameras: every number in the range the engine computes with.
#pragma once

#include <vector>

#include "core/json_place.h"

namespace photonloupe {

// Each writes its part of the approved document; indices stay those of the file.
void check_materials(const JsonPlace& root, Json& approved);
// Returns the number of lights. Kinds that are not modeled become lights of kind "none", which nothing reads.
std::size_t check_lights(const JsonPlace& root, Json& approved);
// Returns the number of cameras. Cameras that are not perspective stay as kind "orthographic", which nothing reads.
std::size_t check_cameras(const JsonPlace& root, Json& approved);

} // namespace photonloupe
