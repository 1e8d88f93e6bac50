// SPDX-License-Identifier: Apache-2.0
// Evaluates what is constant, and finds the variables that are.
#include "script/check/evaluate_constant.h"

#include <cmath>

#include "script/builtins.h"
#include "script/check/apply_operator.h"
#include "script/check/assignments.h"
#include "script/reference_math.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

// Rounds of find_constants: constants given by constants given by …, against the order of the source.
constexpr int MAX_ROUNDS = 16;

std::optional<Number> evaluate(const Program& program, const Expression& expression);

Number make_number(Type type, double value) {
    Number number;
    if (type == Type::integer)
        number.integer = std::int32_t(value);
    else
        number.real = float(value);
    return number;
}

std::optional<Number> evaluate_builtin(const Program& program, const Expression& call) {
    const Builtin& builtin = *call.builtin;
    if (!builtin.reference)
        return std::nullopt;
    std::vector<float> reals;
    std::vector<std::int32_t> integers;
    for (const Expression& operand : call.operands) {
        const std::optional<Number> value = evaluate(program, operand);
        if (!value)
            return std::nullopt;
        reals.push_back(operand.type == Type::integer ? float(value->integer) : value->real);
        integers.push_back(operand.type == Type::integer ? value->integer : 0);
    }
    Number result;
    if (call.type == Type::integer && call.operands[0].type == Type::integer)
        result.integer = builtin.reference_integer(integers);
    else if (call.type == Type::integer)
        result.integer = convert_to_integer(builtin.reference(reals)).value;
    else
        result.real = builtin.reference(reals);
    return result;
}

std::optional<Number> evaluate_binary(const Program& program, const Expression& expression) {
    const Expression& left = expression.operands[0];
    const Expression& right = expression.operands[1];
    const std::optional<Number> a = evaluate(program, left), b = evaluate(program, right);
    if (!a || !b)
        return std::nullopt;
    if (expression.operation == Operator::logical_and || expression.operation == Operator::logical_or) {
        const bool x = is_true(left.type, *a), y = is_true(right.type, *b);
        return make_number(Type::integer, expression.operation == Operator::logical_and ? x && y : x || y);
    }
    return apply_operator(expression.operation, left.type, *a, *b);
}

std::optional<Number> evaluate(const Program& program, const Expression& expression) {
    switch (expression.kind) {
    case Kind::number:
        if (is_unknown(expression))
            return std::nullopt;
        return expression.type == Type::integer ? Number{.integer = expression.integer}
                                                : Number{.real = expression.real};
    case Kind::variable: {
        const Variable& variable = program.variables[expression.variable];
        if (expression.may_be_unset)
            return std::nullopt; // a run may find nothing there
        return variable.constant ? std::optional(make_number(variable.type, *variable.constant)) : std::nullopt;
    }
    case Kind::convert: {
        const std::optional<Number> value = evaluate(program, expression.operands[0]);
        return value ? std::optional(Number{.real = float(value->integer)}) : std::nullopt;
    }
    case Kind::unary: {
        const std::optional<Number> value = evaluate(program, expression.operands[0]);
        return value ? std::optional(apply_unary(expression.operation, expression.operands[0].type, *value))
                     : std::nullopt;
    }
    case Kind::binary:
        return evaluate_binary(program, expression);
    case Kind::conditional: {
        const Expression& condition = expression.operands[0];
        const std::optional<Number> decided = evaluate(program, condition);
        if (!decided)
            return std::nullopt;
        return evaluate(program, expression.operands[is_true(condition.type, *decided) ? 1 : 2]);
    }
    case Kind::builtin:
        return evaluate_builtin(program, expression);
    default:
        return std::nullopt;
    }
}

// The one value of all assignments, if it is known.
std::optional<double> find_constant(const Program& program, std::uint32_t index, const Assignments& assignments) {
    std::optional<double> constant;
    if (index < std::size(PREDEFINED_VALUES))
        constant = program.variables[index].type == Type::real ? double(float(PREDEFINED_VALUES[index]))
                                                               : PREDEFINED_VALUES[index];
    for (const Expression* const value : assignments.values) {
        const std::optional<double> one = evaluate_constant(program, *value);
        if (!one || (constant && (*constant != *one || std::signbit(*constant) != std::signbit(*one))))
            return std::nullopt; // NaN is no constant: it equals nothing
        constant = one;
    }
    return constant && *constant == *constant ? constant : std::nullopt;
}

} // namespace

std::optional<double> evaluate_constant(const Program& program, const Expression& expression) {
    const std::optional<Number> value = evaluate(program, expression);
    if (!value)
        return std::nullopt;
    return expression.type == Type::integer ? double(value->integer) : double(value->real);
}

void find_constants(Draft& draft) {
    const std::vector<Assignments> assignments = collect_assignments(draft);
    for (Variable& variable : draft.program.variables)
        variable.constant.reset();
    bool has_changed = true;
    for (int round = 0; round < MAX_ROUNDS && has_changed; ++round) {
        has_changed = false;
        for (std::uint32_t i = 0; i < assignments.size(); ++i) {
            Variable& variable = draft.program.variables[i];
            if (variable.constant || variable.type == Type::list || variable.array_size > 0 ||
                assignments[i].is_changed || assignments[i].is_exposed)
                continue;
            variable.constant = find_constant(draft.program, i, assignments[i]);
            has_changed |= variable.constant.has_value();
        }
    }
}

} // namespace photonloupe::script
