// SPDX-License-Identifier: Apache-2.0
// The parser's state and its rules: recursive descent, one method a rule (parse_expressions.cpp, parse_statements.cpp).
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "script/read/syntax.h"

namespace photonloupe::script {

class Parser {
public:
    Parser(std::vector<Token> tokens, Diagnostics& diagnostics)
        : m_tokens(std::move(tokens)), m_diagnostics(diagnostics) {}
    SyntaxScript parse();

private:
    // A statement can't be read any further; thrown by `fail`, caught where the next statement is sought.
    struct Failure {};

    // One level deeper while it lives; past MAX_NESTING the rest of the script is given up.
    class Nesting {
    public:
        explicit Nesting(Parser& parser);
        ~Nesting() { --m_parser.m_nesting; }
        Nesting(const Nesting&) = delete;
        Nesting& operator=(const Nesting&) = delete;

    private:
        Parser& m_parser;
    };

    // parser.cpp: tokens
    const Token& peek(std::size_t ahead = 0) const;
    const Token& take();
    bool take_if(std::string_view word);
    Span expect(std::string_view word, std::string_view where);
    Token expect_name(std::string_view what);
    [[noreturn]] void fail(Span span, std::string message, std::string note = {});
    [[noreturn]] void fail_expecting(std::string_view what, std::string_view where);
    [[noreturn]] void give_up(Span span, std::string message, std::string note);
    void end_statement(std::string_view after);
    bool is_on_new_line(const Token& token) const;
    void skip_statement();
    void skip_to_parenthesis();

    // parse_expressions.cpp
    SyntaxExpression parse_expression();
    SyntaxExpression parse_conditional();
    SyntaxExpression parse_binary(int least_binding);
    SyntaxExpression parse_unary();
    SyntaxExpression parse_postfix();
    SyntaxExpression parse_primary();
    SyntaxExpression parse_name();
    SyntaxExpression parse_call(const Token& name);
    SyntaxExpression join(SyntaxExpression::Kind kind, Span span, std::vector<SyntaxExpression> operands);
    SyntaxExpression make_step(SyntaxExpression target, const Token& sign, bool is_postfix);
    void refuse_operator();

    // parse_statements.cpp
    void parse_statements(std::vector<SyntaxStatement>& list, bool is_top_level);
    SyntaxStatement parse_statement();
    SyntaxStatement parse_simple();
    SyntaxStatement parse_compound();
    std::vector<SyntaxStatement> parse_body();
    std::vector<SyntaxStatement> parse_block();
    SyntaxStatement parse_branch();
    SyntaxStatement parse_for();
    SyntaxStatement parse_while();
    SyntaxStatement parse_do();
    SyntaxStatement parse_declaration();
    SyntaxStatement parse_expose();
    void parse_for_head(SyntaxStatement& loop);
    SyntaxExpression parse_condition(std::string_view of);
    std::vector<SyntaxExpression> parse_list(std::string_view end);
    std::vector<Declarator> parse_declarators();
    SignedNumber parse_signed_number();
    bool is_function_ahead() const;
    SyntaxFunction parse_function();
    Declarator parse_parameter();

    std::vector<Token> m_tokens;
    Diagnostics& m_diagnostics;
    std::size_t m_at = 0;
    std::uint32_t m_nesting = 0;
    bool m_has_given_up = false;
    SyntaxScript m_script;
};

} // namespace photonloupe::script
