// SPDX-License-Identifier: Apache-2.0
// Turns the syntax tree into the typed tree's shape: names resolved, functions copied to their calls, kinds of values
// checked. Types of numbers follow later (infer_types.h).
#pragma once

#include <map>
#include <string>
#include <vector>

#include "script/builtins.h"
#include "script/check/call_graph.h"
#include "script/check/collect_names.h"
#include "script/check/draft.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

class TreeBuilder {
public:
    TreeBuilder(const SyntaxScript& script, const FunctionTable& functions, Draft& draft, Diagnostics& diagnostics);
    void build();

private:
    // Thrown when the tree grows past every limit: nothing more is built.
    struct TooLarge {};

    using Scope = std::map<std::string, std::uint32_t>; // variables by name

    // The function whose copy is being built; null at top level.
    struct FunctionContext {
        const SyntaxFunction* function = nullptr;
        bool gives_value = false;
        std::size_t first_scope = 0; // names are sought from here on, then in the script's scope
        std::uint32_t loop_depth = 0;
    };

    class Depth; // one level of recursion

    // build_names.cpp
    void declare_predefined();
    void declare_script_variables();
    std::uint32_t add_variable(const std::string& name, Span span, WrittenType type);
    std::uint32_t declare(const Declarator& declarator);
    std::optional<std::uint32_t> find_variable(const std::string& name) const;
    std::optional<std::uint32_t> resolve(const SyntaxExpression& name);
    std::optional<std::uint32_t> resolve_target(const SyntaxExpression& target);
    void refuse_unknown_variable(const SyntaxExpression& name);

    // build_statements.cpp
    void build_block(const std::vector<SyntaxStatement>& statements, std::vector<Statement>& out);
    void build_list(const std::vector<SyntaxStatement>& statements, std::vector<Statement>& out);
    void build_statement(const SyntaxStatement& syntax, std::vector<Statement>& out);
    void build_expression_statement(const SyntaxExpression& syntax, std::vector<Statement>& out);
    void build_declarators(const std::vector<Declarator>& declarators, std::vector<Statement>& out);
    void build_branch(const SyntaxStatement& syntax, std::vector<Statement>& out);
    void build_loop(const SyntaxStatement& syntax, std::vector<Statement>& out);
    void build_jump(const SyntaxStatement& syntax, std::vector<Statement>& out);
    void build_expose(const SyntaxStatement& syntax, std::vector<Statement>& out);
    Exposure make_exposure(const SyntaxStatement& syntax, WrittenType declared);
    void check_exposure(const SyntaxStatement& syntax);
    Statement make_statement(Statement::Kind kind, Span span);

    // build_expressions.cpp
    Expression build_value(const SyntaxExpression& syntax); // a number
    Expression build_any(const SyntaxExpression& syntax);   // a number, list, label, or nothing (a call without value)
    Expression build_number(const SyntaxExpression& syntax);
    Expression build_name(const SyntaxExpression& syntax);
    Expression build_index(const SyntaxExpression& syntax);
    Expression build_unary(const SyntaxExpression& syntax);
    Expression build_assignment(const SyntaxExpression& syntax, bool is_statement);
    Expression build_list_assignment(const SyntaxExpression& syntax, std::uint32_t variable, bool is_statement);
    Expression build_operands(Expression::Kind kind, const SyntaxExpression& syntax);
    Expression make_expression(Expression::Kind kind, Span span);
    Expression make_assignment(std::uint32_t variable, Span span, Expression value);
    Expression make_variable(std::uint32_t variable, Span span);

    // build_calls.cpp
    Expression build_call(const SyntaxExpression& syntax);
    Expression build_builtin(const SyntaxExpression& syntax, const Builtin& builtin);
    Expression build_builtin_argument(const SyntaxExpression& syntax, const Builtin& builtin, Argument argument);
    Expression build_function_call(const SyntaxExpression& syntax, const SyntaxFunction& function);
    std::uint32_t copy_function(const SyntaxFunction& function);
    void build_function_body(const SyntaxFunction& function, Function& copy);
    void check_uncalled(const SyntaxFunction& function);
    void refuse_unknown_function(const SyntaxExpression& call);
    bool check_argument_count(const SyntaxExpression& call, std::size_t least, std::size_t most,
                              const std::string& signature);

    Variable& variable(std::uint32_t index) { return m_draft.program.variables[index]; }
    void count_node(Span span);

    const SyntaxScript& m_script;
    const FunctionTable& m_functions;
    Draft& m_draft;
    Diagnostics& m_diagnostics;
    std::vector<Scope> m_scopes;                    // the script's first
    std::map<std::string, Span> m_script_names;     // all that are script-wide, those declared further down too
    std::map<const SyntaxFunction*, bool> m_copied; // functions with a copy, whose variables are counted
    FunctionContext m_context;
    bool m_counts_variables = true; // a function's second copy has no variables of its own to write
    std::uint32_t m_variable_count = 0;
    std::uint32_t m_node_count = 0;
    std::uint32_t m_depth = 0;
};

// "f(a, b)"
std::string write_signature(const SyntaxFunction& function);

// Ways through a body that end without `return value`.
bool may_end(const std::vector<Statement>& body);

} // namespace photonloupe::script
