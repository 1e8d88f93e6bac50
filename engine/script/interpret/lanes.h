// SPDX-License-Identifier: Apache-2.0
// What a script has computed so far, and the running values of a loop's reductions, a word for each slot and lane: how
// lanes and blocks become totals, one layout and one order for passes and for the interpreter (reductions.h).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "script/interpret/reductions.h"
#include "script/plan/lane_layout.h"

namespace photonloupe::script {

// A variable's content: one number, or an array's; lists of neighbours hold ids.
struct VariableState {
    std::vector<Number> numbers;
    std::vector<std::int32_t> list;
    bool is_set = false;
};

// Passes take their uniform values from it and bring reductions back.
struct ScriptState {
    std::vector<VariableState> variables; // of Program::variables
    Moments pca_2d, pca_3d;
    Decomposition decomposition;
};

// The words of a lane, or of a total, that has met no photon: one for each slot.
std::vector<std::uint32_t> make_identity(const LaneLayout& layout);

// A block's lanes, words [slot][lane] of `lanes` lanes, into one word for each slot.
std::vector<std::uint32_t> combine_lanes(const LaneLayout& layout, std::span<const std::uint32_t> words,
                                         std::uint32_t lanes);
// Totals of blocks, in order, into one.
std::vector<std::uint32_t> combine_blocks(const LaneLayout& layout,
                                          const std::vector<std::vector<std::uint32_t>>& blocks);

// What each variable had before the loop, combined with the loop's total.
void bring_back(const LaneLayout& layout, std::span<const std::uint32_t> total, ScriptState& state);

void store_moments(const Moments& moments, std::span<std::uint32_t> words);
Moments load_moments(std::span<const std::uint32_t> words);

} // namespace photonloupe::script
