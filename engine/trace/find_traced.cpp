// SPDX-License-Identifier: Apache-2.0
// Looks photons up among those of a path, which stand in the order of emitted indices.
#include "trace/find_traced.h"

#include <algorithm>

#include "core/error.h"
#include "photons/map_columns.h"

namespace photonloupe {

std::vector<std::uint32_t> find_traced(const PhotonMap& traced, std::span<const std::uint64_t> emitted_indices,
                                       std::span<const float> positions) {
    const std::vector<std::uint64_t> indices = read_emitted_indices(traced);
    const std::vector<float> places = read_positions(traced);
    std::vector<std::uint32_t> ids;
    ids.reserve(emitted_indices.size());
    std::uint64_t lost = 0;
    for (std::size_t i = 0; i < emitted_indices.size(); ++i) {
        const auto [first, end] = std::equal_range(indices.begin(), indices.end(), emitted_indices[i]);
        const auto found = std::find_if(first, end, [&](const std::uint64_t& index) {
            return std::equal(&positions[3 * i], &positions[3 * i] + 3, &places[3 * (&index - indices.data())]);
        });
        lost += found == end;
        ids.push_back(static_cast<std::uint32_t>(found - indices.begin()));
    }
    if (lost > 0)
        throw Error(std::to_string(lost) + " of " + std::to_string(emitted_indices.size()) +
                    " photons were not met again when their paths were traced: the scene, the program or the device "
                    "differs from the one that made the map; trace it anew");
    return ids;
}

} // namespace photonloupe
