// SPDX-License-Identifier: Apache-2.0
// Recognises counters along paths by the shape of their loops.
#include "script/plan/path_counters.h"

#include <algorithm>
#include <cmath>

#include "script/builtins.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

constexpr double LARGEST_OFFSET = 1000;

std::optional<std::int32_t> find_whole(const Program& program, const PhotonLoop& loop, const Expression& expression) {
    const std::optional<double> value = find_constant(program, loop, expression);
    if (!value || *value != std::trunc(*value) || std::abs(*value) > LARGEST_OFFSET)
        return std::nullopt;
    return static_cast<std::int32_t>(*value);
}

// base + constant or base - constant: the constant.
std::optional<std::int32_t> split_sum(const Program& program, const PhotonLoop& loop, const Expression& expression) {
    if (expression.kind != Kind::binary ||
        (expression.operation != Operator::add && expression.operation != Operator::subtract))
        return std::nullopt;
    const std::optional<std::int32_t> offset = find_whole(program, loop, expression.operands[1]);
    return offset && expression.operation == Operator::subtract ? -*offset : offset;
}

bool is_path_count(const PhotonLoop& loop, const Expression& expression) {
    return expression.kind == Kind::builtin && expression.builtin->id == BuiltinId::get_num_path_vertices &&
           is_loop_photon(loop, expression.operands[0]);
}

// A variable of this loop alone that is only ever given the number of the photon's vertices.
bool holds_path_count(const PhotonLoop& loop, const Expression& expression) {
    if (expression.kind != Kind::variable || loop.unset_reads.contains(expression.variable))
        return false;
    const auto use = loop.variables.find(expression.variable);
    if (use == loop.variables.end() || use->second.role != Role::local)
        return false;
    bool is_count = true;
    visit_expressions(loop.statement->body, [&](const Expression& visited) {
        if (visited.kind == Kind::assignment && visited.variable == expression.variable)
            is_count &= visited.operation == Operator::none && is_path_count(loop, visited.operands[0]);
    });
    return is_count;
}

// getNumPathVertices(i) + constant: the constant.
std::optional<std::int32_t> find_beyond(const Program& program, const PhotonLoop& loop, const Expression& limit) {
    if (is_path_count(loop, limit) || holds_path_count(loop, limit))
        return 0;
    const std::optional<std::int32_t> offset = split_sum(program, loop, limit);
    if (offset && (is_path_count(loop, limit.operands[0]) || holds_path_count(loop, limit.operands[0])))
        return offset;
    return std::nullopt;
}

bool counts_up(const Statement& statement, std::uint32_t variable) {
    if (statement.last.size() != 1)
        return false;
    const Expression& step = statement.last[0];
    return step.kind == Kind::assignment && step.variable == variable && step.operation == Operator::add &&
           step.operands[0].kind == Kind::number && step.operands[0].type == Type::integer &&
           step.operands[0].integer == 1;
}

// Their turns would have to be shared among a subgroup's lanes.
bool holds_loops(const std::vector<Statement>& statements) {
    return std::any_of(statements.begin(), statements.end(), [](const Statement& statement) {
        return statement.kind == Statement::Kind::loop || holds_loops(statement.body) ||
               holds_loops(statement.otherwise);
    });
}

bool is_assigned(const std::vector<Statement>& statements, std::uint32_t variable) {
    bool found = false;
    visit_expressions(statements, [&](const Expression& expression) {
        found |= expression.kind == Kind::assignment && expression.variable == variable;
    });
    return found;
}

} // namespace

std::optional<PathCounter> find_path_counter(const Program& program, const PhotonLoop& loop,
                                             const Statement& statement) {
    if (!statement.is_bounded || statement.test_last || statement.first.size() != 1 || !statement.value)
        return std::nullopt;
    const Expression& start = statement.first[0];
    const Expression& condition = *statement.value;
    const bool is_less = condition.kind == Kind::binary && condition.operation == Operator::less;
    const bool is_less_equal = condition.kind == Kind::binary && condition.operation == Operator::less_equal;
    if (start.kind != Kind::assignment || start.operation != Operator::none || start.operands.size() != 1 ||
        !(is_less || is_less_equal))
        return std::nullopt;
    const Expression& counter = condition.operands[0];
    if (counter.kind != Kind::variable || counter.variable != start.variable || counter.type != Type::integer ||
        !counts_up(statement, start.variable) || is_assigned(statement.body, start.variable))
        return std::nullopt;
    const std::optional<std::int32_t> low = find_whole(program, loop, start.operands[0]);
    const std::optional<std::int32_t> beyond = find_beyond(program, loop, condition.operands[1]);
    if (!low || !beyond)
        return std::nullopt;
    return PathCounter{start.variable, *low, *beyond + (is_less_equal ? 1 : 0), !holds_loops(statement.body)};
}

bool is_on_path(const Program& program, const PhotonLoop& loop, const PathCounter& counter, const Expression& index) {
    std::int32_t offset = 0;
    const Expression* base = &index;
    if (const std::optional<std::int32_t> found = split_sum(program, loop, index)) {
        offset = *found;
        base = &index.operands[0];
    }
    return base->kind == Kind::variable && base->variable == counter.variable && base->type == Type::integer &&
           counter.low + offset >= 0 && counter.beyond + offset <= 0;
}

} // namespace photonloupe::script
