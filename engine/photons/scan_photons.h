// SPDX-License-Identifier: Apache-2.0
// The last resort of neighbour queries: the host looks at every photon of the map, one query at a time.
#pragma once

#include <span>

#include "photons/find_neighbors.h"

namespace photonloupe {

// How photons are measured, as in shaders/photons/query_layers.glsl.
struct ScanShape {
    std::uint32_t space = shared::SPACE_WORLD;
    std::uint32_t parameter_count = 0;
    const gpu::Buffer* parameters = nullptr; // in the tree's order
    const gpu::Buffer* periods = nullptr;
};

// Answers the queries of `rows` and writes them into `neighbors`; the same bits as the kernels would.
void scan_photons(const KdTree& tree, const ScanShape& shape, const NeighborQueries& queries,
                  std::span<const std::uint32_t> rows, std::uint32_t k, bool exclude_self, Neighbors& neighbors,
                  const Progress& progress);

} // namespace photonloupe
