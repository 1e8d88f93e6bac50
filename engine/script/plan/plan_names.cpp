// SPDX-License-Identifier: Apache-2.0
// Sees through functions' parameters: what a name in an inlined body stands for.
#include "script/plan/plan.h"

#include "script/builtins.h"
#include "script/check/apply_operator.h"
#include "script/plan/substitute.h"

namespace photonloupe::script {
namespace {

Number to_number(const Expression& expression, double value) {
    Number number;
    if (expression.type == Type::integer)
        number.integer = std::int32_t(value);
    else
        number.real = float(value);
    return number;
}

double to_double(Type type, Number number) {
    return type == Type::integer ? number.integer : double(number.real);
}

// A variable that the loop does not write: others hold what they hold, or nothing yet.
std::optional<double> find_constant_variable(const Program& program, const PhotonLoop& loop, std::uint32_t index) {
    const auto use = loop.variables.find(index);
    if (use == loop.variables.end() || use->second.role != Role::uniform || loop.unset_reads.contains(index) ||
        program.variables[index].exposed)
        return std::nullopt;
    return program.variables[index].constant;
}

// What neither reports anything nor leaves anything out, as a run computes it.
std::optional<double> find_constant_operation(const Program& program, const PhotonLoop& loop, const Expression& e) {
    std::vector<Number> values;
    for (const Expression& operand : e.operands) {
        const std::optional<double> value = find_constant(program, loop, operand);
        if (!value)
            return std::nullopt;
        values.push_back(to_number(operand, *value));
    }
    const Type type = e.operands[0].type;
    if (e.kind == Expression::Kind::unary && e.operation == Operator::negate)
        return to_double(e.type, apply_unary(e.operation, type, values[0]));
    if (e.kind != Expression::Kind::binary || e.operands[1].type != type || e.operation == Operator::logical_and ||
        e.operation == Operator::logical_or ||
        (e.operation == Operator::modulo && (type == Type::integer ? values[1].integer == 0 : values[1].real == 0)))
        return std::nullopt;
    return to_double(e.type, apply_operator(e.operation, type, values[0], values[1]));
}

// Real results only: those that are whole may not fit.
std::optional<double> find_constant_call(const Program& program, const PhotonLoop& loop, const Expression& e) {
    if (e.builtin->effect != Effect::none || !e.builtin->reference || e.type != Type::real)
        return std::nullopt;
    std::vector<float> values;
    for (const Expression& operand : e.operands) {
        const std::optional<double> value = find_constant(program, loop, operand);
        if (!value)
            return std::nullopt;
        values.push_back(float(*value));
    }
    return e.builtin->reference(values);
}

} // namespace

bool PhotonLoop::has_reductions() const {
    for (const auto& [variable, use] : variables)
        if (use.role != Role::local && use.role != Role::uniform && use.role != Role::carried)
            return true;
    return pca_2d == AccumulatorUse::reduction || pca_3d == AccumulatorUse::reduction;
}

const PhotonLoop* Plan::find(const Statement& statement) const {
    for (const PhotonLoop& loop : loops)
        if (loop.statement == &statement)
            return &loop;
    return nullptr;
}

const Expression& resolve_given(const PhotonLoop& loop, const Expression& expression) {
    const Expression* e = &expression;
    while (true) {
        if (e->kind == Expression::Kind::convert) {
            e = &e->operands[0];
            continue;
        }
        const auto found = e->kind == Expression::Kind::variable ? loop.given.find(e->variable) : loop.given.end();
        if (found == loop.given.end())
            return *e;
        e = found->second;
    }
}

bool is_loop_photon(const PhotonLoop& loop, const Expression& expression) {
    const Expression& e = resolve_given(loop, expression);
    return e.kind == Expression::Kind::variable && e.variable == loop.statement->variable;
}

std::optional<double> find_constant(const Program& program, const PhotonLoop& loop, const Expression& expression) {
    const Expression& e = resolve_given(loop, expression);
    if (e.type != Type::integer && e.type != Type::real)
        return std::nullopt;
    if (e.kind == Expression::Kind::number)
        return e.type == Type::integer ? double(e.integer) : double(e.real);
    switch (e.kind) {
    case Expression::Kind::variable:
        return find_constant_variable(program, loop, e.variable);
    case Expression::Kind::unary:
    case Expression::Kind::binary:
        return find_constant_operation(program, loop, e);
    case Expression::Kind::builtin:
        return find_constant_call(program, loop, e);
    default:
        return std::nullopt;
    }
}

Expression substitute_given(const Program& program, const PhotonLoop& loop, const Expression& expression) {
    if (expression.kind == Expression::Kind::variable) {
        const Expression& given = resolve_given(loop, expression);
        if (&given != &expression)
            return substitute_given(program, loop, given);
        if (const std::optional<double> constant = find_constant(program, loop, expression)) {
            Expression number;
            number.type = expression.type;
            number.span = expression.span;
            number.integer = expression.type == Type::integer ? std::int32_t(*constant) : 0;
            number.real = float(*constant);
            return number;
        }
    }
    Expression copy = expression;
    for (Expression& operand : copy.operands)
        operand = substitute_given(program, loop, operand);
    return copy;
}

} // namespace photonloupe::script
