// SPDX-License-Identifier: Apache-2.0
// Gives each reduced variable its slots, in the order of variables; moments behind them.
#include "script/plan/lane_layout.h"

#include <algorithm>
#include <utility>

#include "shared/script.h"

namespace photonloupe::script {

bool is_choice(Role role) {
    return role == Role::least || role == Role::greatest;
}

LaneLayout lay_out_lanes(const Program& program, const PhotonLoop& loop) {
    LaneLayout layout;
    for (const auto& [variable, use] : loop.variables) {
        if (use.role == Role::local || use.role == Role::uniform || use.role == Role::carried)
            continue;
        const Variable& described = program.variables[variable];
        ReducedSlots slots{variable, use.role, described.type, layout.slots, std::max(described.array_size, 1u),
                           use.of};
        layout.slots += slots.size * (is_choice(use.role) ? 2 : 1);
        layout.variables.push_back(slots);
    }
    for (auto [use, first] : {std::pair{loop.pca_2d, &layout.pca_2d}, {loop.pca_3d, &layout.pca_3d}})
        if (use == AccumulatorUse::reduction) {
            *first = layout.slots;
            layout.slots += shared::MOMENTS_WORDS;
        }
    return layout;
}

} // namespace photonloupe::script
