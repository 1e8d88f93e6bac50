// SPDX-License-Identifier: Apache-2.0
// Whom a query finds, as users name it.
#pragma once

#include <cstdint>

namespace photonloupe {

enum class SearchSpace : std::uint32_t {
    world,       // all photons, by distance in metres
    parameter,   // those with parameters, by distance in parameter space
    constrained, // those of a layer, by distance in metres
};

} // namespace photonloupe
