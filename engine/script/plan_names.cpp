// SPDX-License-Identifier: Apache-2.0
// Sees through functions' parameters: what a name in an inlined body stands for.
#include "script/plan.h"

#include "script/apply_operator.h"
#include "script/substitute.h"

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

double to_double(Type type, Number number) { return type == Type::integer ? number.integer : double(number.real); }

// Neither reports anything nor leaves anything out.
bool is_foldable(Operator operation) {
    return operation != Operator::modulo && operation != Operator::logical_and && operation != Operator::logical_or;
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
        const auto found =
            e->kind == Expression::Kind::variable ? loop.given.find(e->variable) : loop.given.end();
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
    if (e.kind == Expression::Kind::variable && !loop.unset_reads.contains(e.variable))
        return program.variables[e.variable].exposed ? std::nullopt : program.variables[e.variable].constant;
    if (e.kind == Expression::Kind::unary && e.operation == Operator::negate)
        if (const std::optional<double> value = find_constant(program, loop, e.operands[0]))
            return to_double(e.type, apply_unary(e.operation, e.operands[0].type, to_number(e.operands[0], *value)));
    if (e.kind == Expression::Kind::binary && is_foldable(e.operation))
        if (const std::optional<double> a = find_constant(program, loop, e.operands[0]))
            if (const std::optional<double> b = find_constant(program, loop, e.operands[1]))
                return to_double(e.type, apply_operator(e.operation, e.operands[0].type, to_number(e.operands[0], *a),
                                                        to_number(e.operands[1], *b)));
    return std::nullopt;
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
