// SPDX-License-Identifier: Apache-2.0
// Matches loops against the forms of a photon loop.
#include "script/check/check_stages.h"

#include <algorithm>

#include "script/builtins.h"
#include "script/check/assignments.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

bool is_integer(const Expression& expression, std::int32_t value) {
    return expression.kind == Kind::number && expression.type == Type::integer && expression.integer == value;
}

// Also of a variable of reals, where every number has become one.
bool is_number(const Expression& expression, std::int32_t value) {
    return is_integer(expression, value) ||
           (expression.kind == Kind::number && expression.type == Type::real && expression.real == float(value));
}

const Expression& skip_conversion(const Expression& expression) {
    return expression.kind == Kind::convert ? expression.operands[0] : expression;
}

bool is_variable(const Expression& expression, std::uint32_t variable) {
    return expression.kind == Kind::variable && expression.variable == variable;
}

// i++, ++i, i += 1, i = i + 1, i = 1 + i
bool is_step_of_one(const Expression& expression) {
    if (expression.kind != Kind::assignment || expression.operands.size() != 1)
        return false;
    const Expression& value = expression.operands[0];
    if (expression.operation == Operator::add)
        return is_number(value, 1);
    if (expression.operation != Operator::none || value.kind != Kind::binary || value.operation != Operator::add)
        return false;
    const Expression& a = value.operands[0];
    const Expression& b = value.operands[1];
    return (is_variable(a, expression.variable) && is_number(b, 1)) ||
           (is_variable(b, expression.variable) && is_number(a, 1));
}

class PhotonLoopFinder {
public:
    PhotonLoopFinder(Draft& draft, Diagnostics& diagnostics) : m_program(draft.program), m_diagnostics(diagnostics) {}

    void find() { walk(m_program.body); }

private:
    void walk(std::vector<Statement>& statements) {
        for (Statement& statement : statements)
            walk(statement);
    }

    void walk(Statement& statement) {
        const bool is_found = statement.kind == Statement::Kind::loop && !m_is_inside && is_photon_loop(statement);
        if (is_found)
            rewrite(statement);
        for (const Expression& expression : statement.first)
            walk(expression);
        if (statement.value)
            walk(*statement.value);
        m_is_inside = m_is_inside || is_found;
        walk(statement.body);
        walk(statement.otherwise);
        m_is_inside = m_is_inside && !is_found;
        for (const Expression& expression : statement.last)
            walk(expression);
    }

    void walk(const Expression& expression) {
        for (const Expression& operand : expression.operands)
            walk(operand);
        if (expression.kind == Kind::call)
            walk(m_program.functions[expression.function].body);
        if (expression.kind == Kind::builtin && expression.builtin->effect == Effect::declares && m_is_inside)
            m_diagnostics.add(codes::DECLARED_INSIDE, expression.span,
                              "'" + std::string(expression.builtin->name) + "' stands inside a photon loop",
                              "a parameter is declared once, before the loop");
    }

    bool is_photon_loop(const Statement& loop) {
        if (loop.test_last || loop.first.size() != 1 || loop.last.size() != 1 || !loop.value)
            return false;
        const Expression& start = loop.first[0];
        if (start.kind != Kind::assignment || start.operation != Operator::none || start.operands.size() != 1 ||
            !is_number(start.operands[0], 0))
            return false;
        const std::uint32_t variable = start.variable;
        if (!is_step_of_one(loop.last[0]) || loop.last[0].variable != variable ||
            !is_over_photons(*loop.value, variable))
            return false;
        if (m_program.variables[variable].type == Type::integer)
            return true;
        m_diagnostics.add(codes::REAL_LOOP_VARIABLE, loop.span,
                          "this is no photon loop, since '" + m_program.variables[variable].name +
                              "' holds real numbers too",
                          "use a variable of its own for the loop");
        return false;
    }

    // i < n, i <= n - 1, and the same turned around
    bool is_over_photons(const Expression& condition, std::uint32_t variable) const {
        if (condition.kind != Kind::binary)
            return false;
        const bool is_turned =
            condition.operation == Operator::greater || condition.operation == Operator::greater_equal;
        const Expression& left = skip_conversion(condition.operands[is_turned ? 1 : 0]);
        const Expression& right = skip_conversion(condition.operands[is_turned ? 0 : 1]);
        if (!is_variable(left, variable))
            return false;
        if (condition.operation == Operator::less || condition.operation == Operator::greater)
            return is_photon_count(right);
        if (condition.operation != Operator::less_equal && condition.operation != Operator::greater_equal)
            return false;
        return right.kind == Kind::binary && right.operation == Operator::subtract &&
               is_photon_count(skip_conversion(right.operands[0])) && is_number(right.operands[1], 1);
    }

    bool is_photon_count(const Expression& expression) const {
        if (expression.kind == Kind::variable)
            return m_program.variables[expression.variable].holds_photon_count && !expression.may_be_unset;
        return expression.kind == Kind::builtin && expression.builtin->id == BuiltinId::get_num_photons;
    }

    static void rewrite(Statement& loop) {
        loop.kind = Statement::Kind::photon_loop;
        loop.variable = loop.first[0].variable;
        loop.first.clear();
        loop.last.clear();
        loop.value.reset();
    }

    Program& m_program;
    Diagnostics& m_diagnostics;
    bool m_is_inside = false;
};

bool gives_photon_count(const Program& program, const Expression* value) {
    const Expression& given = skip_conversion(*value);
    if (given.kind == Kind::variable)
        return program.variables[given.variable].holds_photon_count && !given.may_be_unset;
    return given.kind == Kind::builtin && given.builtin->id == BuiltinId::get_num_photons;
}

// n = getNumPhotons(); m = n; …, in rounds for the sake of functions' parameters.
void find_photon_counts(Draft& draft) {
    constexpr int MAX_ROUNDS = 16;
    const std::vector<Assignments> all = collect_assignments(draft);
    bool has_changed = true;
    for (int round = 0; round < MAX_ROUNDS && has_changed; ++round) {
        has_changed = false;
        for (std::size_t i = std::size(PREDEFINED_VALUES); i < all.size(); ++i) {
            Variable& variable = draft.program.variables[i];
            const Assignments& assignments = all[i];
            if (variable.holds_photon_count || assignments.is_changed || assignments.is_exposed ||
                assignments.values.empty() || variable.array_size > 0)
                continue;
            variable.holds_photon_count =
                std::all_of(assignments.values.begin(), assignments.values.end(),
                            [&](const Expression* value) { return gives_photon_count(draft.program, value); });
            has_changed |= variable.holds_photon_count;
        }
    }
}

} // namespace

void find_photon_loops(Draft& draft, Diagnostics& diagnostics) {
    find_photon_counts(draft);
    PhotonLoopFinder(draft, diagnostics).find();
}

} // namespace photonloupe::script
