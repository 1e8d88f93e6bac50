// SPDX-License-Identifier: Apache-2.0
// Walks the script as a run goes through it: functions where they are called, knowing the photon loop around.
#pragma once

#include "script/program.h"

namespace photonloupe::script {

namespace detail {

template <class Visit>
struct CallWalker {
    const Program& program;
    Visit& visit;

    void walk(const std::vector<Statement>& statements, const Statement* photon_loop) {
        for (const Statement& statement : statements) {
            visit(statement, photon_loop);
            for (const Expression& expression : statement.first)
                walk(expression, photon_loop);
            if (statement.value)
                walk(*statement.value, photon_loop);
            const bool is_outermost = statement.kind == Statement::Kind::photon_loop && !photon_loop;
            walk(statement.body, is_outermost ? &statement : photon_loop);
            walk(statement.otherwise, photon_loop);
            for (const Expression& expression : statement.last)
                walk(expression, photon_loop);
        }
    }

    void walk(const Expression& expression, const Statement* photon_loop) {
        for (const Expression& operand : expression.operands)
            walk(operand, photon_loop);
        if (expression.kind == Expression::Kind::call)
            walk(program.functions[expression.function].body, photon_loop);
    }
};

} // namespace detail

// visit(statement, photon_loop) before what is in it; `photon_loop` is null in uniform code. The arguments of a call
// come before its function's body.
template <class Visit>
void walk_calls(const Program& program, Visit&& visit) {
    detail::CallWalker<Visit>{program, visit}.walk(program.body, nullptr);
}

} // namespace photonloupe::script
