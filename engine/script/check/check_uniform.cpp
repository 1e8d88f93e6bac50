// SPDX-License-Identifier: Apache-2.0
// Arguments that are the same for all photons, made computable before the loop that uses them.
#include <map>
#include <set>

#include "script/builtins.h"
#include "script/check/assignments.h"
#include "script/check/check_stages.h"
#include "script/check/variable_set.h"
#include "script/check/walk_calls.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

constexpr std::size_t MAX_PARTS = 256; // of an argument once parameters are replaced by what they stand for

struct LoopFacts {
    VariableSet assigned;
    bool sets_parameters = false;
};

template <class Visit>
void visit_own_expressions(const Statement& statement, Visit&& visit) {
    for (const Expression& expression : statement.first)
        visit_expressions(expression, visit);
    if (statement.value)
        visit_expressions(*statement.value, visit);
    for (const Expression& expression : statement.last)
        visit_expressions(expression, visit);
}

class UniformChecker {
public:
    UniformChecker(Draft& draft, Diagnostics& diagnostics)
        : m_program(draft.program), m_diagnostics(diagnostics), m_assignments(collect_assignments(draft)) {}

    void check() {
        walk_calls(m_program, [&](const Statement& statement, const Statement* loop) { gather(statement, loop); });
        rewrite(m_program.body);
        for (Function& function : m_program.functions)
            rewrite(function.body);
    }

private:
    void gather(const Statement& statement, const Statement* loop) {
        const bool is_outermost = statement.kind == Statement::Kind::photon_loop && !loop;
        if (!loop && !is_outermost)
            return;
        LoopFacts& facts = m_facts[is_outermost ? &statement : loop];
        if (statement.kind == Statement::Kind::photon_loop || statement.kind == Statement::Kind::declare)
            facts.assigned.insert(statement.variable);
        visit_own_expressions(statement, [&](const Expression& expression) {
            if (expression.kind == Kind::assignment) {
                facts.assigned.insert(expression.variable);
            } else if (expression.kind == Kind::call) {
                for (const std::uint32_t parameter : m_program.functions[expression.function].parameters)
                    facts.assigned.insert(parameter);
            } else if (expression.kind == Kind::builtin) {
                facts.sets_parameters |= expression.builtin->id == BuiltinId::set_photon_parameter;
                m_loops[&expression] = is_outermost ? &statement : loop;
            }
        });
    }

    void rewrite(std::vector<Statement>& statements) {
        for (Statement& statement : statements) {
            for (Expression& expression : statement.first)
                rewrite(expression);
            if (statement.value)
                rewrite(*statement.value);
            rewrite(statement.body);
            rewrite(statement.otherwise);
            for (Expression& expression : statement.last)
                rewrite(expression);
        }
    }

    void rewrite(Expression& expression) {
        for (Expression& operand : expression.operands)
            rewrite(operand);
        const auto loop = expression.kind == Kind::builtin ? m_loops.find(&expression) : m_loops.end();
        if (loop == m_loops.end())
            return;
        const Builtin& builtin = *expression.builtin;
        for (std::size_t i = 0; i < expression.operands.size() && i < builtin.arguments.size(); ++i) {
            const Argument argument = builtin.arguments[i];
            if (argument == Argument::uniform_count || argument == Argument::uniform_number ||
                argument == Argument::bin_count)
                rewrite_argument(builtin, expression.operands[i], m_facts[loop->second]);
        }
    }

    void rewrite_argument(const Builtin& builtin, Expression& argument, const LoopFacts& facts) {
        m_facts_now = &facts;
        m_culprit = nullptr;
        m_parts = 0;
        std::optional<Expression> uniform = substitute(argument);
        if (uniform) {
            uniform->span = argument.span;
            argument = std::move(*uniform);
            return;
        }
        std::string what = "it is given by more than can be computed before the loop";
        if (m_culprit && m_culprit->kind == Kind::builtin)
            what = "it depends on '" + std::string(m_culprit->builtin->name) + "'";
        else if (m_culprit)
            what = "it depends on '" + m_program.variables[m_culprit->variable].name + "', which the loop assigns";
        m_diagnostics.add(codes::NOT_UNIFORM, argument.span,
                          "this argument of '" + std::string(builtin.name) +
                              "' must be the same for all photons, but " + what,
                          "compute it before the loop");
    }

    std::optional<Expression> refuse(const Expression& culprit) {
        m_culprit = &culprit;
        return std::nullopt;
    }

    std::optional<Expression> substitute(const Expression& expression) {
        if (++m_parts > MAX_PARTS || expression.kind == Kind::call || expression.kind == Kind::assignment)
            return std::nullopt;
        if (expression.kind == Kind::variable)
            return substitute_variable(expression);
        if (expression.kind == Kind::element && m_facts_now->assigned.contains(expression.variable))
            return refuse(expression);
        if (expression.kind == Kind::builtin) {
            const Builtin& builtin = *expression.builtin;
            const bool is_set = builtin.id == BuiltinId::get_photon_parameter && m_facts_now->sets_parameters;
            if (is_set || (builtin.effect != Effect::none && builtin.effect != Effect::reads_photon))
                return refuse(expression);
        }
        Expression copy = expression;
        for (std::size_t i = 0; i < copy.operands.size(); ++i) {
            std::optional<Expression> operand = substitute(expression.operands[i]);
            if (!operand)
                return std::nullopt;
            copy.operands[i] = std::move(*operand);
        }
        return copy;
    }

    std::optional<Expression> substitute_variable(const Expression& expression) {
        if (!m_facts_now->assigned.contains(expression.variable))
            return expression;
        const Variable& variable = m_program.variables[expression.variable];
        if (variable.constant && !expression.may_be_unset) {
            Expression number;
            number.type = variable.type;
            number.span = expression.span;
            if (variable.type == Type::integer)
                number.integer = std::int32_t(*variable.constant);
            else
                number.real = float(*variable.constant);
            return number;
        }
        const Expression* const argument = find_argument(expression.variable);
        return argument ? substitute(*argument) : refuse(expression);
    }

    // What a parameter stands for, if nothing else is ever assigned to it.
    const Expression* find_argument(std::uint32_t variable) {
        if (m_arguments.empty())
            for (const Function& function : m_program.functions)
                for (const std::uint32_t parameter : function.parameters)
                    m_arguments.insert(parameter);
        const Assignments& assignments = m_assignments[variable];
        const bool is_only =
            m_arguments.contains(variable) && !assignments.is_changed && assignments.values.size() == 1;
        return is_only ? assignments.values[0] : nullptr;
    }

    Program& m_program;
    Diagnostics& m_diagnostics;
    std::vector<Assignments> m_assignments;
    std::map<const Statement*, LoopFacts> m_facts;
    std::map<const Expression*, const Statement*> m_loops; // predefined calls inside photon loops
    std::set<std::uint32_t> m_arguments;
    const LoopFacts* m_facts_now = nullptr;
    const Expression* m_culprit = nullptr;
    std::size_t m_parts = 0;
};

} // namespace

void check_uniform_arguments(Draft& draft, Diagnostics& diagnostics) {
    UniformChecker(draft, diagnostics).check();
}

} // namespace photonloupe::script
