// SPDX-License-Identifier: Apache-2.0
// Real numbers spread along assignments: a graph of variables, searched from those that are given a real one.
#include "script/check/check_stages.h"

#include "script/builtins.h"
#include "script/reference_math.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

// What decides an expression's type: it is real if `is_real`, or if any of the sources is.
struct Origin {
    bool is_real = false;
    std::vector<std::uint32_t> sources;
};

// Nodes are the variables, then the functions' results.
class TypeGraph {
public:
    explicit TypeGraph(Draft& draft)
        : m_draft(draft), m_variable_count(draft.program.variables.size()),
          m_is_real(m_variable_count + draft.program.functions.size()), m_dependents(m_is_real.size()) {}

    void solve() {
        seed_declared();
        add_statements(m_draft.program.body, 0);
        for (std::size_t f = 0; f < m_draft.program.functions.size(); ++f) {
            add_statements(m_draft.program.functions[f].body, m_variable_count + f);
        }
        spread();
        for (std::size_t v = 0; v < m_variable_count; ++v)
            if (Variable& variable = m_draft.program.variables[v]; variable.type != Type::list)
                variable.type = m_is_real[v] ? Type::real : Type::integer;
        for (std::size_t f = 0; f < m_draft.program.functions.size(); ++f)
            if (Function& function = m_draft.program.functions[f]; function.result != Type::none)
                function.result = m_is_real[m_variable_count + f] ? Type::real : Type::integer;
    }

private:
    WrittenType find_written(std::size_t node) const {
        return node < m_variable_count ? m_draft.variable_types[node] : m_draft.result_types[node - m_variable_count];
    }

    void make_real(std::size_t node) {
        if (m_is_real[node] || find_written(node) == WrittenType::integer)
            return;
        m_is_real[node] = true;
        m_pending.push_back(std::uint32_t(node));
    }

    void seed_declared() {
        for (std::size_t node = 0; node < m_is_real.size(); ++node)
            if (find_written(node) == WrittenType::real)
                make_real(node);
        for (std::size_t v = 0; v < std::size(PREDEFINED_VALUES); ++v)
            if (PREDEFINED_VALUES[v] != double(int(PREDEFINED_VALUES[v])))
                make_real(v);
    }

    void spread() {
        while (!m_pending.empty()) {
            const std::uint32_t node = m_pending.back();
            m_pending.pop_back();
            for (const std::uint32_t dependent : m_dependents[node])
                make_real(dependent);
        }
    }

    void add_edge(const Origin& origin, std::size_t target) {
        if (origin.is_real)
            make_real(target);
        for (const std::uint32_t source : origin.sources)
            m_dependents[source].push_back(std::uint32_t(target));
    }

    void add_statements(const std::vector<Statement>& statements, std::size_t result_node) {
        visit_expressions(statements, [&](const Expression& expression) { add_expression(expression); });
        add_results(statements, result_node);
    }

    void add_results(const std::vector<Statement>& statements, std::size_t result_node) {
        for (const Statement& statement : statements) {
            if (statement.kind == Statement::Kind::give && statement.value)
                add_edge(trace(*statement.value), result_node);
            add_results(statement.body, result_node);
            add_results(statement.otherwise, result_node);
        }
    }

    // What assigns: assignments, and calls to their parameters.
    void add_expression(const Expression& expression) {
        if (expression.kind == Kind::assignment && expression.type != Type::list) {
            Origin origin = trace(expression.operands[0]);
            origin.is_real |= expression.operation == Operator::divide;
            add_edge(origin, expression.variable);
        } else if (expression.kind == Kind::call) {
            const Function& function = m_draft.program.functions[expression.function];
            for (std::size_t i = 0; i < function.parameters.size(); ++i)
                add_edge(trace(expression.operands[i]), function.parameters[i]);
        }
    }

    Origin trace(const Expression& expression) const {
        Origin origin;
        trace(expression, origin);
        return origin;
    }

    void trace(const Expression& expression, Origin& origin) const {
        switch (expression.kind) {
        case Kind::number:
            origin.is_real |= expression.type == Type::real;
            return;
        case Kind::variable:
        case Kind::element:
        case Kind::assignment:
            origin.sources.push_back(expression.variable);
            return;
        case Kind::call:
            origin.sources.push_back(std::uint32_t(m_variable_count + expression.function));
            return;
        case Kind::unary:
            if (expression.operation == Operator::negate)
                trace(expression.operands[0], origin);
            return;
        case Kind::binary:
            return trace_binary(expression, origin);
        case Kind::conditional:
            trace(expression.operands[1], origin);
            trace(expression.operands[2], origin);
            return;
        case Kind::builtin:
            return trace_builtin(expression, origin);
        default:
            return; // list items and lengths are integers
        }
    }

    void trace_binary(const Expression& expression, Origin& origin) const {
        switch (expression.operation) {
        case Operator::divide:
            origin.is_real = true;
            return;
        case Operator::add:
        case Operator::subtract:
        case Operator::multiply:
        case Operator::modulo:
            trace(expression.operands[0], origin);
            trace(expression.operands[1], origin);
            return;
        default:
            return; // comparisons give 0 or 1
        }
    }

    void trace_builtin(const Expression& call, Origin& origin) const {
        if (call.builtin->id == BuiltinId::pow) {
            origin.is_real |= !is_integer_power(call, true);
            trace(call.operands[0], origin);
        } else if (call.builtin->result == Result::as_arguments) {
            for (const Expression& argument : call.operands)
                trace(argument, origin);
        } else {
            origin.is_real |= call.builtin->result == Result::real;
        }
    }

    Draft& m_draft;
    std::size_t m_variable_count;
    std::vector<bool> m_is_real;
    std::vector<std::vector<std::uint32_t>> m_dependents;
    std::vector<std::uint32_t> m_pending;
};

} // namespace

bool is_integer_power(const Expression& call, bool is_integer_base) {
    const Expression& base = call.operands[0];
    const Expression& exponent = call.operands[1];
    const auto is_literal = [](const Expression& e) { return e.kind == Kind::number && e.type == Type::integer; };
    if (!is_integer_base || !is_literal(exponent) || exponent.integer < 0)
        return false;
    return !is_literal(base) || raise_integer(base.integer, exponent.integer).fits;
}

void infer_types(Draft& draft) {
    TypeGraph(draft).solve();
}

} // namespace photonloupe::script
