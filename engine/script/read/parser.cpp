// SPDX-License-Identifier: Apache-2.0
// The parser's footing: taking tokens, complaining, finding the next statement after an error.
#include "script/read/parser.h"

#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

constexpr std::size_t MAX_SOURCE_BYTES = 64 * 1024;

std::string describe_token(const Token& token) {
    switch (token.kind) {
    case TokenKind::end:
        return "the end of the script";
    case TokenKind::text:
        return "a label";
    default:
        return "'" + std::string(token.spelling) + "'";
    }
}

} // namespace

Parser::Nesting::Nesting(Parser& parser) : m_parser(parser) {
    if (parser.m_nesting >= MAX_NESTING)
        parser.give_up(parser.peek().span, "nested more than 64 levels deep", "split it up");
    ++parser.m_nesting;
}

const Token& Parser::peek(std::size_t ahead) const {
    return m_tokens[std::min(m_at + ahead, m_tokens.size() - 1)];
}

const Token& Parser::take() {
    const Token& token = peek();
    if (token.kind != TokenKind::end)
        ++m_at;
    return token;
}

bool Parser::take_if(std::string_view word) {
    const bool is_there = peek().is(word);
    if (is_there)
        take();
    return is_there;
}

Span Parser::expect(std::string_view word, std::string_view where) {
    if (!peek().is(word))
        fail_expecting("'" + std::string(word) + "'", where);
    return take().span;
}

Token Parser::expect_name(std::string_view what) {
    if (peek().kind == TokenKind::keyword)
        m_diagnostics.add(codes::NAME_TAKEN, peek().span,
                          "'" + std::string(peek().spelling) + "' is a word of the language", "choose another name");
    else if (peek().kind != TokenKind::identifier)
        fail_expecting(what, "");
    return take();
}

void Parser::fail(Span span, std::string message, std::string note) {
    m_script.is_complete = false;
    if (!m_has_given_up)
        m_diagnostics.add(codes::SYNTAX, span, std::move(message), std::move(note));
    throw Failure();
}

void Parser::fail_expecting(std::string_view what, std::string_view where) {
    fail(peek().span, "expected " + std::string(what) + std::string(where) + ", found " + describe_token(peek()));
}

// Deeper recursion would only repeat the complaint: what follows is taken for the end of the script.
void Parser::give_up(Span span, std::string message, std::string note) {
    if (!m_has_given_up)
        m_diagnostics.add(codes::TOO_DEEP, span, std::move(message), std::move(note));
    m_has_given_up = true;
    m_script.is_complete = false;
    m_at = m_tokens.size() - 1;
    throw Failure();
}

// A missing ';' is reported just behind the statement; if a new line or a '}' follows, nothing needs to be skipped.
void Parser::end_statement(std::string_view after) {
    if (take_if(";"))
        return;
    const Span last = m_tokens[m_at > 0 ? m_at - 1 : 0].span;
    const Token& next = peek();
    if (m_has_given_up)
        throw Failure();
    if (next.kind == TokenKind::unsupported) {
        refuse_operator();
        throw Failure();
    }
    m_script.is_complete = false;
    std::string message = "expected ';' after " + std::string(after);
    if (next.kind == TokenKind::end || next.is("}") || is_on_new_line(next)) {
        m_diagnostics.add(codes::SYNTAX, {last.end, last.end}, std::move(message));
        return;
    }
    fail(next.span, message + ", found " + describe_token(next));
}

bool Parser::is_on_new_line(const Token& token) const {
    const Token& previous = m_tokens[m_at > 0 ? m_at - 1 : 0];
    const char* const begin = previous.spelling.data() + previous.spelling.size();
    const std::string_view between(begin, token.span.begin - previous.span.end);
    return between.find_first_of("\r\n") != std::string_view::npos;
}

// To behind the next ';' on this level, or to the next '}' or statement keyword.
void Parser::skip_statement() {
    for (int depth = 0; peek().kind != TokenKind::end; take()) {
        const Token& token = peek();
        if (depth == 0 && (token.is("}") || token.is("if") || token.is("for") || token.is("while") || token.is("do") ||
                           token.is("expose") || token.is("function")))
            return;
        if (token.is("{") || token.is("("))
            ++depth;
        else if (token.is("}") || token.is(")"))
            depth = depth > 0 ? depth - 1 : 0;
        else if (!token.is(";"))
            continue;
        if (depth == 0 && (token.is("}") || token.is(";"))) {
            take();
            return;
        }
    }
}

// Behind the ')' that closes the head of a loop or branch, so that its body can still be read.
void Parser::skip_to_parenthesis() {
    for (int depth = 1; peek().kind != TokenKind::end && !peek().is("{") && !peek().is("}");) {
        if (peek().is("("))
            ++depth;
        const bool is_closing = peek().is(")");
        take();
        if (is_closing && --depth == 0)
            return;
    }
}

SyntaxScript Parser::parse() {
    parse_statements(m_script.body, true);
    return std::move(m_script);
}

SyntaxScript parse_script(const Source& source, Diagnostics& diagnostics) {
    if (source.text.size() > MAX_SOURCE_BYTES) {
        diagnostics.add(codes::TOO_LONG, {0, 0},
                        "the script has " + std::to_string(source.text.size()) + " bytes, at most 65,536 are accepted");
        SyntaxScript nothing;
        nothing.is_complete = false;
        return nothing;
    }
    return Parser(split_tokens(source, diagnostics), diagnostics).parse();
}

} // namespace photonloupe::script
