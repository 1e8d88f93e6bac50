// SPDX-License-Identifier: Apache-2.0
// Builds expressions: every name is found, every value is of the kind its place needs.
#include "script/check/builder_depth.h"
#include "script/check/predefined_names.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

constexpr std::uint32_t LEAST_INTEGER_BITS = 0x80000000u;

// 2147483648 without a minus is no 32-bit integer; 0x80000000 is one.
bool is_integer_literal(const Token& token) {
    return token.is_integer && !(token.integer == LEAST_INTEGER_BITS && token.value > 0);
}

} // namespace

void TreeBuilder::count_node(Span span) {
    if (++m_node_count <= MAX_TREE_NODES)
        return;
    m_diagnostics.add(codes::TOO_LARGE_INLINED, span, "the script is too large once its functions are inlined",
                      "each call is a copy of its function: call fewer, or loop over one call");
    throw TooLarge();
}

Expression TreeBuilder::make_expression(Kind kind, Span span) {
    count_node(span);
    Expression expression;
    expression.kind = kind;
    expression.type = Type::real; // until inferred
    expression.span = span;
    return expression;
}

Expression TreeBuilder::make_variable(std::uint32_t index, Span span) {
    Expression expression = make_expression(Kind::variable, span);
    expression.variable = index;
    if (variable(index).type == Type::list)
        expression.type = Type::list;
    return expression;
}

Expression TreeBuilder::make_assignment(std::uint32_t index, Span span, Expression value) {
    Expression assignment = make_expression(Kind::assignment, span);
    assignment.variable = index;
    assignment.operands.push_back(std::move(value));
    return assignment;
}

Expression TreeBuilder::build_value(const SyntaxExpression& syntax) {
    Expression value = build_any(syntax);
    if (is_unknown(value) || value.type == Type::integer || value.type == Type::real)
        return value;
    if (value.type == Type::text)
        m_diagnostics.add(codes::TEXT_MISUSE, syntax.span, "a number belongs here, not a label");
    else if (value.type == Type::list)
        m_diagnostics.add(codes::LIST_MISUSE, syntax.span, "a neighbor list is used as list[j] and length(list) only");
    else
        m_diagnostics.add(codes::NO_VALUE, syntax.span, "'" + syntax.name + "' returns no value");
    return make_unknown(syntax.span);
}

Expression TreeBuilder::build_any(const SyntaxExpression& syntax) {
    const Depth depth(*this, syntax.span);
    switch (syntax.kind) {
    case SyntaxExpression::Kind::number:
        return build_number(syntax);
    case SyntaxExpression::Kind::text: {
        Expression text = make_expression(Kind::text, syntax.span);
        text.type = Type::text;
        text.label = syntax.token.label;
        return text;
    }
    case SyntaxExpression::Kind::name:
        return build_name(syntax);
    case SyntaxExpression::Kind::index:
        return build_index(syntax);
    case SyntaxExpression::Kind::call:
        return build_call(syntax);
    case SyntaxExpression::Kind::unary:
        return build_unary(syntax);
    case SyntaxExpression::Kind::binary:
        return build_operands(Kind::binary, syntax);
    case SyntaxExpression::Kind::conditional:
        return build_operands(Kind::conditional, syntax);
    case SyntaxExpression::Kind::assignment:
        return build_assignment(syntax, false);
    }
    return make_unknown(syntax.span);
}

Expression TreeBuilder::build_operands(Kind kind, const SyntaxExpression& syntax) {
    Expression expression = make_expression(kind, syntax.span);
    expression.operation = syntax.operation;
    for (const SyntaxExpression& operand : syntax.operands)
        expression.operands.push_back(build_value(operand));
    return expression;
}

Expression TreeBuilder::build_number(const SyntaxExpression& syntax) {
    Expression number = make_expression(Kind::number, syntax.span);
    if (is_integer_literal(syntax.token)) {
        number.type = Type::integer;
        number.integer = std::int32_t(syntax.token.integer);
    } else {
        number.real = float(syntax.token.value);
    }
    return number;
}

Expression TreeBuilder::build_unary(const SyntaxExpression& syntax) {
    const SyntaxExpression& operand = syntax.operands[0];
    if (syntax.operation == Operator::none)
        return build_value(operand);
    if (syntax.operation == Operator::negate && operand.kind == SyntaxExpression::Kind::number &&
        operand.token.is_integer && !is_integer_literal(operand.token)) {
        Expression least = make_expression(Kind::number, syntax.span);
        least.type = Type::integer;
        least.integer = std::int32_t(LEAST_INTEGER_BITS);
        return least;
    }
    return build_operands(Kind::unary, syntax);
}

Expression TreeBuilder::build_name(const SyntaxExpression& syntax) {
    if (const auto constant = find_constant_name(syntax.name)) {
        Expression number = make_expression(Kind::number, syntax.span);
        number.type = constant->is_integer ? Type::integer : Type::real;
        number.integer = constant->is_integer ? std::int32_t(constant->value) : 0;
        number.real = constant->is_integer ? 0 : float(constant->value);
        return number;
    }
    const std::optional<std::uint32_t> found = resolve(syntax);
    if (!found)
        return make_unknown(syntax.span);
    if (variable(*found).array_size > 0) {
        m_diagnostics.add(codes::ARRAY_MISUSE, syntax.span, "'" + syntax.name + "' is an array and needs an index",
                          syntax.name + "[j]");
        return make_unknown(syntax.span);
    }
    return make_variable(*found, syntax.span);
}

Expression TreeBuilder::build_index(const SyntaxExpression& syntax) {
    const std::optional<std::uint32_t> found = find_constant_name(syntax.name) ? std::nullopt : resolve(syntax);
    Expression index = build_value(syntax.operands[0]);
    if (!found && !find_constant_name(syntax.name))
        return make_unknown(syntax.span);
    if (found && variable(*found).type == Type::list) {
        Expression item = make_expression(Kind::list_item, syntax.span);
        item.type = Type::integer;
        item.operands.push_back(make_variable(*found, syntax.name_span));
        item.operands.push_back(std::move(index));
        return item;
    }
    if (!found || variable(*found).array_size == 0) {
        m_diagnostics.add(codes::ARRAY_MISUSE, syntax.name_span, "'" + syntax.name + "' is no array",
                          "an array is declared with its size: 'float " + syntax.name + "[24];'");
        return make_unknown(syntax.span);
    }
    Expression element = make_expression(Kind::element, syntax.span);
    element.variable = *found;
    element.operands.push_back(std::move(index));
    return element;
}

Expression TreeBuilder::build_assignment(const SyntaxExpression& syntax, bool is_statement) {
    const SyntaxExpression& target = syntax.operands[0];
    const bool is_element = target.kind == SyntaxExpression::Kind::index;
    if (target.kind != SyntaxExpression::Kind::name && !is_element) {
        m_diagnostics.add(codes::NOT_ASSIGNABLE, target.span, "only a variable or an array's element can be assigned");
        build_any(target);
        build_any(syntax.operands[1]);
        return make_unknown(syntax.span);
    }
    const std::optional<std::uint32_t> found = resolve_target(target);
    if (found && variable(*found).type == Type::list)
        return build_list_assignment(syntax, *found, is_statement);
    Expression value = build_value(syntax.operands[1]);
    std::optional<Expression> index;
    if (is_element)
        index = build_value(target.operands[0]);
    if (!found)
        return make_unknown(syntax.span);
    if (is_element != (variable(*found).array_size > 0)) {
        m_diagnostics.add(codes::ARRAY_MISUSE, target.span,
                          "'" + target.name + (is_element ? "' is no array" : "' is an array and needs an index"));
        return make_unknown(syntax.span);
    }
    Expression assignment = make_assignment(*found, syntax.span, std::move(value));
    assignment.operation = syntax.operation;
    assignment.is_postfix = syntax.is_postfix;
    if (index)
        assignment.operands.push_back(std::move(*index));
    return assignment;
}

// nn = getKNN(…); and nothing else.
Expression TreeBuilder::build_list_assignment(const SyntaxExpression& syntax, std::uint32_t index, bool is_statement) {
    const SyntaxExpression& target = syntax.operands[0];
    Expression value = build_any(syntax.operands[1]);
    const bool is_plain = target.kind == SyntaxExpression::Kind::name && syntax.operation == Operator::none;
    if (!is_plain || value.kind != Kind::builtin || value.type != Type::list || !is_statement) {
        if (!is_unknown(value))
            m_diagnostics.add(codes::LIST_MISUSE, syntax.span,
                              "'" + target.name +
                                  "' is a neighbor list: only a query's result is assigned to it, in a "
                                  "statement of its own");
        return make_unknown(syntax.span);
    }
    Expression assignment = make_assignment(index, syntax.span, std::move(value));
    assignment.type = Type::list;
    return assignment;
}

} // namespace photonloupe::script
