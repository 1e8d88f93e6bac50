// SPDX-License-Identifier: Apache-2.0
// Control flow of a whole script, functions inlined, and which values may still be read at a place in it.
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "script/program.h"

namespace photonloupe::script {

// Script variables by their index, then the accumulators.
struct FlowNames {
    explicit FlowNames(const Program& program) : variable_count(std::uint32_t(program.variables.size())) {}
    std::uint32_t variable_count;
    std::uint32_t moments(int dimensions) const { return variable_count + (dimensions == 2 ? 0 : 1); }
    std::uint32_t decomposition() const { return variable_count + 2; }
    std::uint32_t count() const { return variable_count + 3; }
};
using NameSet = std::vector<bool>;

// Elements of arrays are read, never overwritten as a whole: only a declaration ends what an array held.
struct FlowAccess {
    enum class Kind : std::uint8_t {
        read,
        write,  // ends the old value
        forget, // a declaration, or a function's own names at its start: ends the old value, leaves none
    };
    Kind kind = Kind::read;
    std::uint32_t name = 0;
};

struct FlowBlock {
    std::vector<FlowAccess> accesses;
    std::vector<std::uint32_t> next;
};

// Blocks [first, end) are one iteration's body; `exit` is where the photon loop ends.
struct LoopFlow {
    std::uint32_t first = 0, end = 0, exit = 0;
};

struct Flow {
    FlowNames names;
    std::vector<FlowBlock> blocks; // 0 is the script's start
    std::map<const Statement*, LoopFlow> loops;
};
Flow build_flow(const Program& program);

// What may be read before it is written, at the start of each of the blocks [first, end); nothing is after them.
std::vector<NameSet> find_live_names(const Flow& flow, std::uint32_t first, std::uint32_t end);

// Names that may be read while they hold nothing; `live` is that of all blocks.
NameSet find_unset_reads(const Flow& flow, const std::vector<NameSet>& live);

// The variables declared in a function, whether by a declaration or by their first assignment.
std::vector<std::uint32_t> list_own_variables(const Program& program, const Function& function);

} // namespace photonloupe::script
