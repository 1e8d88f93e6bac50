// SPDX-License-Identifier: Apache-2.0
// Whether control can reach the end of a body.
#include <algorithm>

#include "script/check/tree_builder.h"

namespace photonloupe::script {
namespace {

using Kind = Statement::Kind;

// A `break` that leaves this body's own loop.
bool may_leave(const std::vector<Statement>& body) {
    return std::any_of(body.begin(), body.end(), [](const Statement& statement) {
        return statement.kind == Kind::leave ||
               (statement.kind != Kind::loop && (may_leave(statement.body) || may_leave(statement.otherwise)));
    });
}

bool is_always_true(const std::optional<Expression>& condition) {
    return !condition ||
           (condition->kind == Expression::Kind::number && condition->type == Type::integer && condition->integer != 0);
}

bool may_go_on(const Statement& statement) {
    switch (statement.kind) {
    case Kind::give:
        return !statement.value; // a bare `return` ends without value
    case Kind::leave:
    case Kind::next:
        return false; // goes on elsewhere; the loop answers for it
    case Kind::block:
        return may_end(statement.body);
    case Kind::branch:
        return may_end(statement.body) || may_end(statement.otherwise);
    case Kind::loop:
        return !is_always_true(statement.value) || may_leave(statement.body);
    default:
        return true;
    }
}

bool holds_bare_return(const std::vector<Statement>& body) {
    return std::any_of(body.begin(), body.end(), [](const Statement& statement) {
        return (statement.kind == Kind::give && !statement.value) || holds_bare_return(statement.body) ||
               holds_bare_return(statement.otherwise);
    });
}

} // namespace

bool may_end(const std::vector<Statement>& body) {
    return holds_bare_return(body) || std::all_of(body.begin(), body.end(), may_go_on);
}

} // namespace photonloupe::script
