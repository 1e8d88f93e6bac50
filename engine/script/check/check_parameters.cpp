// SPDX-License-Identifier: Apache-2.0
// Declarations of photon parameters, as far as dimensions are known when the script is compiled.
#include <map>
#include <set>

#include "script/builtins.h"
#include "script/check/check_stages.h"
#include "script/check/evaluate_constant.h"
#include "script/check/walk_calls.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

constexpr int FIRST_DIMENSION = 3;

struct Declared {
    std::map<int, const Expression*> calls; // by dimension
    bool is_complete = true;                // false: some dimension is known at run time only
};

std::optional<int> find_dimension(const Program& program, const Expression& argument) {
    const std::optional<double> value = evaluate_constant(program, argument);
    const bool fits = value && *value >= FIRST_DIMENSION && *value <= 15 && *value == int(*value);
    return fits ? std::optional(int(*value)) : std::nullopt;
}

// The calls that a run always reaches if it reaches the script's end: not under a condition.
void collect_certain(const Program& program, const std::vector<Statement>& statements,
                     std::set<const Expression*>& certain) {
    for (const Statement& statement : statements) {
        if (statement.kind == Statement::Kind::expression)
            visit_expressions(*statement.value, [&](const Expression& expression) {
                if (expression.kind == Expression::Kind::builtin)
                    certain.insert(&expression);
                else if (expression.kind == Expression::Kind::call)
                    collect_certain(program, program.functions[expression.function].body, certain);
            });
        else if (statement.kind == Statement::Kind::block)
            collect_certain(program, statement.body, certain);
    }
}

class DeclarationCollector {
public:
    DeclarationCollector(const Program& program, Diagnostics& diagnostics)
        : m_program(program), m_diagnostics(diagnostics) {
        collect_certain(program, program.body, m_certain);
    }

    Declared collect() {
        walk_calls(m_program, [&](const Statement& statement, const Statement*) {
            if (statement.value)
                visit_expressions(*statement.value, [&](const Expression& call) { add(call); });
            for (const std::vector<Expression>* list : {&statement.first, &statement.last})
                for (const Expression& expression : *list)
                    visit_expressions(expression, [&](const Expression& call) { add(call); });
        });
        return std::move(m_declared);
    }

private:
    void add(const Expression& call) {
        if (call.kind != Expression::Kind::builtin || call.builtin->effect != Effect::declares)
            return;
        const bool is_certain = m_certain.contains(&call);
        if (call.operands.size() > 3 && call.operands[3].kind == Expression::Kind::text && is_certain &&
            !m_labels.insert(call.operands[3].label).second)
            m_diagnostics.add(codes::NAME_TAKEN, call.operands[3].span,
                              "two parameters are called '" + call.operands[3].label + "'");
        const std::optional<int> dimension = find_dimension(m_program, call.operands[0]);
        if (!dimension) { // a wrong one has been refused
            m_declared.is_complete &= evaluate_constant(m_program, call.operands[0]).has_value();
            return;
        }
        const auto [place, is_new] = m_declared.calls.try_emplace(*dimension, &call);
        if (!is_new && is_certain && m_certain.contains(place->second))
            m_diagnostics.add(codes::BAD_DIMENSION, call.operands[0].span,
                              "dimension " + std::to_string(*dimension) + " is declared twice");
    }

    const Program& m_program;
    Diagnostics& m_diagnostics;
    std::set<const Expression*> m_certain;
    std::set<std::string> m_labels;
    Declared m_declared;
};

void check_gaps(const Declared& declared, Diagnostics& diagnostics) {
    int expected = FIRST_DIMENSION;
    for (const auto& [dimension, call] : declared.calls) {
        if (dimension != expected) {
            diagnostics.add(codes::BAD_DIMENSION, call->operands[0].span,
                            "dimension " + std::to_string(dimension) + " leaves a gap: " + std::to_string(expected) +
                                " is not declared",
                            "parameters are numbered 3, 4, 5 and so on");
            return;
        }
        ++expected;
    }
}

} // namespace

void check_parameters(const Draft& draft, Diagnostics& diagnostics) {
    const Program& program = draft.program;
    const Declared declared = DeclarationCollector(program, diagnostics).collect();
    if (!declared.is_complete)
        return;
    check_gaps(declared, diagnostics);
    draft.visit_bodies([&](const std::vector<Statement>& body) {
        visit_expressions(body, [&](const Expression& call) {
            if (call.kind != Expression::Kind::builtin || call.builtin->id != BuiltinId::set_photon_parameter)
                return;
            const std::optional<int> dimension = find_dimension(program, call.operands[1]);
            if (dimension && !declared.calls.contains(*dimension))
                diagnostics.add(codes::UNDECLARED_DIMENSION, call.operands[1].span,
                                "no parameter is declared in dimension " + std::to_string(*dimension),
                                "declarePhotonParameter(" + std::to_string(*dimension) + ", lo, hi)");
        });
    });
}

} // namespace photonloupe::script
