// SPDX-License-Identifier: Apache-2.0
// Counts the turns of counting loops, along the nest and through calls.
#include "script/check/check_stages.h"

#include <cmath>

#include "script/check/evaluate_constant.h"
#include "script/check/find_interval.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

// What a loop counts with, if it is a counting loop.
struct Counter {
    std::uint32_t variable = 0;
    double step = 0;
    Interval range;
    double turns = 0;
};

class LoopBounder {
public:
    explicit LoopBounder(Draft& draft) : m_program(draft.program), m_intervals(draft) {}

    void bound() { walk(m_program.body, 1); }

private:
    // `turns`: of the loops around, together; infinite where one is not bounded.
    void walk(std::vector<Statement>& statements, double turns) {
        for (Statement& statement : statements)
            walk(statement, turns);
    }

    void walk(Statement& statement, double turns) {
        for (const Expression& expression : statement.first)
            walk(expression, turns);
        if (statement.kind == Statement::Kind::photon_loop) {
            walk(statement.body, 1); // a bound holds for each photon
        } else if (statement.kind == Statement::Kind::loop) {
            walk_loop(statement, turns);
        } else {
            if (statement.value)
                walk(*statement.value, turns);
            walk(statement.body, turns);
            walk(statement.otherwise, turns);
        }
    }

    void walk(const Expression& expression, double turns) {
        for (const Expression& operand : expression.operands)
            walk(operand, turns);
        if (expression.kind == Kind::call)
            walk(m_program.functions[expression.function].body, turns);
    }

    void walk_loop(Statement& loop, double turns) {
        const std::optional<Counter> counter = find_counter(loop);
        const double inside = counter ? turns * std::max(counter->turns, 1.0) : HUGE_VAL;
        loop.is_bounded = inside <= MAX_BOUNDED_TURNS;
        if (counter)
            m_intervals.loop_variables()[counter->variable] = counter->range;
        if (loop.value)
            walk(*loop.value, inside);
        walk(loop.body, inside);
        for (const Expression& expression : loop.last)
            walk(expression, inside);
        if (counter)
            m_intervals.loop_variables().erase(counter->variable);
    }

    std::optional<Counter> find_counter(const Statement& loop) {
        if (loop.test_last || !loop.value)
            return std::nullopt;
        for (const Expression& last : loop.last)
            if (const std::optional<double> step = find_step(last)) {
                Counter counter{last.variable, *step};
                if (is_steady(loop, last) && find_turns(loop, counter))
                    return counter;
            }
        return std::nullopt;
    }

    // i++, i -= 2, i = i + 3: the constant; nothing for other expressions.
    std::optional<double> find_step(const Expression& last) const {
        if (last.kind != Kind::assignment || last.operands.size() != 1 || last.type != Type::integer)
            return std::nullopt;
        const Expression* amount = &last.operands[0];
        Operator operation = last.operation;
        if (operation == Operator::none && amount->kind == Kind::binary && amount->operands[0].kind == Kind::variable &&
            amount->operands[0].variable == last.variable) {
            operation = amount->operation;
            amount = &amount->operands[1];
        }
        const std::optional<double> constant = evaluate_constant(m_program, *amount);
        if (!constant || *constant == 0 || std::fabs(*constant) > MAX_BOUNDED_TURNS)
            return std::nullopt;
        return operation == Operator::add        ? constant
               : operation == Operator::subtract ? std::optional(-*constant)
                                                 : std::nullopt;
    }

    // Nothing but its step assigns the loop's variable while the loop runs.
    bool is_steady(const Statement& loop, const Expression& step) const {
        bool is_steady = true;
        const auto look = [&](const Expression& expression) {
            is_steady &=
                expression.kind != Kind::assignment || expression.variable != step.variable || &expression == &step;
        };
        visit_expressions(loop.body, look);
        visit_expressions(*loop.value, look);
        for (const Expression& expression : loop.last)
            visit_expressions(expression, look);
        visit_declarations(loop.body, step.variable, is_steady);
        return is_steady;
    }

    static void visit_declarations(const std::vector<Statement>& body, std::uint32_t variable, bool& is_steady) {
        for (const Statement& statement : body) {
            is_steady &= statement.kind != Statement::Kind::photon_loop || statement.variable != variable;
            visit_declarations(statement.body, variable, is_steady);
            visit_declarations(statement.otherwise, variable, is_steady);
        }
    }

    bool find_turns(const Statement& loop, Counter& counter) {
        const Expression* start = nullptr;
        for (const Expression& first : loop.first)
            if (first.kind == Kind::assignment && first.variable == counter.variable &&
                first.operation == Operator::none)
                start = &first.operands[0];
        const std::optional<Interval> from = start ? m_intervals.find(*start) : std::nullopt;
        return from && find_limit(*loop.value, *from, counter);
    }

    // Any part of a conjunction may hold the limit.
    bool find_limit(const Expression& condition, const Interval& from, Counter& counter) {
        if (condition.kind != Kind::binary)
            return false;
        const Expression& left = condition.operands[0];
        const Expression& right = condition.operands[1];
        switch (condition.operation) {
        case Operator::logical_and:
            return find_limit(left, from, counter) || find_limit(right, from, counter);
        case Operator::less:
        case Operator::less_equal:
            return counter.step > 0 ? match_limit(left, right, from, counter) : match_limit(right, left, from, counter);
        case Operator::greater:
        case Operator::greater_equal:
            return counter.step > 0 ? match_limit(right, left, from, counter) : match_limit(left, right, from, counter);
        default:
            return false;
        }
    }

    bool match_limit(const Expression& counted, const Expression& limit, const Interval& from, Counter& counter) {
        const Expression& name = counted.kind == Kind::convert ? counted.operands[0] : counted;
        if (name.kind != Kind::variable || name.variable != counter.variable)
            return false;
        const std::optional<Interval> to = m_intervals.find(limit);
        if (!to)
            return false;
        const double distance = counter.step > 0 ? to->high - from.low : from.high - to->low;
        counter.turns = std::max(0.0, std::floor(distance / std::fabs(counter.step)) + 1);
        counter.range = counter.step > 0 ? Interval{from.low, std::max(from.low, to->high)}
                                         : Interval{std::min(to->low, from.high), from.high};
        return true;
    }

    Program& m_program;
    IntervalFinder m_intervals;
};

} // namespace

void bound_loops(Draft& draft) {
    LoopBounder(draft).bound();
}

} // namespace photonloupe::script
