// SPDX-License-Identifier: Apache-2.0
// How many photons a query may ask for.
#pragma once

#include <cstdint>

namespace photonloupe {

inline constexpr std::uint32_t MOST_NEIGHBORS = 1000;
// Of a photon that asks for others: it counts itself, and the one behind them gives the radius.
inline constexpr std::uint32_t MOST_OTHERS = MOST_NEIGHBORS - 2;

} // namespace photonloupe
