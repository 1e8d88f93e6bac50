// SPDX-License-Identifier: Apache-2.0
// The rules of what gives names a meaning: declarations, exposed variables, functions.
#include "script/read/parser.h"

namespace photonloupe::script {

SyntaxStatement Parser::parse_declaration() {
    SyntaxStatement statement;
    statement.kind = SyntaxStatement::Kind::declare;
    const Span begin = peek().span;
    statement.declarators = parse_declarators();
    statement.span = {begin.begin, m_tokens[m_at - 1].span.end};
    end_statement("this declaration");
    return statement;
}

// float a, b = 2, c[24]
std::vector<Declarator> Parser::parse_declarators() {
    const WrittenType type = take().is("int") ? WrittenType::integer : WrittenType::real;
    std::vector<Declarator> list;
    do {
        const Token name = expect_name("a name");
        Declarator declarator;
        declarator.name = name.spelling;
        declarator.span = name.span;
        declarator.type = type;
        if (peek().is("[")) {
            const Nesting nesting(*this);
            take();
            if (peek().is("]"))
                fail(peek().span, "an array's size must be given", "as in 'float c[24];'");
            declarator.size = parse_expression();
            expect("]", " after the array's size");
            if (peek().is("["))
                fail(peek().span, "arrays have one dimension", "use c[row * columns + column]");
            if (peek().is("="))
                fail(peek().span, "an array can't be given values where it is declared",
                     "it starts as zeros; assign its elements");
        }
        if (take_if("="))
            declarator.value = parse_expression();
        list.push_back(std::move(declarator));
    } while (take_if(","));
    return list;
}

// expose NAME range LO, HI [step S] [;]
SyntaxStatement Parser::parse_expose() {
    SyntaxStatement statement;
    statement.kind = SyntaxStatement::Kind::expose;
    const Span begin = take().span;
    const Token name = expect_name("the variable to expose");
    statement.name = name.spelling;
    statement.name_span = name.span;
    if (peek().spelling != "range")
        fail_expecting("'range'", " after the exposed variable");
    take();
    statement.low = parse_signed_number();
    expect(",", " between the ends of the range");
    statement.high = parse_signed_number();
    // `step` may as well begin the next statement: it is a name like any other.
    const bool is_signed = peek(1).is("-") || peek(1).is("+");
    if (peek().spelling == "step" && peek(is_signed ? 2 : 1).kind == TokenKind::number) {
        take();
        statement.step = parse_signed_number();
    }
    statement.span = {begin.begin, m_tokens[m_at - 1].span.end};
    if (!take_if(";") && peek().kind != TokenKind::end && !peek().is("}") && !is_on_new_line(peek()))
        fail_expecting("';' or a new line", " after 'expose'");
    return statement;
}

SignedNumber Parser::parse_signed_number() {
    const Token sign = peek();
    const bool is_signed = take_if("-") || take_if("+");
    if (peek().kind != TokenKind::number)
        fail(peek().span, "expected a number", "a range is written in numbers, as in 'range 0, 2.5'");
    const Token number = take();
    SignedNumber result;
    result.value = sign.is("-") ? -number.value : number.value;
    result.is_integer = number.is_integer && result.value < 2147483648.0;
    result.span = {is_signed ? sign.span.begin : number.span.begin, number.span.end};
    return result;
}

// function f(, float f(, int f(; int(x) is a call.
bool Parser::is_function_ahead() const {
    if (peek().is("function"))
        return true;
    return (peek().is("float") || peek().is("int")) && peek(1).kind == TokenKind::identifier && peek(2).is("(");
}

SyntaxFunction Parser::parse_function() {
    const Token kind = take();
    const Token name = expect_name("the function's name");
    SyntaxFunction function;
    function.name = name.spelling;
    function.span = name.span;
    function.result = kind.is("int") ? WrittenType::integer : kind.is("float") ? WrittenType::real : WrittenType::none;
    expect("(", " after the function's name");
    if (!peek().is(")")) {
        do {
            function.parameters.push_back(parse_parameter());
        } while (take_if(","));
    }
    expect(")", " after the function's parameters");
    if (!peek().is("{"))
        fail_expecting("'{'", " before the function's body");
    const Nesting nesting(*this);
    function.body = parse_block();
    return function;
}

Declarator Parser::parse_parameter() {
    Declarator parameter;
    if (peek().is("float") || peek().is("int"))
        parameter.type = take().is("int") ? WrittenType::integer : WrittenType::real;
    const Token name = expect_name("a parameter's name");
    parameter.name = name.spelling;
    parameter.span = name.span;
    if (peek().is("["))
        fail(peek().span, "an array can't be a parameter", "a function may read the script's arrays by name");
    return parameter;
}

} // namespace photonloupe::script
