// SPDX-License-Identifier: Apache-2.0
// What a relaxation was told, made complete for its map.
#pragma once

#include "photons/map_trees.h"
#include "relax/settings.h"

namespace photonloupe {

// Nothing is automatic any more; β is 0 where no layer counts.
struct CompleteSettings {
    RelaxSettings settings;
    std::vector<std::string> notes; // what is to be told of it
};

// Throws ArgumentError for layers of a map without parameters, and as `find_optimal_beta` does.
CompleteSettings complete_settings(gpu::Device& device, IndexedMap& photons, const RelaxSettings& given,
                                   std::optional<Emission> emission, const Progress& progress);

} // namespace photonloupe
