// SPDX-License-Identifier: Apache-2.0
// Meets photons again that were traced before.
#pragma once

#include <span>

#include "photons/photon_map.h"

namespace photonloupe {

// The ids that photons have in a map traced with the same settings, by emitted index and place (world, 3 floats a
// photon): a path can store several. Throws Error when one is not met again.
std::vector<std::uint32_t> find_traced(const PhotonMap& traced, std::span<const std::uint64_t> emitted_indices,
                                       std::span<const float> positions);

} // namespace photonloupe
