// SPDX-License-Identifier: Apache-2.0
// Loops that count along the loop photon's own path: their counter names vertices that exist, so nothing is checked.
#pragma once

#include <optional>

#include "script/plan/plan.h"

namespace photonloupe::script {

// In the loop's body, low ≤ variable < vertices of the photon's path + beyond.
struct PathCounter {
    std::uint32_t variable = 0;
    std::int32_t low = 0, beyond = 0;
    bool is_short = false; // the body has no loops: few turns in all
};

// for (j = LOW; j < getNumPathVertices(i) + BEYOND; j++), also with a variable that holds the number, or <=.
std::optional<PathCounter> find_path_counter(const Program& program, const PhotonLoop& loop,
                                             const Statement& statement);

// Whether the index is the counter, or the counter plus a constant, and names a vertex in every turn.
bool is_on_path(const Program& program, const PhotonLoop& loop, const PathCounter& counter, const Expression& index);

} // namespace photonloupe::script
