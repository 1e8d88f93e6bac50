// SPDX-License-Identifier: Apache-2.0
// The interpreter's statements, and how a run begins.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "core/error.h"
#include "script/interpret/interpreter.h"

namespace photonloupe::script {
namespace {

// Turns and photons between two looks at the clock and at who may want to stop: a fraction of 0.2 s with long bodies.
constexpr std::uint64_t STEPS_PER_LOOK = 4096;

void collect_locals(const Program& program, const std::vector<Statement>& statements, std::set<std::uint32_t>& locals) {
    for (const Statement& statement : statements) {
        if (statement.kind == Statement::Kind::declare)
            locals.insert(statement.variable);
        collect_locals(program, statement.body, locals);
        collect_locals(program, statement.otherwise, locals);
    }
    visit_expressions(statements, [&](const Expression& expression) {
        if (expression.kind == Expression::Kind::assignment && program.variables[expression.variable].is_local)
            locals.insert(expression.variable);
    });
}

// Throws Error when the variable is not exposed, or the value not in its range.
void check_value(const Program& program, const std::string& name, double value) {
    for (const std::uint32_t index : program.exposed) {
        const Variable& variable = program.variables[index];
        if (variable.name != name)
            continue;
        const Exposure& range = *variable.exposed;
        std::ostringstream text;
        text << name << " is " << value << "; it must be " << (range.is_integer ? "a whole number " : "") << "from "
             << range.low << " to " << range.high;
        if (!(value >= range.low && value <= range.high) || (range.is_integer && value != std::trunc(value)))
            throw Error(text.str());
        return;
    }
    throw Error(program.source.name + " exposes no variable '" + name + "'");
}

} // namespace

Interpreter::Interpreter(const Program& program, const Plan& plan, HostPhotons& photons, RunOutputs& outputs,
                         const RunSettings& settings, const Progress& progress)
    : m_program(program), m_plan(plan), m_photons(photons), m_outputs(outputs), m_settings(settings),
      m_progress(progress), m_is_reduced(program.variables.size()), m_choice_photons(program.variables.size()) {
    for (const Variable& variable : program.variables) {
        VariableState& state = m_state.variables.emplace_back();
        state.numbers.resize(std::max<std::size_t>(variable.array_size, 1), Number{.integer = 0});
    }
    for (std::size_t i = 0; i < std::size(PREDEFINED_VALUES); ++i) {
        m_state.variables[i].numbers[0] = make_number(program.variables[i].type, PREDEFINED_VALUES[i]);
        m_state.variables[i].is_set = true;
    }
    for (const auto& [name, value] : settings.values)
        check_value(program, name, value);
    for (const Function& function : program.functions) {
        std::set<std::uint32_t> locals;
        collect_locals(program, function.body, locals);
        m_function_locals.emplace_back(locals.begin(), locals.end());
    }
}

void Interpreter::run(const RunPass& run_pass) {
    m_run_pass = run_pass;
    m_fuel = m_settings.fuel;
    m_loop_start = std::chrono::steady_clock::now();
    try {
        execute(m_program.body);
    } catch (const OutOfFuel& out) {
        const Place place = m_program.source.find_place(out.at.begin);
        m_outputs.stopped = "line " + std::to_string(place.line) + ": this loop took more than " +
                            std::to_string(m_settings.fuel) + " turns; the script was stopped there";
    }
    if (m_outputs.columns.drop_behind_gap() && m_last_declared)
        fault(Fault::declaration, *m_last_declared);
}

// From here on the variable has the value it was given from outside, or what the script assigned.
void Interpreter::expose(std::uint32_t index) {
    const Variable& variable = m_program.variables[index];
    VariableState& state = m_state.variables[index];
    if (const auto given = m_settings.values.find(variable.name); given != m_settings.values.end()) {
        state.numbers[0] = make_number(variable.type, given->second);
        state.is_set = true;
    }
    m_exposed[index] = state.numbers[0];
}

Number Interpreter::exposed_value(std::uint32_t index) const {
    if (const auto met = m_exposed.find(index); met != m_exposed.end())
        return met->second;
    const Variable& variable = m_program.variables[index];
    const auto given = m_settings.values.find(variable.name);
    return make_number(variable.type,
                       given != m_settings.values.end() ? given->second : variable.default_value.value_or(0));
}

void Interpreter::spend_fuel(const Statement& statement) {
    if (m_fuel == 0)
        throw OutOfFuel{statement.span};
    --m_fuel;
}

void Interpreter::count_step() {
    if (++m_steps % STEPS_PER_LOOK != 0)
        return;
    m_progress.report("run script", m_fraction);
    if (m_iteration.loop && is_over_time())
        throw OutOfTime();
}

Interpreter::Flow Interpreter::execute(const std::vector<Statement>& statements) {
    for (const Statement& statement : statements)
        if (const Flow flow = execute(statement); flow != Flow::on)
            return flow;
    return Flow::on;
}

Interpreter::Flow Interpreter::execute(const Statement& statement) {
    using Kind = Statement::Kind;
    switch (statement.kind) {
    case Kind::expression:
        evaluate(*statement.value);
        return Flow::on;
    case Kind::declare: {
        VariableState& state = m_state.variables[statement.variable];
        const bool is_array = m_program.variables[statement.variable].array_size > 0;
        std::fill(state.numbers.begin(), state.numbers.end(), Number{.integer = 0});
        state.is_set = is_array;
        if (statement.value)
            evaluate(*statement.value);
        return Flow::on;
    }
    case Kind::branch:
        return execute(evaluate_truth(*statement.value) ? statement.body : statement.otherwise);
    case Kind::loop:
        return execute_loop(statement);
    case Kind::photon_loop:
        return execute_photon_loop(statement);
    case Kind::block:
        return execute(statement.body);
    case Kind::leave:
        return Flow::leave;
    case Kind::next:
        return Flow::next;
    case Kind::expose:
        expose(statement.variable);
        return Flow::on;
    case Kind::give:
        m_has_given = statement.value.has_value();
        if (statement.value)
            m_given = evaluate(*statement.value);
        m_has_given = statement.value.has_value(); // evaluating may have called a function
        return Flow::give;
    }
    return Flow::on;
}

Interpreter::Flow Interpreter::execute_loop(const Statement& statement) {
    for (const Expression& expression : statement.first)
        evaluate(expression);
    for (bool is_first = true;; is_first = false) {
        const bool tests = statement.value && !(statement.test_last && is_first);
        if (tests && !evaluate_truth(*statement.value))
            return Flow::on;
        if (!statement.is_bounded)
            spend_fuel(statement);
        count_step();
        const Flow flow = execute(statement.body);
        if (flow == Flow::leave)
            return Flow::on;
        if (flow == Flow::give)
            return flow;
        for (const Expression& expression : statement.last)
            evaluate(expression);
    }
}

} // namespace photonloupe::script
