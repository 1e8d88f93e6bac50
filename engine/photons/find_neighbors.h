// SPDX-License-Identifier: Apache-2.0
// Exact k nearest neighbours: in world space, in parameter space, and in world space among one layer (METHODS §4).
#pragma once

#include "photons/neighbor_queries.h"

namespace photonloupe {

// Row q holds the k nearest of query q, nearest first, ties by photon id; missing ones are -1 and inf.
struct Neighbors {
    gpu::Buffer ids;       // int, query_count × k
    gpu::Buffer distances; // float, metres, or in parameter space
};

// `neighborhood` names the tree and the measure; what queries bring along decides who else is left out. Queries that
// are photons do not find themselves.
Neighbors find_neighbors(gpu::Device& device, Neighborhood neighborhood, const NeighborQueries& queries,
                         std::uint32_t k, const Progress& progress = {});

} // namespace photonloupe
