// SPDX-License-Identifier: Apache-2.0
// The interpreter's expressions: 32-bit floats as IEEE has them, 32-bit integers that wrap, left to right.
#include <cmath>
#include <limits>

#include "script/check/apply_operator.h"
#include "script/interpret/interpreter.h"
#include "script/reference_math.h"

namespace photonloupe::script {

void Interpreter::fault(Fault kind, const Expression& site) {
    if (!m_is_replay)
        m_outputs.add_fault({kind, site.span}, m_iteration.photon);
}

float Interpreter::evaluate_real(const Expression& expression) {
    const Number value = evaluate(expression);
    return expression.type == Type::integer ? static_cast<float>(value.integer) : value.real;
}

bool Interpreter::evaluate_truth(const Expression& expression) {
    return is_true(expression.type, evaluate(expression));
}

std::int32_t Interpreter::convert_to_integer(float value, const Expression& site) {
    const IntegerResult result = script::convert_to_integer(value);
    if (!result.fits)
        fault(Fault::does_not_fit, site);
    return result.value;
}

std::size_t Interpreter::find_place(const Expression& index, std::size_t count, Fault outside) {
    const Number value = evaluate(index);
    if (index.type != Type::integer && std::trunc(value.real) != value.real) {
        fault(Fault::not_integral, index);
        return count;
    }
    const double place = index.type == Type::integer ? value.integer : value.real;
    if (place >= 0 && place < static_cast<double>(count))
        return static_cast<std::size_t>(place);
    fault(std::isfinite(place) ? outside : Fault::not_integral, index);
    return count;
}

const std::vector<std::int32_t>& Interpreter::evaluate_list(const Expression& expression) {
    if (expression.kind == Expression::Kind::variable) {
        const VariableState& variable = m_state.variables[expression.variable];
        if (variable.is_set)
            return variable.list;
        fault(Fault::unset_variable, expression);
        m_list.clear();
        return m_list;
    }
    m_list = find_neighbors(expression);
    return m_list;
}

Number Interpreter::evaluate(const Expression& expression) {
    using Kind = Expression::Kind;
    switch (expression.kind) {
    case Kind::number:
        return expression.type == Type::integer ? make_integer(expression.integer) : make_real(expression.real);
    case Kind::text:
        return make_integer(0);
    case Kind::variable: {
        const VariableState& variable = m_state.variables[expression.variable];
        if (variable.is_set)
            return variable.numbers[0];
        fault(Fault::unset_variable, expression);
        return make_nothing(expression.type);
    }
    case Kind::element: {
        const VariableState& variable = m_state.variables[expression.variable];
        const std::size_t place = find_place(expression.operands[0], variable.numbers.size(), Fault::array_index);
        return place < variable.numbers.size() ? variable.numbers[place] : make_nothing(expression.type);
    }
    case Kind::list_item: {
        const std::vector<std::int32_t>& list = evaluate_list(expression.operands[0]);
        const std::size_t place = find_place(expression.operands[1], list.size(), Fault::list_index);
        return place < list.size() ? make_integer(list[place]) : make_nothing(expression.type);
    }
    case Kind::list_length:
        return make_integer(static_cast<std::int32_t>(evaluate_list(expression.operands[0]).size()));
    case Kind::convert: {
        const Expression& operand = expression.operands[0];
        const Number value = evaluate(operand);
        if (operand.type == expression.type)
            return value;
        return expression.type == Type::real ? make_real(static_cast<float>(value.integer))
                                             : make_integer(convert_to_integer(value.real, expression));
    }
    case Kind::unary:
        return apply_unary(expression.operation, expression.operands[0].type, evaluate(expression.operands[0]));
    case Kind::binary:
        return evaluate_binary(expression);
    case Kind::conditional:
        return evaluate(expression.operands[evaluate_truth(expression.operands[0]) ? 1 : 2]);
    case Kind::builtin:
        return call_builtin(expression);
    case Kind::call:
        return call_function(expression);
    case Kind::assignment:
        return assign(expression);
    }
    return make_nothing(expression.type);
}

Number Interpreter::evaluate_binary(const Expression& expression) {
    const Expression& left = expression.operands[0];
    const Expression& right = expression.operands[1];
    if (expression.operation == Operator::logical_and)
        return make_integer(evaluate_truth(left) && evaluate_truth(right));
    if (expression.operation == Operator::logical_or)
        return make_integer(evaluate_truth(left) || evaluate_truth(right));
    const Number a = evaluate(left);
    const Number b = evaluate(right);
    return compute(expression.operation, left.type, a, b, expression);
}

// `type` is that of both operands.
Number Interpreter::compute(Operator operation, Type type, Number a, Number b, const Expression& site) {
    if (operation == Operator::modulo && (type == Type::integer ? b.integer == 0 : b.real == 0.0f))
        fault(Fault::modulo_by_zero, site);
    return apply_operator(operation, type, a, b);
}

Number Interpreter::assign(const Expression& expression) {
    const Variable& variable = m_program.variables[expression.variable];
    VariableState& state = m_state.variables[expression.variable];
    const bool is_element = variable.array_size > 0;
    const std::size_t count = std::max<std::size_t>(variable.array_size, 1);
    const std::size_t place = is_element ? find_place(expression.operands[1], count, Fault::array_index) : 0;
    const Expression& operand = expression.operands[0];
    if (variable.type == Type::list) {
        state.list = evaluate_list(operand);
        state.is_set = true;
        return make_integer(0);
    }
    Number value = evaluate(operand);
    if (operand.type == Type::integer && variable.type == Type::real)
        value = make_real(static_cast<float>(value.integer));
    if (place == count)
        return make_nothing(variable.type); // the write is dropped
    const bool is_compound = expression.operation != Operator::none;
    if (is_compound && !is_element && !state.is_set)
        fault(Fault::unset_variable, expression);
    const Number before = is_element || state.is_set ? state.numbers[place] : make_nothing(variable.type);
    if (is_compound)
        value = compute(expression.operation, variable.type, before, value, expression);
    if (m_is_reduced[expression.variable]) {
        std::vector<std::uint32_t>& photons = m_choice_photons[expression.variable];
        m_iteration.undo.push_back({expression.variable, place, before, photons.empty() ? NO_PHOTON : photons[place]});
        if (!photons.empty())
            photons[place] = m_iteration.photon;
    }
    state.numbers[place] = value;
    state.is_set = true;
    return expression.is_postfix ? before : value;
}

Number Interpreter::call_function(const Expression& expression) {
    const Function& function = m_program.functions[expression.function];
    std::vector<Number> arguments;
    arguments.reserve(expression.operands.size());
    for (std::size_t i = 0; i < expression.operands.size(); ++i) {
        const Expression& operand = expression.operands[i];
        Number value = evaluate(operand);
        if (operand.type == Type::integer && m_program.variables[function.parameters[i]].type == Type::real)
            value = make_real(static_cast<float>(value.integer));
        arguments.push_back(value);
    }
    for (const std::uint32_t local : m_function_locals[expression.function])
        m_state.variables[local].is_set = false;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        VariableState& parameter = m_state.variables[function.parameters[i]];
        parameter.numbers[0] = arguments[i];
        parameter.is_set = true;
    }
    m_has_given = false;
    const Flow flow = execute(function.body);
    if (flow == Flow::give && m_has_given)
        return m_given;
    if (flow == Flow::on && function.result != Type::none)
        fault(Fault::no_value, expression);
    return make_nothing(expression.type);
}

} // namespace photonloupe::script
