// SPDX-License-Identifier: Apache-2.0
// Names of variables: which are script-wide, which local, which not there at all.
#include "script/check/predefined_names.h"
#include "script/check/suggest_name.h"
#include "script/check/tree_builder.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

constexpr std::uint32_t MAX_VARIABLES = 256;

} // namespace

TreeBuilder::TreeBuilder(const SyntaxScript& script, const FunctionTable& functions, Draft& draft,
                         Diagnostics& diagnostics)
    : m_script(script), m_functions(functions), m_draft(draft), m_diagnostics(diagnostics), m_scopes(1) {}

void TreeBuilder::declare_predefined() {
    m_counts_variables = false;
    for (const std::string_view name : {"X", "Y", "Z", "E"})
        m_scopes[0][std::string(name)] = add_variable(std::string(name), {}, WrittenType::none);
    m_counts_variables = true;
    for (const auto& [name, index] : m_scopes[0])
        m_script_names[name] = {};
}

// Implicit ones first: an assignment anywhere at top level makes its name script-wide.
void TreeBuilder::declare_script_variables() {
    for (const AssignedName& assigned : collect_assigned_names(m_script.body, {})) {
        if (find_constant_name(assigned.name) || m_scopes[0].contains(assigned.name))
            continue;
        const std::uint32_t index = add_variable(assigned.name, assigned.span, WrittenType::none);
        if (assigned.is_list)
            variable(index).type = Type::list;
        m_scopes[0][assigned.name] = index;
        m_script_names[assigned.name] = assigned.span;
    }
    for (const AssignedName& declared : collect_declared_names(m_script.body))
        m_script_names.try_emplace(declared.name, declared.span);
}

std::uint32_t TreeBuilder::add_variable(const std::string& name, Span span, WrittenType type) {
    if (m_counts_variables && ++m_variable_count == MAX_VARIABLES + 1)
        m_diagnostics.add(codes::TOO_MANY_VARIABLES, span, "more than 256 variables",
                          "use an array, or the same variable again");
    count_node(span);
    Variable added;
    added.name = name;
    added.span = span;
    added.is_local = m_context.function || m_scopes.size() > 1;
    m_draft.program.variables.push_back(std::move(added));
    m_draft.variable_types.push_back(type);
    return std::uint32_t(m_draft.program.variables.size() - 1);
}

// In the innermost block; a name once a block.
std::uint32_t TreeBuilder::declare(const Declarator& declarator) {
    if (find_constant_name(declarator.name))
        m_diagnostics.add(codes::NOT_ASSIGNABLE, declarator.span,
                          "'" + declarator.name + "' is a constant of the language", "choose another name");
    const std::uint32_t index = add_variable(declarator.name, declarator.span, declarator.type);
    const auto [place, is_new] = m_scopes.back().try_emplace(declarator.name, index);
    const bool hides_predefined = place->second < std::size(PREDEFINED_VALUES);
    if (!is_new && !hides_predefined) {
        const Place first = m_draft.program.source.find_place(variable(place->second).span.begin);
        m_diagnostics.add(codes::NAME_TAKEN, declarator.span, "there is a variable '" + declarator.name + "' already",
                          "first on line " + std::to_string(first.line));
    }
    place->second = index;
    return index;
}

std::optional<std::uint32_t> TreeBuilder::find_variable(const std::string& name) const {
    for (std::size_t scope = m_scopes.size(); scope-- > m_context.first_scope;)
        if (const auto found = m_scopes[scope].find(name); found != m_scopes[scope].end())
            return found->second;
    const auto found = m_scopes[0].find(name);
    return found != m_scopes[0].end() ? std::optional(found->second) : std::nullopt;
}

std::optional<std::uint32_t> TreeBuilder::resolve(const SyntaxExpression& name) {
    const std::optional<std::uint32_t> found = find_variable(name.name);
    if (!found)
        refuse_unknown_variable(name);
    return found;
}

std::optional<std::uint32_t> TreeBuilder::resolve_target(const SyntaxExpression& target) {
    if (find_constant_name(target.name)) {
        m_diagnostics.add(codes::NOT_ASSIGNABLE, target.name_span, "'" + target.name + "' can't be assigned",
                          "it is a constant of the language");
        return std::nullopt;
    }
    const std::optional<std::uint32_t> found = resolve(target);
    if (found && m_context.function && !variable(*found).is_local) {
        m_diagnostics.add(codes::FUNCTION_WRITES_SCRIPT, target.name_span,
                          "a function can't write the script's variable '" + target.name + "'",
                          "return the value, or declare a variable of the function: 'float " + target.name + ";'");
        return std::nullopt;
    }
    return found;
}

void TreeBuilder::refuse_unknown_variable(const SyntaxExpression& name) {
    std::vector<std::string_view> known = list_constant_names();
    for (std::size_t scope = 0; scope < m_scopes.size(); ++scope)
        if (scope == 0 || scope >= m_context.first_scope)
            for (const auto& [known_name, index] : m_scopes[scope])
                known.push_back(known_name);
    std::string note;
    if (const auto later = m_script_names.find(name.name); later != m_script_names.end())
        note = "it is declared on line " + std::to_string(m_draft.program.source.find_place(later->second.begin).line) +
               ", after this";
    else if (const Builtin* const builtin = find_builtin(name.name))
        note = "a function is called with parentheses: " + std::string(builtin->signature);
    else if (const auto function = m_functions.find(name.name); function != m_functions.end())
        note = "a function is called with parentheses: " + write_signature(*function->second);
    else if (const std::string near = suggest_name(name.name, known); !near.empty())
        note = "did you mean '" + near + "'?";
    m_diagnostics.add(codes::UNKNOWN_VARIABLE, name.name_span, "unknown variable '" + name.name + "'", note);
}

} // namespace photonloupe::script
