// SPDX-License-Identifier: Apache-2.0
// Follows the values of variables through straight code, to find what an exposed variable holds where it is exposed.
#include <map>

#include "script/check/check_stages.h"
#include "script/check/evaluate_constant.h"
#include "script/check/format_number.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

class DefaultFinder {
public:
    DefaultFinder(Program& program, Diagnostics& diagnostics) : m_program(program), m_diagnostics(diagnostics) {
        for (std::uint32_t i = 0; i < std::size(PREDEFINED_VALUES); ++i)
            m_values[i] = PREDEFINED_VALUES[i];
    }

    void find(const std::vector<Statement>& statements) {
        for (const Statement& statement : statements) {
            switch (statement.kind) {
            case Statement::Kind::expression:
                follow(*statement.value);
                break;
            case Statement::Kind::block:
                find(statement.body);
                break;
            case Statement::Kind::branch:
                find_in_branch(statement);
                break;
            case Statement::Kind::expose:
                check(statement);
                break;
            case Statement::Kind::declare:
                m_values.erase(statement.variable);
                break;
            default:
                forget(statement);
            }
        }
    }

private:
    using Values = std::map<std::uint32_t, double>;

    void follow(const Expression& expression) {
        visit_expressions(expression, [&](const Expression& part) { forget(part); });
        if (expression.kind != Expression::Kind::assignment || expression.operation != Operator::none)
            return;
        if (const std::optional<double> value = evaluate_constant(m_program, expression.operands[0]))
            m_values[expression.variable] = *value;
    }

    void forget(const Expression& expression) {
        if (expression.kind == Expression::Kind::assignment)
            m_values.erase(expression.variable);
    }

    void forget(const Statement& statement) {
        visit_expressions(std::vector<Statement>{statement}, [&](const Expression& part) { forget(part); });
    }

    void find_in_branch(const Statement& branch) {
        visit_expressions(*branch.value, [&](const Expression& part) { forget(part); });
        const Values before = m_values;
        find(branch.body);
        m_values = before;
        find(branch.otherwise);
        m_values = before;
        visit_expressions(branch.body, [&](const Expression& part) { forget(part); });
        visit_expressions(branch.otherwise, [&](const Expression& part) { forget(part); });
    }

    void check(const Statement& statement) {
        Variable& variable = m_program.variables[statement.variable];
        const Exposure& exposure = *variable.exposed;
        const auto found = m_values.find(statement.variable);
        if (found == m_values.end()) {
            m_diagnostics.add(codes::BAD_RANGE, exposure.span,
                              "the default of '" + variable.name + "' is not known here",
                              "assign it a number just before: " + variable.name + " = …;");
            return;
        }
        variable.default_value = found->second;
        if (exposure.low < exposure.high && !(found->second >= exposure.low && found->second <= exposure.high))
            m_diagnostics.add(codes::BAD_RANGE, exposure.span,
                              "the default of '" + variable.name + "', " + format_number(found->second) +
                                  ", is outside its range " + format_number(exposure.low) + " to " +
                                  format_number(exposure.high));
        m_values.erase(found);
    }

    Program& m_program;
    Diagnostics& m_diagnostics;
    Values m_values;
};

} // namespace

void check_exposed(Draft& draft, Diagnostics& diagnostics) {
    DefaultFinder(draft.program, diagnostics).find(draft.program.body);
}

} // namespace photonloupe::script
