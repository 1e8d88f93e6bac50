// SPDX-License-Identifier: Apache-2.0
// Collects functions and walks their calls.
#include "script/check/call_graph.h"

#include <algorithm>
#include <set>

#include "script/builtins.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

struct Call {
    std::string name;
    Span span;
};

void gather_calls(const SyntaxExpression& expression, std::vector<Call>& calls) {
    if (expression.kind == SyntaxExpression::Kind::call)
        calls.push_back({expression.name, expression.name_span});
    for (const SyntaxExpression& operand : expression.operands)
        gather_calls(operand, calls);
}

void gather_calls(const std::vector<SyntaxStatement>& statements, std::vector<Call>& calls) {
    for (const SyntaxStatement& statement : statements) {
        for (const Declarator& declarator : statement.declarators)
            for (const auto* expression : {&declarator.size, &declarator.value})
                if (*expression)
                    gather_calls(**expression, calls);
        for (const SyntaxExpression& expression : statement.first)
            gather_calls(expression, calls);
        if (statement.value)
            gather_calls(*statement.value, calls);
        gather_calls(statement.body, calls);
        gather_calls(statement.otherwise, calls);
        for (const SyntaxExpression& expression : statement.last)
            gather_calls(expression, calls);
    }
}

// Depth first without recursion: a script may define thousands of functions that call each other in a row.
class CycleFinder {
public:
    CycleFinder(const FunctionTable& table, Diagnostics& diagnostics) : m_diagnostics(diagnostics) {
        for (const auto& [name, function] : table)
            gather_calls(function->body, m_calls[name]);
    }

    bool find() {
        for (const auto& [name, calls] : m_calls)
            if (!m_done.contains(name))
                visit(name);
        return m_has_cycle;
    }

private:
    struct Visit {
        std::string name;
        std::size_t next = 0; // call to follow
    };

    void visit(const std::string& root) {
        std::vector<Visit> path{{root}};
        m_open.insert(root);
        while (!path.empty()) {
            const std::vector<Call>& calls = m_calls[path.back().name];
            if (path.back().next == calls.size()) {
                m_open.erase(path.back().name);
                m_done.insert(path.back().name);
                path.pop_back();
                continue;
            }
            const Call& call = calls[path.back().next++];
            if (m_open.contains(call.name)) {
                refuse(path, call);
            } else if (m_calls.contains(call.name) && !m_done.contains(call.name)) {
                m_open.insert(call.name);
                path.push_back({call.name});
            }
        }
    }

    void refuse(const std::vector<Visit>& path, const Call& call) {
        constexpr std::size_t MAX_NAMED = 8;
        m_has_cycle = true;
        auto at = std::find_if(path.begin(), path.end(), [&](const Visit& visit) { return visit.name == call.name; });
        std::string cycle;
        for (std::size_t named = 0; at != path.end(); ++at, ++named) {
            if (named == MAX_NAMED) {
                cycle += "... -> ";
                break;
            }
            cycle += at->name + " -> ";
        }
        m_diagnostics.add(codes::RECURSION, call.span, "'" + call.name + "' calls itself: " + cycle + call.name,
                          "functions are inlined; use a loop");
    }

    Diagnostics& m_diagnostics;
    std::map<std::string, std::vector<Call>> m_calls;
    std::set<std::string> m_open, m_done;
    bool m_has_cycle = false;
};

} // namespace

FunctionTable build_function_table(const SyntaxScript& script, Diagnostics& diagnostics) {
    FunctionTable table;
    for (const SyntaxFunction& function : script.functions) {
        if (const Builtin* const builtin = find_builtin(function.name))
            diagnostics.add(codes::NAME_TAKEN, function.span, "'" + function.name + "' is a predefined function",
                            "choose another name than " + std::string(builtin->signature));
        else if (!table.emplace(function.name, &function).second)
            diagnostics.add(codes::NAME_TAKEN, function.span, "a function '" + function.name + "' is defined already");
    }
    return table;
}

bool check_recursion(const FunctionTable& table, Diagnostics& diagnostics) {
    return !CycleFinder(table, diagnostics).find();
}

} // namespace photonloupe::script
