// SPDX-License-Identifier: Apache-2.0
// Exact k nearest neighbours: in world space, in parameter space, and in world space among one layer (METHODS §4).
#pragma once

#include <span>

#include "photons/layers.h"
#include "photons/query_tree.h"

namespace photonloupe {

// Row q holds the k nearest of query q, nearest first, ties by photon id; missing ones are -1 and inf.
struct Neighbors {
    gpu::Buffer ids;       // int, query_count × k
    gpu::Buffer distances; // float, metres, or in parameter space
};

// Who is sought, beside where: what of it counts depends on the space.
struct NeighborQueries {
    std::vector<glm::vec4> points;     // xyz relative to the map's origin (or the widest parameters), w bits: self
    std::vector<glm::vec4> parameters; // rows of each query; with ranges: the lower ends, once
    std::vector<glm::vec4> layers;     // x bits: emitter (shared::ANY_EMITTER: all), y squared reach
    std::vector<glm::vec4> range_ends; // empty: no ranges
};

// One query: xyz relative to the map's origin, w bits: photon left out (with `exclude_self`).
Neighbors find_neighbors(gpu::Device& device, const KdTree& tree, std::span<const glm::vec4> queries, std::uint32_t k,
                         bool exclude_self, const Progress& progress = {});

// Neighbours of photons of the map itself; an id's own photon is left out.
Neighbors find_neighbors_of(gpu::Device& device, const PhotonMap& photons, const KdTree& tree,
                            std::span<const std::uint32_t> ids, std::uint32_t k, const Progress& progress = {});

// Nearest by distance in parameter space, among photons that have parameters.
Neighbors find_in_parameter_space(gpu::Device& device, const ParameterTree& parameter_tree,
                                  const NeighborQueries& queries, std::uint32_t k, bool exclude_self,
                                  const Progress& progress = {});

// Nearest by distance in metres, among the photons of a query's layer. `tree_layers` has the parameters in the tree's
// order.
Neighbors find_in_layers(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const Layers& tree_layers,
                         const NeighborQueries& queries, std::uint32_t k, bool exclude_self,
                         const Progress& progress = {});

} // namespace photonloupe
