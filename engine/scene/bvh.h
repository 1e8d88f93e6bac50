// SPDX-License-Identifier: Apache-2.0
// Builds the bounding volume hierarchy that the kernels traverse, with binned surface-area costs.
#pragma once

#include "scene/scene.h"

namespace photonloupe {

// Edges from the root to the deepest leaf. A depth-first walk that stacks one child per level stays below
// BVH_STACK_SIZE.
constexpr std::uint32_t BVH_MAX_DEPTH = 60;
static_assert(BVH_MAX_DEPTH < shared::BVH_STACK_SIZE);

// The longest leaf, reached only where splitting does not pay.
constexpr std::uint32_t BVH_MAX_LEAF_TRIANGLES = 8;

// Builds the nodes (none without triangles) and reorders all that is kept for each triangle, so that leaves own
// consecutive ones. The same triangles give the same tree, and scaling them by a power of two gives the scaled tree.
void build_bvh(Scene& scene);

} // namespace photonloupe
