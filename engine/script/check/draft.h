// SPDX-License-Identifier: Apache-2.0
// The program while it is checked, with what only the checker's stages need to know about it.
#pragma once

#include <vector>

#include "script/program.h"
#include "script/read/syntax.h"

namespace photonloupe::script {

// float c[N]: N is looked at once constants are known.
struct PendingSize {
    std::uint32_t variable = 0;
    Expression size;
};

struct Draft {
    Program program;
    std::vector<WrittenType> variable_types; // as declared, by variable
    std::vector<WrittenType> result_types;   // as declared, by function copy
    std::vector<PendingSize> sizes;
    bool is_too_large = false; // building stopped: nothing more can be said about it

    // How much belongs to the script itself. What follows stands for calls of functions that nothing calls: it is
    // checked and then dropped.
    struct Extent {
        std::size_t statements = 0, functions = 0, variables = 0;
    } called;

    // The bodies of the script and of all its functions' copies, each entered once.
    template <class Visit>
    void visit_bodies(Visit&& visit) {
        visit(program.body);
        for (Function& function : program.functions)
            visit(function.body);
    }
    template <class Visit>
    void visit_bodies(Visit&& visit) const {
        visit(program.body);
        for (const Function& function : program.functions)
            visit(function.body);
    }
};

// Stands for what could not be checked: no stage complains about it again.
inline Expression make_unknown(Span span) {
    Expression unknown;
    unknown.span = span;
    return unknown; // a number without type
}

inline bool is_unknown(const Expression& expression) {
    return expression.kind == Expression::Kind::number && expression.type == Type::none;
}

} // namespace photonloupe::script
