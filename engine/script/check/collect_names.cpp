// SPDX-License-Identifier: Apache-2.0
// Walks the syntax tree with the names that its blocks declare.
#include "script/check/collect_names.h"

#include <algorithm>
#include <map>

#include "script/builtins.h"

namespace photonloupe::script {
namespace {

// getKNN(…) and its like.
bool is_list_call(const SyntaxExpression& expression) {
    const Builtin* const builtin =
        expression.kind == SyntaxExpression::Kind::call ? find_builtin(expression.name) : nullptr;
    return builtin && builtin->result == Result::list;
}

class NameCollector {
public:
    explicit NameCollector(const std::set<std::string>& declared) : m_scopes{declared} {}

    void walk(const std::vector<SyntaxStatement>& statements) {
        for (const SyntaxStatement& statement : statements)
            walk(statement);
    }

    std::vector<AssignedName> names() { return std::move(m_names); }

private:
    void walk_block(const std::vector<SyntaxStatement>& statements) {
        m_scopes.emplace_back();
        walk(statements);
        m_scopes.pop_back();
    }

    void walk(const SyntaxStatement& statement) {
        using Kind = SyntaxStatement::Kind;
        const bool is_scope = statement.kind == Kind::for_loop;
        if (is_scope)
            m_scopes.emplace_back();
        for (const Declarator& declarator : statement.declarators) {
            if (declarator.value)
                walk(*declarator.value);
            m_scopes.back().insert(declarator.name);
        }
        for (const SyntaxExpression& expression : statement.first)
            walk(expression);
        if (statement.value && statement.kind != Kind::do_loop)
            walk(*statement.value);
        walk_block(statement.body);
        walk_block(statement.otherwise);
        if (statement.value && statement.kind == Kind::do_loop)
            walk(*statement.value);
        for (const SyntaxExpression& expression : statement.last)
            walk(expression);
        if (is_scope)
            m_scopes.pop_back();
    }

    void walk(const SyntaxExpression& expression) {
        if (expression.kind == SyntaxExpression::Kind::assignment) {
            const SyntaxExpression& target = expression.operands[0];
            if (target.kind == SyntaxExpression::Kind::name)
                add(target, is_list_call(expression.operands[1]));
        }
        for (const SyntaxExpression& operand : expression.operands)
            walk(operand);
    }

    void add(const SyntaxExpression& target, bool is_list) {
        const auto declares = [&](const std::set<std::string>& scope) { return scope.contains(target.name); };
        if (std::any_of(m_scopes.begin(), m_scopes.end(), declares))
            return;
        const auto [place, is_new] = m_places.try_emplace(target.name, m_names.size());
        if (is_new)
            m_names.push_back({target.name, target.name_span, false});
        m_names[place->second].is_list |= is_list;
    }

    std::vector<std::set<std::string>> m_scopes;
    std::vector<AssignedName> m_names;
    std::map<std::string, std::size_t> m_places;
};

} // namespace

std::vector<AssignedName> collect_assigned_names(const std::vector<SyntaxStatement>& statements,
                                                 const std::set<std::string>& declared) {
    NameCollector collector(declared);
    collector.walk(statements);
    return collector.names();
}

std::vector<AssignedName> collect_declared_names(const std::vector<SyntaxStatement>& statements) {
    std::vector<AssignedName> names;
    for (const SyntaxStatement& statement : statements)
        if (statement.kind == SyntaxStatement::Kind::declare)
            for (const Declarator& declarator : statement.declarators)
                names.push_back({declarator.name, declarator.span, false});
    return names;
}

} // namespace photonloupe::script
