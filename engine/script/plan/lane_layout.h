// SPDX-License-Identifier: Apache-2.0
// Where the running values of a loop's reductions lie: a word for each slot and lane, the same for passes and for the
// interpreter.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "script/plan/plan.h"

namespace photonloupe::script {

// Whether the role keeps the photon that gave its value.
bool is_choice(Role role);

// A reduced variable's slots: `size` values, and behind them, for a least or greatest, `size` photons that gave them.
struct ReducedSlots {
    std::uint32_t variable = 0;
    Role role = Role::sum;
    Type type = Type::real;
    std::uint32_t first = 0, size = 1;
    std::uint32_t of = 0; // payload: the variable of the least or greatest it goes with
};

struct LaneLayout {
    std::vector<ReducedSlots> variables;         // a payload anywhere
    std::optional<std::uint32_t> pca_2d, pca_3d; // first of MOMENTS_WORDS slots
    std::uint32_t slots = 0;
};

LaneLayout lay_out_lanes(const Program& program, const PhotonLoop& loop);

} // namespace photonloupe::script
