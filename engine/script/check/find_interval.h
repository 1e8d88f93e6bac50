// SPDX-License-Identifier: Apache-2.0
// Between which numbers an expression must lie, whatever the photons are.
#pragma once

#include <map>
#include <optional>
#include <vector>

#include "script/check/assignments.h"
#include "script/check/draft.h"

namespace photonloupe::script {

struct Interval {
    double low = 0, high = 0; // may be infinite
};

// Paths have this many vertices at most when their loops are counted; traced ones have 64 bounces. (A user's may be
// longer: such a loop still ends.)
constexpr double MAX_PATH_VERTICES = 66;

class IntervalFinder {
public:
    explicit IntervalFinder(const Draft& draft);
    std::optional<Interval> find(const Expression& expression) { return find(expression, 0); }

    // Inside a loop its variable is known to lie between these, whatever is assigned to it elsewhere.
    std::map<std::uint32_t, Interval>& loop_variables() { return m_loop_variables; }

private:
    std::optional<Interval> find(const Expression& expression, int depth);
    std::optional<Interval> find_binary(const Expression& expression, int depth);
    std::optional<Interval> find_builtin(const Expression& call, int depth);
    std::optional<Interval> find_variable(std::uint32_t variable, int depth);

    const Program& m_program;
    std::vector<Assignments> m_assignments;
    std::map<std::uint32_t, Interval> m_loop_variables;
    bool m_is_elsewhere = false; // looking at an assignment that may stand outside those loops
    std::map<std::uint32_t, std::optional<Interval>> m_known; // nothing while it is being found: cycles have no bound
};

} // namespace photonloupe::script
