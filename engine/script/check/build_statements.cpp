// SPDX-License-Identifier: Apache-2.0
// Builds statements: blocks with their scopes, loops, declarations, exposed variables.

#include "script/check/builder_depth.h"
#include "script/check/predefined_names.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {

Statement TreeBuilder::make_statement(Statement::Kind kind, Span span) {
    count_node(span);
    Statement statement;
    statement.kind = kind;
    statement.span = span;
    return statement;
}

void TreeBuilder::build_block(const std::vector<SyntaxStatement>& statements, std::vector<Statement>& out) {
    m_scopes.emplace_back();
    build_list(statements, out);
    m_scopes.pop_back();
}

void TreeBuilder::build_list(const std::vector<SyntaxStatement>& statements, std::vector<Statement>& out) {
    for (const SyntaxStatement& statement : statements)
        build_statement(statement, out);
}

void TreeBuilder::build_statement(const SyntaxStatement& syntax, std::vector<Statement>& out) {
    using Kind = SyntaxStatement::Kind;
    const Depth depth(*this, syntax.span);
    switch (syntax.kind) {
    case Kind::expression:
        return build_expression_statement(*syntax.value, out);
    case Kind::declare:
        return build_declarators(syntax.declarators, out);
    case Kind::branch:
        return build_branch(syntax, out);
    case Kind::for_loop:
    case Kind::while_loop:
    case Kind::do_loop:
        return build_loop(syntax, out);
    case Kind::leave:
    case Kind::next:
    case Kind::give:
        return build_jump(syntax, out);
    case Kind::block: {
        Statement block = make_statement(Statement::Kind::block, syntax.span);
        build_block(syntax.body, block.body);
        out.push_back(std::move(block));
        return;
    }
    case Kind::expose:
        return build_expose(syntax, out);
    case Kind::nothing:
        return;
    }
}

void TreeBuilder::build_expression_statement(const SyntaxExpression& syntax, std::vector<Statement>& out) {
    Statement statement = make_statement(Statement::Kind::expression, syntax.span);
    statement.value =
        syntax.kind == SyntaxExpression::Kind::assignment ? build_assignment(syntax, true) : build_any(syntax);
    if (statement.value->type == Type::text)
        m_diagnostics.add(codes::TEXT_MISUSE, syntax.span, "a label is no statement");
    out.push_back(std::move(statement));
}

// The first value is an assignment of its own; it does not see the name that it is for.
void TreeBuilder::build_declarators(const std::vector<Declarator>& declarators, std::vector<Statement>& out) {
    for (const Declarator& declarator : declarators) {
        std::optional<Expression> size, value;
        if (declarator.size)
            size = build_value(*declarator.size);
        if (declarator.value)
            value = build_value(*declarator.value);
        const std::uint32_t index = declare(declarator);
        if (size) {
            variable(index).array_size = 1; // until the size is known
            m_draft.sizes.push_back({index, std::move(*size)});
        }
        Statement statement = make_statement(Statement::Kind::declare, declarator.span);
        statement.variable = index;
        out.push_back(std::move(statement));
        if (value) {
            const Span span{declarator.span.begin, value->span.end};
            Statement first = make_statement(Statement::Kind::expression, span);
            first.value = make_assignment(index, span, std::move(*value));
            out.push_back(std::move(first));
        }
    }
}

void TreeBuilder::build_branch(const SyntaxStatement& syntax, std::vector<Statement>& out) {
    Statement branch = make_statement(Statement::Kind::branch, syntax.span);
    branch.value = build_value(*syntax.value);
    branch.span = {syntax.span.begin, syntax.value->span.end};
    build_block(syntax.body, branch.body);
    build_block(syntax.otherwise, branch.otherwise);
    out.push_back(std::move(branch));
}

// A loop that declares its variable is a block around the declaration and the loop.
void TreeBuilder::build_loop(const SyntaxStatement& syntax, std::vector<Statement>& out) {
    const bool declares = !syntax.declarators.empty();
    Statement block = make_statement(Statement::Kind::block, syntax.span);
    Statement loop = make_statement(Statement::Kind::loop, syntax.span);
    m_scopes.emplace_back();
    for (const Declarator& declarator : syntax.declarators) {
        std::vector<Statement> declared;
        build_declarators({declarator}, declared);
        block.body.push_back(std::move(declared.front()));
        if (declared.size() > 1)
            loop.first.push_back(std::move(*declared.back().value));
    }
    for (const SyntaxExpression& expression : syntax.first)
        loop.first.push_back(expression.kind == SyntaxExpression::Kind::assignment ? build_assignment(expression, true)
                                                                                   : build_any(expression));
    ++m_context.loop_depth;
    loop.test_last = syntax.kind == SyntaxStatement::Kind::do_loop;
    if (syntax.value)
        loop.value = build_value(*syntax.value);
    build_block(syntax.body, loop.body);
    for (const SyntaxExpression& expression : syntax.last)
        loop.last.push_back(build_any(expression));
    --m_context.loop_depth;
    m_scopes.pop_back();
    if (!declares) {
        out.push_back(std::move(loop));
        return;
    }
    block.body.push_back(std::move(loop));
    out.push_back(std::move(block));
}

void TreeBuilder::build_jump(const SyntaxStatement& syntax, std::vector<Statement>& out) {
    const bool is_return = syntax.kind == SyntaxStatement::Kind::give;
    if (is_return ? !m_context.function : m_context.loop_depth == 0) {
        const std::string word = is_return                                     ? "return"
                                 : syntax.kind == SyntaxStatement::Kind::leave ? "break"
                                                                               : "continue";
        m_diagnostics.add(codes::JUMP_OUTSIDE, syntax.span,
                          "'" + word + "' stands outside a " + (is_return ? "function" : "loop"));
        return;
    }
    Statement jump = make_statement(is_return                                     ? Statement::Kind::give
                                    : syntax.kind == SyntaxStatement::Kind::leave ? Statement::Kind::leave
                                                                                  : Statement::Kind::next,
                                    syntax.span);
    if (syntax.value)
        jump.value = build_value(*syntax.value);
    else if (is_return && m_context.gives_value)
        m_diagnostics.add(codes::NO_VALUE, syntax.span,
                          "'return' without a value, though '" + m_context.function->name + "' returns one elsewhere");
    out.push_back(std::move(jump));
}

void TreeBuilder::build_expose(const SyntaxStatement& syntax, std::vector<Statement>& out) {
    if (m_context.function || m_context.loop_depth > 0) {
        m_diagnostics.add(codes::EXPOSED_INSIDE, syntax.span,
                          std::string("'expose' stands inside a ") + (m_context.loop_depth > 0 ? "loop" : "function"),
                          "move it to the top level, after the variable's first assignment");
        return;
    }
    check_exposure(syntax);
    const std::optional<std::uint32_t> found = find_variable(syntax.name);
    if (!found || find_constant_name(syntax.name)) {
        m_diagnostics.add(codes::BAD_RANGE, syntax.name_span,
                          "'" + syntax.name + "' is no variable that can be exposed",
                          "assign its default before: " + syntax.name + " = …;");
        return;
    }
    Variable& exposed = variable(*found);
    if (exposed.type == Type::list || exposed.array_size > 0) {
        m_diagnostics.add(codes::BAD_RANGE, syntax.name_span, "only a number can be exposed");
        return;
    }
    if (exposed.exposed) {
        m_diagnostics.add(codes::BAD_RANGE, syntax.name_span, "'" + syntax.name + "' is exposed already");
        return;
    }
    exposed.exposed = make_exposure(syntax, m_draft.variable_types[*found]);
    m_draft.variable_types[*found] = exposed.exposed->is_integer ? WrittenType::integer : WrittenType::real;
    m_draft.program.exposed.push_back(*found);
    Statement statement = make_statement(Statement::Kind::expose, syntax.span);
    statement.variable = *found;
    out.push_back(std::move(statement));
}

// A float; an integer if the ends and a step that is written are integers, or if it is declared as one.
Exposure TreeBuilder::make_exposure(const SyntaxStatement& syntax, WrittenType declared) {
    const bool has_whole_ends = syntax.low.is_integer && syntax.high.is_integer;
    const bool has_whole_step = syntax.step && syntax.step->is_integer;
    Exposure exposure{syntax.low.value, syntax.high.value, syntax.step ? syntax.step->value : 0.0};
    exposure.is_integer = (has_whole_ends && has_whole_step) || declared == WrittenType::integer;
    exposure.span = syntax.name_span;
    if (declared == WrittenType::integer && (!has_whole_ends || (syntax.step && !has_whole_step)))
        m_diagnostics.add(codes::BAD_RANGE, syntax.span,
                          "'" + syntax.name + "' is declared 'int', so its range must be written in integers");
    return exposure;
}

void TreeBuilder::check_exposure(const SyntaxStatement& syntax) {
    if (!(syntax.low.value < syntax.high.value))
        m_diagnostics.add(codes::BAD_RANGE, {syntax.low.span.begin, syntax.high.span.end},
                          "the range's first number must be below its second");
    if (syntax.step && !(syntax.step->value > 0))
        m_diagnostics.add(codes::BAD_RANGE, syntax.step->span, "the step must be above 0");
}

} // namespace photonloupe::script
