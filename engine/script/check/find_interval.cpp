// SPDX-License-Identifier: Apache-2.0
// Interval arithmetic over constants, path vertices, neighbor counts and what is made of them.
#include "script/check/find_interval.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "photons/search_space.h"
#include "script/builtins.h"
#include "script/check/evaluate_constant.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

constexpr int MAX_DEPTH = 64;     // of variables given by variables given by …
constexpr double MAX_VALUE = 1e9; // far from where 32-bit integers wrap
constexpr Interval ANYWHERE{-HUGE_VAL, HUGE_VAL};

std::optional<Interval> accept(Interval interval) {
    const bool is_small = std::fabs(interval.low) <= MAX_VALUE && std::fabs(interval.high) <= MAX_VALUE;
    return is_small && interval.low <= interval.high ? std::optional(interval) : std::nullopt;
}

Interval unite(Interval a, Interval b) {
    return {std::min(a.low, b.low), std::max(a.high, b.high)};
}

} // namespace

IntervalFinder::IntervalFinder(const Draft& draft)
    : m_program(draft.program), m_assignments(collect_assignments(draft)) {}

std::optional<Interval> IntervalFinder::find(const Expression& expression, int depth) {
    if (depth > MAX_DEPTH)
        return std::nullopt;
    if (const std::optional<double> constant = evaluate_constant(m_program, expression))
        return accept({*constant, *constant});
    switch (expression.kind) {
    case Kind::variable:
        return find_variable(expression.variable, depth);
    case Kind::convert:
        return find(expression.operands[0], depth + 1);
    case Kind::list_length:
        return Interval{0, MOST_NEIGHBORS};
    case Kind::unary:
        if (const auto value = find(expression.operands[0], depth + 1);
            value && expression.operation == Operator::negate)
            return Interval{-value->high, -value->low};
        return std::nullopt;
    case Kind::binary:
        return find_binary(expression, depth);
    case Kind::conditional: {
        const auto a = find(expression.operands[1], depth + 1), b = find(expression.operands[2], depth + 1);
        return a && b ? std::optional(unite(*a, *b)) : std::nullopt;
    }
    case Kind::builtin:
        return find_builtin(expression, depth);
    default:
        return std::nullopt;
    }
}

std::optional<Interval> IntervalFinder::find_binary(const Expression& expression, int depth) {
    const auto a = find(expression.operands[0], depth + 1);
    const auto b = a ? find(expression.operands[1], depth + 1) : std::nullopt;
    if (!b)
        return std::nullopt;
    switch (expression.operation) {
    case Operator::add:
        return accept({a->low + b->low, a->high + b->high});
    case Operator::subtract:
        return accept({a->low - b->high, a->high - b->low});
    case Operator::multiply: {
        const auto [low, high] = std::minmax({a->low * b->low, a->low * b->high, a->high * b->low, a->high * b->high});
        return accept({low, high});
    }
    case Operator::divide:
        if (b->low != b->high || b->low == 0)
            return std::nullopt;
        return accept({std::min(a->low / b->low, a->high / b->low), std::max(a->low / b->low, a->high / b->low)});
    default:
        return std::nullopt;
    }
}

std::optional<Interval> IntervalFinder::find_builtin(const Expression& call, int depth) {
    const auto argument = [&](std::size_t i) { return find(call.operands[i], depth + 1); };
    switch (call.builtin->id) {
    case BuiltinId::get_num_path_vertices:
        return Interval{0, MAX_PATH_VERTICES};
    case BuiltinId::floor:
    case BuiltinId::ceil:
    case BuiltinId::round:
    case BuiltinId::int_: {
        const auto value = argument(0);
        return value ? accept({std::floor(value->low), std::ceil(value->high)}) : std::nullopt;
    }
    case BuiltinId::min:
    case BuiltinId::max: {
        const Interval a = argument(0).value_or(ANYWHERE), b = argument(1).value_or(ANYWHERE);
        return call.builtin->id == BuiltinId::min ? Interval{std::min(a.low, b.low), std::min(a.high, b.high)}
                                                  : Interval{std::max(a.low, b.low), std::max(a.high, b.high)};
    }
    case BuiltinId::clamp: {
        const auto low = argument(1), high = argument(2);
        return low && high ? accept({std::min(low->low, high->low), high->high}) : std::nullopt;
    }
    default:
        return std::nullopt;
    }
}

// A variable that is not set is 0 where it is an integer, so 0 belongs to every variable's interval.
std::optional<Interval> IntervalFinder::find_variable(std::uint32_t index, int depth) {
    if (const auto loop = m_loop_variables.find(index); loop != m_loop_variables.end() && !m_is_elsewhere)
        return loop->second;
    const auto [known, is_new] = m_known.try_emplace(index);
    if (!is_new)
        return known->second;
    const Assignments& assignments = m_assignments[index];
    const Variable& variable = m_program.variables[index];
    if (assignments.is_changed || assignments.is_exposed || variable.type == Type::list || variable.array_size > 0 ||
        index < std::size(PREDEFINED_VALUES))
        return std::nullopt;
    const bool was_elsewhere = std::exchange(m_is_elsewhere, true);
    std::optional<Interval> whole = Interval{0, 0};
    for (const Expression* const value : assignments.values) {
        const auto one = find(*value, depth + 1);
        whole = one && whole ? std::optional(unite(*one, *whole)) : std::nullopt;
    }
    m_is_elsewhere = was_elsewhere;
    m_known[index] = whole;
    return whole;
}

} // namespace photonloupe::script
