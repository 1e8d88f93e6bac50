// SPDX-License-Identifier: Apache-2.0
// Checks meshes: which accessors a primitive may read, every index and every position.
#pragma once

#include <vector>

#include "scene/gltf_accessors.h"

namespace photonloupe {

// glTF's primitive modes that make triangles.
constexpr std::uint64_t MODE_TRIANGLES = 4;
constexpr std::uint64_t MODE_TRIANGLE_STRIP = 5;
constexpr std::uint64_t MODE_TRIANGLE_FAN = 6;

// Writes the approved meshes; those that are drawn 0 times stay empty, whatever is in them.
// Primitives that draw no triangles are left out and listed in `ignored`. Refuses more triangles than the engine takes.
void check_meshes(const JsonPlace& root, const std::vector<std::uint64_t>& draw_counts, AccessorTable& accessors,
                  Json& approved, std::vector<std::string>& ignored);

} // namespace photonloupe
