// SPDX-License-Identifier: Apache-2.0
// The rules of statements; after an error the next statement is read as if nothing had happened.
#include "script/read/diagnostic_codes.h"
#include "script/read/parser.h"

namespace photonloupe::script {
namespace {

using Kind = SyntaxStatement::Kind;

// Types of C and words of its relatives that people write before a name.
std::string advise_on_type(std::string_view word) {
    for (const std::string_view type : {"double", "bool", "void", "const", "var", "let", "auto", "unsigned", "long"})
        if (word == type)
            return "a variable is declared by its first assignment, or by 'float x;' or 'int x;'; a function by "
                   "'function'";
    return {};
}

} // namespace

void Parser::parse_statements(std::vector<SyntaxStatement>& list, bool is_top_level) {
    while (peek().kind != TokenKind::end) {
        if (peek().is("}")) {
            if (!is_top_level)
                return;
            m_diagnostics.add(codes::SYNTAX, peek().span, "this '}' closes nothing");
            m_script.is_complete = false;
            take();
            continue;
        }
        const std::size_t begin = m_at;
        try {
            if (is_function_ahead()) {
                if (!is_top_level)
                    m_diagnostics.add(codes::SYNTAX, peek().span, "a function can't be defined inside a block",
                                      "move it to the top level");
                m_script.functions.push_back(parse_function());
            } else {
                list.push_back(parse_statement());
            }
        } catch (const Failure&) {
            if (m_at == begin)
                take();
            skip_statement();
        }
    }
}

SyntaxStatement Parser::parse_statement() {
    for (const std::string_view word : {"{", "if", "for", "while", "do"})
        if (peek().is(word)) {
            const Nesting nesting(*this);
            return parse_compound();
        }
    return parse_simple();
}

SyntaxStatement Parser::parse_compound() {
    if (peek().is("if"))
        return parse_branch();
    if (peek().is("for"))
        return parse_for();
    if (peek().is("while"))
        return parse_while();
    if (peek().is("do"))
        return parse_do();
    SyntaxStatement block;
    block.kind = Kind::block;
    block.span = peek().span;
    block.body = parse_block();
    return block;
}

SyntaxStatement Parser::parse_simple() {
    if (peek().is("float") || (peek().is("int") && !peek(1).is("(")))
        return parse_declaration();
    if (peek().is("expose"))
        return parse_expose();
    SyntaxStatement statement;
    statement.span = peek().span;
    if (take_if(";"))
        return statement;
    if (peek().is("else"))
        fail(peek().span, "'else' without an 'if' before it");
    if (take_if("break")) {
        statement.kind = Kind::leave;
        end_statement("'break'");
    } else if (take_if("continue")) {
        statement.kind = Kind::next;
        end_statement("'continue'");
    } else if (take_if("return")) {
        statement.kind = Kind::give;
        if (!peek().is(";") && !peek().is("}"))
            statement.value = parse_expression();
        end_statement("'return'");
    } else {
        statement.kind = Kind::expression;
        const Token begin = peek();
        statement.value = parse_expression();
        statement.span = statement.value->span;
        if (peek().kind == TokenKind::identifier && !advise_on_type(begin.spelling).empty())
            fail(begin.span, "there is no type '" + std::string(begin.spelling) + "'", advise_on_type(begin.spelling));
        end_statement("this statement");
    }
    return statement;
}

// The statements of a loop or branch; braces of its own do not count as a level.
std::vector<SyntaxStatement> Parser::parse_body() {
    if (peek().is("{"))
        return parse_block();
    std::vector<SyntaxStatement> body;
    body.push_back(parse_statement());
    return body;
}

std::vector<SyntaxStatement> Parser::parse_block() {
    const Token open = take();
    std::vector<SyntaxStatement> body;
    parse_statements(body, false);
    if (!take_if("}") && !m_has_given_up) {
        m_script.is_complete = false;
        m_diagnostics.add(codes::SYNTAX, open.span, "this '{' is never closed");
    }
    return body;
}

// The condition in the parentheses of a branch or loop; after an error in it the body is still read.
SyntaxExpression Parser::parse_condition(std::string_view of) {
    const std::string where = " after '" + std::string(of) + "'";
    expect("(", where);
    try {
        SyntaxExpression condition = parse_expression();
        expect(")", " after the condition");
        return condition;
    } catch (const Failure&) {
        skip_to_parenthesis();
        SyntaxExpression unknown;
        unknown.token.is_integer = true;
        return unknown;
    }
}

// Arms are gathered in a loop and nested afterwards: a long chain is no recursion.
SyntaxStatement Parser::parse_branch() {
    std::vector<SyntaxStatement> arms;
    std::vector<SyntaxStatement> otherwise;
    do {
        SyntaxStatement arm;
        arm.kind = Kind::branch;
        arm.span = take().span;
        arm.value = parse_condition("if");
        arm.body = parse_body();
        arms.push_back(std::move(arm));
        if (arms.size() > MAX_CHAIN)
            give_up(arms.back().span, "this chain of 'else if' is too long", "split it up");
        if (!take_if("else"))
            break;
        if (!peek().is("if")) {
            otherwise = parse_body();
            break;
        }
    } while (true);
    for (;;) {
        SyntaxStatement branch = std::move(arms.back());
        arms.pop_back();
        branch.otherwise = std::move(otherwise);
        if (arms.empty())
            return branch;
        otherwise.clear();
        otherwise.push_back(std::move(branch));
    }
}

SyntaxStatement Parser::parse_while() {
    SyntaxStatement loop;
    loop.kind = Kind::while_loop;
    const Span begin = take().span;
    loop.value = parse_condition("while");
    loop.span = {begin.begin, m_tokens[m_at - 1].span.end};
    loop.body = parse_body();
    return loop;
}

SyntaxStatement Parser::parse_do() {
    SyntaxStatement loop;
    loop.kind = Kind::do_loop;
    loop.span = take().span;
    loop.body = parse_body();
    if (!take_if("while"))
        fail_expecting("'while'", " after the body of 'do'");
    loop.value = parse_condition("while");
    end_statement("'do … while'");
    return loop;
}

SyntaxStatement Parser::parse_for() {
    SyntaxStatement loop;
    loop.kind = Kind::for_loop;
    const Span begin = take().span;
    expect("(", " after 'for'");
    try {
        parse_for_head(loop);
    } catch (const Failure&) {
        skip_to_parenthesis();
    }
    loop.span = {begin.begin, m_tokens[m_at - 1].span.end};
    loop.body = parse_body();
    return loop;
}

void Parser::parse_for_head(SyntaxStatement& loop) {
    if (peek().is("float") || peek().is("int"))
        loop.declarators = parse_declarators();
    else
        loop.first = parse_list(";");
    expect(";", " after the start of the loop");
    if (!peek().is(";"))
        loop.value = parse_expression();
    expect(";", " after the condition of the loop");
    loop.last = parse_list(")");
    expect(")", " after the head of the loop");
}

std::vector<SyntaxExpression> Parser::parse_list(std::string_view end) {
    std::vector<SyntaxExpression> list;
    if (peek().is(end))
        return list;
    do {
        list.push_back(parse_expression());
    } while (take_if(","));
    return list;
}

} // namespace photonloupe::script
