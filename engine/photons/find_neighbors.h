// SPDX-License-Identifier: Apache-2.0
// Exact k nearest neighbours in world space, on the device.
#pragma once

#include <span>

#include "photons/query_tree.h"

namespace photonloupe {

// Row q holds the k nearest of query q, nearest first, ties by photon id; missing ones are -1 and inf.
struct Neighbors {
    gpu::Buffer ids;       // int, query_count × k
    gpu::Buffer distances; // float, metres
};

// One query: xyz relative to the map's origin, w bits: photon left out (with `exclude_self`).
Neighbors find_neighbors(gpu::Device& device, const KdTree& tree, std::span<const glm::vec4> queries, std::uint32_t k,
                         bool exclude_self, const Progress& progress = {});

// Neighbours of photons of the map itself; an id's own photon is left out.
Neighbors find_neighbors_of(gpu::Device& device, const PhotonMap& photons, const KdTree& tree,
                            std::span<const std::uint32_t> ids, std::uint32_t k, const Progress& progress = {});

} // namespace photonloupe
