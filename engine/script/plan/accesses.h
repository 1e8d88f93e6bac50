// SPDX-License-Identifier: Apache-2.0
// What a photon loop's body does with each name: reads, writes, and steps of a reduction; functions inlined.
#pragma once

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "script/plan/flow.h"
#include "script/plan/plan.h"

namespace photonloupe::script {

// `if (e < s) { s = e; j = i; … }`, on scalars or on elements at one index.
struct ChoiceStatement {
    Role role = Role::least;
    std::uint32_t decided = 0;
    const Expression* candidate = nullptr;
    const Expression* index = nullptr;      // of array elements
    const Expression* decision = nullptr;   // the assignment of the winner
    std::vector<const Expression*> payload; // the other assignments, in order
};
std::optional<ChoiceStatement> match_choice(const Program& program, const Statement& statement);

// `s += e`, `s = min(s, e)` …: one step of a reduction, whose value nobody takes.
struct ReductionStep {
    Role role = Role::sum;
    std::uint32_t variable = 0;
    const Expression* operand = nullptr; // absent: 1, of ++ and --
    const Expression* index = nullptr;
    bool is_negated = false; // s -= e
};
std::optional<ReductionStep> match_reduction(const Program& program, const Expression& expression);

// Whether both give the same value when evaluated one after the other, and change nothing.
bool are_same(const Program& program, const Expression& a, const Expression& b);
bool has_side_effects(const Program& program, const Expression& expression);

struct NameAccesses {
    std::vector<Span> reads, writes;
    struct Step {
        Role role = Role::sum;
        std::uint32_t of = 0; // payload: the variable that is decided
        Span span;
    };
    std::vector<Step> steps;
};

struct BodyAccesses {
    std::map<std::uint32_t, NameAccesses> names; // variables and accumulators (FlowNames)
    std::vector<const Expression*> calls;        // of builtins, in order
    std::map<const Statement*, ChoiceStatement> choices;
    std::vector<Span> leaves; // breaks out of the photon loop, returns of the function around it
    bool has_unbounded_loop = false;
};

// Statements in `ordinary` are not taken for choices.
BodyAccesses collect_accesses(const Program& program, const Statement& loop,
                              const std::set<const Statement*>& ordinary);

} // namespace photonloupe::script
