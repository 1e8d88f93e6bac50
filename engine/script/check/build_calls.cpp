// SPDX-License-Identifier: Apache-2.0
// Builds calls: arguments of predefined ones are matched to the table, functions of the script copied to each call.
#include <algorithm>

#include "script/check/builder_depth.h"
#include "script/check/predefined_names.h"
#include "script/check/suggest_name.h"
#include "script/read/diagnostic_codes.h"

namespace photonloupe::script {
namespace {

using Kind = Expression::Kind;

constexpr std::size_t ANY_NUMBER = 32; // of values to print

bool gives_value(const std::vector<SyntaxStatement>& statements) {
    return std::any_of(statements.begin(), statements.end(), [](const SyntaxStatement& statement) {
        return (statement.kind == SyntaxStatement::Kind::give && statement.value) || gives_value(statement.body) ||
               gives_value(statement.otherwise);
    });
}

} // namespace

std::string write_signature(const SyntaxFunction& function) {
    std::string signature = function.name + '(';
    for (const Declarator& parameter : function.parameters)
        signature += (&parameter == &function.parameters.front() ? "" : ", ") + parameter.name;
    return signature + ')';
}

namespace {

std::string count_arguments(std::size_t count) {
    return std::to_string(count) + (count == 1 ? " argument" : " arguments");
}

} // namespace

Expression TreeBuilder::build_call(const SyntaxExpression& syntax) {
    if (const auto found = m_functions.find(syntax.name); found != m_functions.end())
        return build_function_call(syntax, *found->second);
    if (const Builtin* const builtin = find_builtin(syntax.name))
        return build_builtin(syntax, *builtin);
    refuse_unknown_function(syntax);
    for (const SyntaxExpression& argument : syntax.operands)
        build_any(argument);
    return make_unknown(syntax.span);
}

void TreeBuilder::refuse_unknown_function(const SyntaxExpression& call) {
    std::vector<std::string_view> known;
    for (const Builtin& builtin : list_builtins())
        known.push_back(builtin.name);
    for (const auto& [name, function] : m_functions)
        known.push_back(name);
    std::string note;
    if (const std::optional<std::uint32_t> found = find_variable(call.name);
        found && (variable(*found).array_size > 0 || variable(*found).type == Type::list)) {
        note = "an element is written " + call.name + "[j]";
    } else if (const std::string near = suggest_name(call.name, known); !near.empty()) {
        const Builtin* const builtin = find_builtin(near);
        note = "did you mean '" + (builtin ? std::string(builtin->signature) : write_signature(*m_functions.at(near))) +
               "'?";
    }
    m_diagnostics.add(codes::UNKNOWN_FUNCTION, call.name_span, "unknown function '" + call.name + "'", note);
}

bool TreeBuilder::check_argument_count(const SyntaxExpression& call, std::size_t least, std::size_t most,
                                       const std::string& signature) {
    const std::size_t count = call.operands.size();
    if (count >= least && count <= most)
        return true;
    const std::string wanted = least == most   ? count_arguments(least)
                               : count < least ? "at least " + count_arguments(least)
                                               : "at most " + count_arguments(most);
    m_diagnostics.add(codes::ARGUMENT_COUNT, call.span,
                      "'" + call.name + "' takes " + wanted + ", not " + std::to_string(count), signature);
    return false;
}

Expression TreeBuilder::build_builtin(const SyntaxExpression& syntax, const Builtin& builtin) {
    const std::string signature(builtin.signature);
    Expression call = make_expression(Kind::builtin, syntax.span);
    call.builtin = &builtin;
    bool is_complete = check_argument_count(syntax, builtin.required,
                                            builtin.variadic ? ANY_NUMBER : builtin.arguments.size(), signature);
    if (is_complete && builtin.id == BuiltinId::dot && syntax.operands.size() == 5) {
        m_diagnostics.add(codes::ARGUMENT_COUNT, syntax.span, "'dot' takes 4 or 6 arguments, not 5", signature);
        is_complete = false;
    }
    for (std::size_t i = 0; i < syntax.operands.size(); ++i)
        call.operands.push_back(build_builtin_argument(
            syntax.operands[i], builtin, i < builtin.arguments.size() ? builtin.arguments[i] : Argument::number));
    if (!is_complete)
        return make_unknown(syntax.span);
    switch (builtin.result) {
    case Result::none:
        call.type = Type::none;
        break;
    case Result::list:
        call.type = Type::list;
        break;
    default:
        break;
    }
    if (builtin.id == BuiltinId::length) {
        call.kind = Kind::list_length;
        call.type = Type::integer;
        if (is_unknown(call.operands[0]))
            return make_unknown(syntax.span);
    }
    return call;
}

Expression TreeBuilder::build_builtin_argument(const SyntaxExpression& syntax, const Builtin& builtin,
                                               Argument argument) {
    const Type wanted = argument == Argument::list ? Type::list : argument == Argument::text ? Type::text : Type::real;
    Expression value = build_any(syntax);
    const bool is_number = value.type == Type::integer || value.type == Type::real;
    const bool fits = wanted == Type::real ? is_number : value.type == wanted;
    // A query is stored first: its neighbors are found once.
    const bool is_stored = wanted != Type::list || value.kind == Kind::variable;
    if (is_unknown(value) || (fits && is_stored))
        return value;
    const std::string wanted_text = wanted == Type::list   ? "a variable that holds a neighbor list"
                                    : wanted == Type::text ? "a label in quotes"
                                                           : "a number";
    const std::string found_text = value.type == Type::list   ? "a neighbor list"
                                   : value.type == Type::text ? "a label"
                                   : is_number                ? "a number"
                                                              : "a call without value";
    m_diagnostics.add(codes::ARGUMENT_KIND, syntax.span,
                      "'" + std::string(builtin.name) + "' takes " + wanted_text + " here, not " + found_text,
                      std::string(builtin.signature));
    return make_unknown(syntax.span);
}

Expression TreeBuilder::build_function_call(const SyntaxExpression& syntax, const SyntaxFunction& function) {
    const std::size_t count = function.parameters.size();
    Expression call = make_expression(Kind::call, syntax.span);
    for (const SyntaxExpression& argument : syntax.operands)
        call.operands.push_back(build_value(argument));
    if (!check_argument_count(syntax, count, count, write_signature(function)))
        return make_unknown(syntax.span);
    call.function = copy_function(function);
    call.type = m_draft.program.functions[call.function].result;
    return call;
}

// Its statements and variables once more, for one call.
std::uint32_t TreeBuilder::copy_function(const SyntaxFunction& function) {
    const Depth depth(*this, function.span);
    const auto index = std::uint32_t(m_draft.program.functions.size());
    m_draft.program.functions.emplace_back();
    m_draft.result_types.push_back(function.result);
    Function copy;
    copy.name = function.name;
    copy.span = function.span;
    const FunctionContext caller = m_context;
    const bool counted = m_counts_variables;
    m_context = {&function, gives_value(function.body), m_scopes.size(), 0};
    m_counts_variables = counted && !m_copied[&function];
    m_copied[&function] = true;
    copy.result = m_context.gives_value ? Type::real : Type::none;
    m_scopes.emplace_back();
    build_function_body(function, copy);
    m_scopes.pop_back();
    m_context = caller;
    m_counts_variables = counted;
    copy.may_end_without_value = copy.result != Type::none && may_end(copy.body);
    m_draft.program.functions[index] = std::move(copy);
    return index;
}

// Variables that assignments declare are unset anew in every call: they are declared where the body begins.
void TreeBuilder::build_function_body(const SyntaxFunction& function, Function& copy) {
    std::set<std::string> names;
    for (const Declarator& parameter : function.parameters) {
        names.insert(parameter.name);
        copy.parameters.push_back(declare(parameter));
    }
    for (const AssignedName& assigned : collect_assigned_names(function.body, names)) {
        if (m_script_names.contains(assigned.name) || find_constant_name(assigned.name))
            continue; // refused where it is assigned
        const std::uint32_t local = add_variable(assigned.name, assigned.span, WrittenType::none);
        if (assigned.is_list)
            variable(local).type = Type::list;
        m_scopes.back()[assigned.name] = local;
        Statement unset = make_statement(Statement::Kind::declare, assigned.span);
        unset.variable = local;
        copy.body.push_back(std::move(unset));
    }
    build_list(function.body, copy.body);
}

// A function that nothing calls is checked as if it were called with whole numbers, and then forgotten.
void TreeBuilder::check_uncalled(const SyntaxFunction& function) {
    Expression call = make_expression(Kind::call, function.span);
    for (std::size_t i = 0; i < function.parameters.size(); ++i) {
        Expression zero = make_expression(Kind::number, function.span);
        zero.type = Type::integer;
        Expression argument = make_expression(Kind::builtin, function.span);
        argument.builtin = find_builtin("getNumPathVertices"); // no constant, and no count of photons
        argument.operands.push_back(std::move(zero));
        call.operands.push_back(std::move(argument));
    }
    call.function = copy_function(function);
    call.type = m_draft.program.functions[call.function].result;
    Statement statement = make_statement(Statement::Kind::expression, function.span);
    statement.value = std::move(call);
    m_draft.program.body.push_back(std::move(statement));
}

void TreeBuilder::build() {
    try {
        declare_predefined();
        declare_script_variables();
        build_list(m_script.body, m_draft.program.body);
        m_draft.called = {m_draft.program.body.size(), m_draft.program.functions.size(),
                          m_draft.program.variables.size()};
        for (const SyntaxFunction& function : m_script.functions) {
            const bool is_known = m_functions.contains(function.name) && m_functions.at(function.name) == &function;
            if (is_known && function.result != WrittenType::none && !gives_value(function.body))
                m_diagnostics.add(codes::NO_VALUE, function.span, "'" + function.name + "' never returns a value",
                                  "write 'function' if it is to return none");
            if (is_known && !m_copied[&function])
                check_uncalled(function);
        }
    } catch (const TooLarge&) {
        m_draft.is_too_large = true;
    }
}

} // namespace photonloupe::script
