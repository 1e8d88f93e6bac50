// SPDX-License-Identifier: Apache-2.0
// Whom a query finds, as users name it, and how many photons it may ask for.
#pragma once

#include <cstdint>

namespace photonloupe {

enum class SearchSpace : std::uint32_t {
    world,       // all photons, by distance in metres
    parameter,   // those with parameters, by distance in parameter space
    constrained, // those of a layer, by distance in metres
};

inline constexpr std::uint32_t MOST_NEIGHBORS = 1000;
// Of a photon that asks for others: it counts itself, and the one behind them gives the radius.
inline constexpr std::uint32_t MOST_OTHERS = MOST_NEIGHBORS - 2;

} // namespace photonloupe
