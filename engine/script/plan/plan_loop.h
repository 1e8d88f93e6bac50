// SPDX-License-Identifier: Apache-2.0
// What the planner knows of one photon loop while it decides; shared by its parts.
#pragma once

#include "script/plan/accesses.h"

namespace photonloupe::script {

struct LoopFacts {
    const Program& program;
    const Statement& statement;
    FlowNames names;
    BodyAccesses accesses;
    NameSet enters; // may be read in an iteration before it is assigned there
    NameSet leaves; // may be read after the loop

    bool is_local(std::uint32_t name) const { return !enters[name] && !leaves[name]; }
    std::uint32_t find_line(Span span) const { return program.source.find_place(span.begin).line; }
};

// Roles of all names; which choices hold.
void classify_names(LoopFacts& facts, PhotonLoop& loop);

// Queries with their k and β, columns, what is set; errors of setting and querying parameters in one loop.
void classify_calls(const LoopFacts& facts, PhotonLoop& loop, Diagnostics& diagnostics);

// Warnings, each saying why the loop runs serially and how to rewrite it.
void explain_names(const LoopFacts& facts, PhotonLoop& loop);
void explain_calls(const LoopFacts& facts, PhotonLoop& loop);

} // namespace photonloupe::script
