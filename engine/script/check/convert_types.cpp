// SPDX-License-Identifier: Apache-2.0
// Types from the leaves up, conversions where integers meet reals.
#include "script/check/check_stages.h"

#include "script/builtins.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

bool is_rounding(BuiltinId id) {
    return id == BuiltinId::int_ || id == BuiltinId::floor || id == BuiltinId::ceil || id == BuiltinId::round;
}

void make_real(Expression& expression) {
    if (expression.type != Type::integer)
        return;
    if (expression.kind == Kind::number) {
        expression.type = Type::real;
        expression.real = float(expression.integer);
        expression.integer = 0;
        return;
    }
    Expression converted;
    converted.kind = Kind::convert;
    converted.type = Type::real;
    converted.span = expression.span;
    converted.operands.push_back(std::move(expression));
    expression = std::move(converted);
}

class TypeConverter {
public:
    TypeConverter(Draft& draft, Diagnostics& diagnostics) : m_program(draft.program), m_diagnostics(diagnostics) {}

    void convert(Draft& draft) {
        for (PendingSize& pending : draft.sizes)
            convert(pending.size);
        convert(m_program.body, nullptr);
        for (Function& function : m_program.functions)
            convert(function.body, &function);
    }

private:
    void convert(std::vector<Statement>& statements, const Function* function) {
        for (Statement& statement : statements) {
            for (Expression& expression : statement.first)
                convert(expression);
            if (statement.value)
                convert(*statement.value);
            if (statement.kind == Statement::Kind::give && statement.value && function)
                give(*statement.value, function->result, "the integer that '" + function->name + "' returns");
            for (Expression& expression : statement.last)
                convert(expression);
            convert(statement.body, function);
            convert(statement.otherwise, function);
        }
    }

    void convert(Expression& expression) {
        for (Expression& operand : expression.operands)
            convert(operand);
        switch (expression.kind) {
        case Kind::variable:
        case Kind::element:
            expression.type = m_program.variables[expression.variable].type;
            return;
        case Kind::unary:
            expression.type = expression.operation == Operator::logical_not || is_unknown(expression.operands[0])
                                  ? Type::integer
                                  : expression.operands[0].type;
            return;
        case Kind::binary:
            return convert_binary(expression);
        case Kind::conditional:
            expression.type = unify(expression.operands[1], expression.operands[2]);
            return;
        case Kind::builtin:
            return convert_builtin(expression);
        case Kind::call:
            return convert_call(expression);
        case Kind::assignment:
            expression.type = m_program.variables[expression.variable].type;
            if (expression.type != Type::list)
                give_variable(expression);
            return;
        default:
            return;
        }
    }

    // One type for both: real if either is. (What is unknown goes with anything.)
    static Type unify(Expression& a, Expression& b) {
        if (a.type != Type::real && b.type != Type::real)
            return Type::integer;
        make_real(a);
        make_real(b);
        return Type::real;
    }

    static void convert_binary(Expression& expression) {
        Expression& left = expression.operands[0];
        Expression& right = expression.operands[1];
        switch (expression.operation) {
        case Operator::logical_and:
        case Operator::logical_or:
            expression.type = Type::integer;
            return;
        case Operator::divide:
            make_real(left);
            make_real(right);
            expression.type = Type::real;
            return;
        case Operator::add:
        case Operator::subtract:
        case Operator::multiply:
        case Operator::modulo:
            expression.type = unify(left, right);
            return;
        default:
            unify(left, right);
            expression.type = Type::integer;
        }
    }

    static void convert_builtin(Expression& call) {
        const Builtin& builtin = *call.builtin;
        bool is_integer = true;
        for (const Expression& argument : call.operands)
            is_integer &= argument.type != Type::real;
        if (is_rounding(builtin.id)) {
            call.type = Type::integer;
            if (is_integer) {
                Expression value = std::move(call.operands[0]);
                value.span = call.span;
                call = std::move(value);
            }
            return;
        }
        if (builtin.id == BuiltinId::pow) {
            call.type = is_integer_power(call, call.operands[0].type != Type::real) ? Type::integer : Type::real;
        } else if (builtin.result == Result::as_arguments) {
            call.type = is_integer ? Type::integer : Type::real;
        } else if (builtin.result == Result::integer || builtin.result == Result::real) {
            call.type = builtin.result == Result::integer ? Type::integer : Type::real;
        }
        const bool keeps_integers = builtin.id == BuiltinId::print || call.type == Type::integer;
        for (std::size_t i = 0; i < call.operands.size(); ++i) {
            const Argument argument = i < builtin.arguments.size() ? builtin.arguments[i] : Argument::number;
            if ((argument == Argument::number && !keeps_integers) || argument == Argument::uniform_number)
                make_real(call.operands[i]);
        }
    }

    void convert_call(Expression& call) {
        const Function& function = m_program.functions[call.function];
        call.type = function.result;
        for (std::size_t i = 0; i < call.operands.size(); ++i) {
            const Variable& parameter = m_program.variables[function.parameters[i]];
            give(call.operands[i], parameter.type, "the integer parameter '" + parameter.name + "'");
        }
    }

    void give_variable(Expression& assignment) {
        const Variable& variable = m_program.variables[assignment.variable];
        Expression& value = assignment.operands[0];
        const bool is_quotient = assignment.operation == Operator::divide;
        if (is_quotient && variable.type == Type::integer)
            refuse_real(assignment.span, "the integer variable '" + variable.name + "'");
        else
            give(value, variable.type, "the integer variable '" + variable.name + "'");
    }

    void give(Expression& value, Type type, const std::string& receiver) {
        if (type == Type::real)
            make_real(value);
        else if (type == Type::integer && value.type == Type::real)
            refuse_real(value.span, receiver);
    }

    void refuse_real(Span span, const std::string& receiver) {
        m_diagnostics.add(codes::REAL_TO_INTEGER, span, "a real number is given to " + receiver,
                          "write int(…), or floor, ceil or round");
    }

    Program& m_program;
    Diagnostics& m_diagnostics;
};

} // namespace

void convert_types(Draft& draft, Diagnostics& diagnostics) {
    TypeConverter(draft, diagnostics).convert(draft);
}

} // namespace photonloupe::script
