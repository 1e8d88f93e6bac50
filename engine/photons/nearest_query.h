// SPDX-License-Identifier: Apache-2.0
// The k nearest photons as users ask for them: in a space, of photons or of places.
#pragma once

#include "photons/find_neighbors.h"
#include "photons/map_trees.h"
#include "photons/search_space.h"

namespace photonloupe {

// The k nearest photons of photons, which do not find themselves, or else of places.
struct NearestQuery {
    SearchSpace space = SearchSpace::world;
    std::optional<std::span<const std::uint32_t>> ids;
    std::span<const glm::vec4> places; // relative to the map's origin
    std::span<const double> values;    // places of parameter space: a row of all parameters each
    std::uint32_t k = 0;
    float beta = 3.0f; // of layers
    // The layer of places: that of a photon, or all whose parameters lie within ranges.
    std::optional<std::uint32_t> center = {};
    std::span<const float> low = {}, high = {};
};

// Throws Error for a k that is not offered.
Neighbors find_neighbors(gpu::Device& device, IndexedMap& photons, const NearestQuery& query,
                         const Progress& progress = {});

} // namespace photonloupe
