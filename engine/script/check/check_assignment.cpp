// SPDX-License-Identifier: Apache-2.0
// Definite assignment: follows control through the script, functions entered at their calls.
#include "script/check/check_stages.h"

#include <utility>

#include "script/check/variable_set.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

struct State {
    bool is_reachable = true;
    VariableSet definite; // set on every path to here
    VariableSet possible; // set on some path
};

void merge(State& state, const State& other) {
    if (!other.is_reachable)
        return;
    if (!state.is_reachable) {
        state = other;
        return;
    }
    state.definite.intersect(other.definite);
    state.possible.unite(other.possible);
}

State make_unreachable() {
    State state;
    state.is_reachable = false;
    return state;
}

// Whether evaluating the expression always reads the variable.
bool always_reads(const Expression& expression, std::uint32_t variable) {
    if (expression.kind == Kind::variable && expression.variable == variable)
        return true;
    const bool is_lazy = expression.kind == Kind::conditional || expression.operation == Operator::logical_and ||
                         expression.operation == Operator::logical_or;
    const std::size_t sure = is_lazy ? 1 : expression.operands.size();
    for (std::size_t i = 0; i < sure; ++i)
        if (always_reads(expression.operands[i], variable))
            return true;
    return false;
}

// s += e and s = s + e need a value of s themselves: they are never its first.
bool gives_first_value(const Expression& assignment) {
    return assignment.operation == Operator::none && !always_reads(assignment.operands[0], assignment.variable);
}

bool is_always_true(const std::optional<Expression>& condition) {
    return !condition ||
           (condition->kind == Kind::number && condition->type == Type::integer && condition->integer != 0);
}

class AssignmentChecker {
public:
    AssignmentChecker(Draft& draft, Diagnostics& diagnostics) : m_program(draft.program), m_diagnostics(diagnostics) {
        m_state.definite = m_state.possible = VariableSet(m_program.variables.size());
        for (std::uint32_t i = 0; i < std::size(PREDEFINED_VALUES); ++i)
            set(i);
    }

    void check() { walk(m_program.body); }

private:
    // Where `break`, `continue` and `return` take control.
    struct Target {
        State leave = make_unreachable(), next = make_unreachable();
    };

    void set(std::uint32_t variable) {
        m_state.definite.insert(variable);
        m_state.possible.insert(variable);
    }

    void walk(std::vector<Statement>& statements) {
        for (Statement& statement : statements)
            walk(statement);
    }

    void walk(Statement& statement) {
        switch (statement.kind) {
        case Statement::Kind::expression:
            return read(*statement.value);
        case Statement::Kind::declare:
            if (m_program.variables[statement.variable].array_size > 0) {
                set(statement.variable);
            } else {
                m_state.definite.erase(statement.variable);
                m_state.possible.erase(statement.variable);
            }
            return;
        case Statement::Kind::branch:
            return walk_branch(statement);
        case Statement::Kind::loop:
            return walk_loop(statement);
        case Statement::Kind::photon_loop:
        case Statement::Kind::block:
            return walk(statement.body);
        case Statement::Kind::leave:
            return jump(m_loop->leave);
        case Statement::Kind::next:
            return jump(m_loop->next);
        case Statement::Kind::give:
            if (statement.value)
                read(*statement.value);
            return jump(*m_result);
        case Statement::Kind::expose:
            return set(statement.variable);
        }
    }

    void jump(State& target) {
        merge(target, m_state);
        m_state.is_reachable = false;
    }

    void walk_branch(Statement& branch) {
        read(*branch.value);
        State before = m_state;
        walk(branch.body);
        std::swap(before, m_state); // now `before` is the end of the body
        walk(branch.otherwise);
        merge(m_state, before);
    }

    void walk_loop(Statement& loop) {
        for (Expression& expression : loop.first)
            read(expression);
        add_possible(loop);
        Target target;
        Target* const outer = std::exchange(m_loop, &target);
        State exit = make_unreachable();
        if (!loop.test_last && loop.value) {
            read(*loop.value);
            if (!is_always_true(loop.value))
                exit = m_state;
        }
        walk(loop.body);
        merge(m_state, target.next);
        if (loop.test_last) {
            read(*loop.value);
            if (!is_always_true(loop.value))
                exit = m_state;
        }
        for (Expression& expression : loop.last)
            read(expression);
        m_loop = outer;
        m_state = std::move(exit);
        merge(m_state, target.leave);
    }

    // What a turn of the loop may have set is there in the next one.
    void add_possible(const Statement& loop) {
        const auto add = [&](const Expression& expression) {
            if (expression.kind == Kind::assignment && gives_first_value(expression))
                m_state.possible.insert(expression.variable);
        };
        visit_expressions(loop.body, add);
        for (const Expression& expression : loop.last)
            visit_expressions(expression, add);
        if (loop.value)
            visit_expressions(*loop.value, add);
    }

    void read(Expression& expression) {
        switch (expression.kind) {
        case Kind::variable:
            return read_variable(expression, expression.span);
        case Kind::binary:
            if (expression.operation == Operator::logical_and || expression.operation == Operator::logical_or)
                return read_lazily(expression);
            break;
        case Kind::conditional:
            return read_conditional(expression);
        case Kind::assignment:
            return read_assignment(expression);
        case Kind::call:
            return read_call(expression);
        default:
            break;
        }
        for (Expression& operand : expression.operands)
            read(operand);
    }

    void read_variable(Expression& expression, Span span) {
        if (!m_state.is_reachable || m_state.definite.contains(expression.variable))
            return;
        expression.may_be_unset = true;
        if (m_state.possible.contains(expression.variable))
            return;
        const Variable& variable = m_program.variables[expression.variable];
        m_diagnostics.add(codes::READ_BEFORE_SET, span, "'" + variable.name + "' is read before it has a value",
                          "give it one before: " + variable.name + " = …;");
        m_state.possible.insert(expression.variable); // told once
    }

    void read_lazily(Expression& expression) {
        read(expression.operands[0]);
        State left = m_state;
        read(expression.operands[1]);
        merge(m_state, left);
    }

    void read_conditional(Expression& expression) {
        read(expression.operands[0]);
        State before = m_state;
        read(expression.operands[1]);
        std::swap(before, m_state);
        read(expression.operands[2]);
        merge(m_state, before);
    }

    void read_assignment(Expression& assignment) {
        for (std::size_t i = assignment.operands.size(); i-- > 0;)
            read(assignment.operands[i]); // the index first
        if (m_program.variables[assignment.variable].array_size > 0)
            return;
        if (assignment.operation != Operator::none)
            read_variable(assignment, assignment.span);
        set(assignment.variable);
    }

    void read_call(Expression& call) {
        for (Expression& argument : call.operands)
            read(argument);
        Function& function = m_program.functions[call.function];
        for (const std::uint32_t parameter : function.parameters)
            set(parameter);
        State result = make_unreachable();
        State* const outer_result = std::exchange(m_result, &result);
        Target* const outer_loop = std::exchange(m_loop, nullptr);
        walk(function.body);
        m_result = outer_result;
        m_loop = outer_loop;
        merge(m_state, result);
    }

    Program& m_program;
    Diagnostics& m_diagnostics;
    State m_state;
    Target* m_loop = nullptr;
    State* m_result = nullptr;
};

} // namespace

void check_assignment(Draft& draft, Diagnostics& diagnostics) {
    AssignmentChecker(draft, diagnostics).check();
}

} // namespace photonloupe::script
