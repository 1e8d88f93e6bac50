// SPDX-License-Identifier: Apache-2.0
// The rules of expressions, from assignment (binds least) to names and numbers (bind most).
#include <algorithm>
#include <span>

#include "script/read/diagnostic_codes.h"
#include "script/read/parser.h"

namespace photonloupe::script {
namespace {

using Kind = SyntaxExpression::Kind;

struct OperatorSymbol {
    std::string_view spelling;
    Operator operation;
    int binding = 0;
};
constexpr OperatorSymbol BINARY[] = {
    {"||", Operator::logical_or, 1}, {"&&", Operator::logical_and, 2},   {"==", Operator::equal, 3},
    {"!=", Operator::not_equal, 3},  {"<", Operator::less, 4},           {"<=", Operator::less_equal, 4},
    {">", Operator::greater, 4},     {">=", Operator::greater_equal, 4}, {"+", Operator::add, 5},
    {"-", Operator::subtract, 5},    {"*", Operator::multiply, 6},       {"/", Operator::divide, 6},
    {"%", Operator::modulo, 6},
};

constexpr OperatorSymbol ASSIGNMENT[] = {
    {"=", Operator::none},      {"+=", Operator::add},    {"-=", Operator::subtract},
    {"*=", Operator::multiply}, {"/=", Operator::divide}, {"%=", Operator::modulo},
};

// The table's row for a token, or null.
const OperatorSymbol* find_operator(std::span<const OperatorSymbol> table, const Token& token) {
    const auto found = std::find_if(table.begin(), table.end(), [&](const OperatorSymbol& row) {
        return token.kind == TokenKind::symbol && row.spelling == token.spelling;
    });
    return found == table.end() ? nullptr : &*found;
}

std::vector<SyntaxExpression> gather(SyntaxExpression first, SyntaxExpression second) {
    std::vector<SyntaxExpression> operands;
    operands.push_back(std::move(first));
    operands.push_back(std::move(second));
    return operands;
}

} // namespace

SyntaxExpression Parser::join(Kind kind, Span span, std::vector<SyntaxExpression> operands) {
    SyntaxExpression expression;
    expression.kind = kind;
    expression.span = span;
    for (const SyntaxExpression& operand : operands)
        expression.depth = std::max(expression.depth, operand.depth + 1);
    expression.operands = std::move(operands);
    if (expression.depth > MAX_CHAIN)
        give_up(span, "this expression has too many parts", "split it into several statements");
    return expression;
}

SyntaxExpression Parser::parse_expression() {
    std::vector<SyntaxExpression> targets;
    std::vector<Operator> operations;
    SyntaxExpression value = parse_conditional();
    while (const OperatorSymbol* const found = find_operator(ASSIGNMENT, peek())) {
        take();
        targets.push_back(std::move(value));
        operations.push_back(found->operation);
        value = parse_conditional();
    }
    for (; !targets.empty(); targets.pop_back(), operations.pop_back()) { // a = b = c is a = (b = c)
        const Span span{targets.back().span.begin, value.span.end};
        value = join(Kind::assignment, span, gather(std::move(targets.back()), std::move(value)));
        value.operation = operations.back();
    }
    return value;
}

SyntaxExpression Parser::parse_conditional() {
    SyntaxExpression condition = parse_binary(0);
    if (!take_if("?"))
        return condition;
    const Nesting nesting(*this);
    std::vector<SyntaxExpression> operands;
    operands.push_back(std::move(condition));
    operands.push_back(parse_expression());
    expect(":", " between the two values of '?'");
    operands.push_back(parse_expression());
    const Span span{operands.front().span.begin, operands.back().span.end};
    return join(Kind::conditional, span, std::move(operands));
}

// Operators that bind tighter than `least_binding`; equal ones group from the left.
SyntaxExpression Parser::parse_binary(int least_binding) {
    SyntaxExpression left = parse_unary();
    for (;;) {
        if (peek().kind == TokenKind::unsupported) {
            refuse_operator();
            take();
            parse_unary(); // and go on as if it and its operand were not there
            continue;
        }
        const OperatorSymbol* const found = find_operator(BINARY, peek());
        if (!found || found->binding <= least_binding)
            return left;
        take();
        SyntaxExpression right = parse_binary(found->binding);
        const Span span{left.span.begin, right.span.end};
        left = join(Kind::binary, span, gather(std::move(left), std::move(right)));
        left.operation = found->operation;
    }
}

SyntaxExpression Parser::parse_unary() {
    const Token sign = peek();
    if (sign.kind == TokenKind::unsupported) {
        refuse_operator();
        take();
        const Nesting nesting(*this);
        return parse_unary();
    }
    const bool is_step = sign.is("++") || sign.is("--");
    if (!is_step && !sign.is("-") && !sign.is("+") && !sign.is("!"))
        return parse_postfix();
    take();
    const Nesting nesting(*this);
    SyntaxExpression operand = parse_unary();
    if (is_step)
        return make_step(std::move(operand), sign, false);
    const Span span{sign.span.begin, operand.span.end};
    std::vector<SyntaxExpression> operands;
    operands.push_back(std::move(operand));
    SyntaxExpression expression = join(Kind::unary, span, std::move(operands));
    expression.operation = sign.is("-") ? Operator::negate : sign.is("!") ? Operator::logical_not : Operator::none;
    return expression;
}

SyntaxExpression Parser::make_step(SyntaxExpression target, const Token& sign, bool is_postfix) {
    SyntaxExpression one;
    one.span = sign.span;
    one.token.kind = TokenKind::number;
    one.token.span = sign.span;
    one.token.is_integer = true;
    one.token.integer = 1;
    one.token.value = 1;
    const Span span{std::min(target.span.begin, sign.span.begin), std::max(target.span.end, sign.span.end)};
    SyntaxExpression step = join(Kind::assignment, span, gather(std::move(target), std::move(one)));
    step.operation = sign.is("++") ? Operator::add : Operator::subtract;
    step.is_step = true;
    step.is_postfix = is_postfix;
    return step;
}

SyntaxExpression Parser::parse_postfix() {
    SyntaxExpression expression = parse_primary();
    while (peek().is("++") || peek().is("--")) {
        const Token sign = take();
        expression = make_step(std::move(expression), sign, true);
    }
    if (peek().is("["))
        fail(peek().span, "only a variable can be followed by '['", "store the value in a variable first");
    return expression;
}

SyntaxExpression Parser::parse_primary() {
    const Token& token = peek();
    if (token.kind == TokenKind::number || token.kind == TokenKind::text) {
        SyntaxExpression expression;
        expression.kind = token.kind == TokenKind::number ? Kind::number : Kind::text;
        expression.span = token.span;
        expression.token = take();
        return expression;
    }
    if (token.is("(")) {
        const Nesting nesting(*this);
        const Span open = take().span;
        SyntaxExpression expression = parse_expression();
        if (peek().is(","))
            fail(peek().span, "scripts have no comma operator");
        expression.span = {open.begin, expect(")", "").end};
        return expression;
    }
    if (token.kind == TokenKind::identifier || (token.is("int") && peek(1).is("(")))
        return parse_name();
    if (token.is("float") && peek(1).is("("))
        fail(token.span, "there is no float()", "'/' is real division, so that x / 1 is a real number");
    fail_expecting("a value", "");
}

SyntaxExpression Parser::parse_name() {
    const Token name = take();
    if (peek().is("("))
        return parse_call(name);
    SyntaxExpression expression;
    if (peek().is("[")) {
        const Nesting nesting(*this);
        take();
        std::vector<SyntaxExpression> operands;
        operands.push_back(parse_expression());
        const Span close = expect("]", " after the index");
        expression = join(Kind::index, {name.span.begin, close.end}, std::move(operands));
    } else {
        expression.kind = Kind::name;
        expression.span = name.span;
    }
    expression.name = name.spelling;
    expression.name_span = name.span;
    return expression;
}

SyntaxExpression Parser::parse_call(const Token& name) {
    const Nesting nesting(*this);
    take();
    std::vector<SyntaxExpression> arguments;
    if (!peek().is(")")) {
        do {
            arguments.push_back(parse_expression());
        } while (take_if(","));
    }
    const Span close = expect(")", " after the arguments of '" + std::string(name.spelling) + "'");
    SyntaxExpression call = join(Kind::call, {name.span.begin, close.end}, std::move(arguments));
    call.name = name.spelling;
    call.name_span = name.span;
    return call;
}

void Parser::refuse_operator() {
    const Token& token = peek();
    m_script.is_complete = false;
    if (m_has_given_up || token.is_reported)
        return;
    const std::string spelling(token.spelling);
    std::string note;
    if (spelling == "^")
        note = "a power is written pow(x, y)";
    else if (spelling == "&" || spelling == "|")
        note = "did you mean '" + spelling + spelling + "'?";
    else if (spelling == "<<" || spelling == ">>")
        note = "multiply by a power of two, or use int(x / 2)";
    m_diagnostics.add(codes::UNSUPPORTED_OPERATOR, token.span, "scripts have no operator '" + spelling + "'",
                      std::move(note));
}

} // namespace photonloupe::script
