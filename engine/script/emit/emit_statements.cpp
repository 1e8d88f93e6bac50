// SPDX-License-Identifier: Apache-2.0
// Statements as GLSL.
#include <algorithm>
#include <cctype>
#include <utility>

#include "script/emit/emitter.h"
#include "script/emit/glsl_numbers.h"

namespace photonloupe::script {
namespace {

// The one assignment or call that a block holds, without its semicolon; nothing where it holds more or a declaration.
std::string find_single(const Block& block) {
    const std::size_t end = block.text.find(";\n");
    if (end == std::string::npos || end + 2 != block.text.size())
        return {};
    const std::size_t first = block.text.find_first_not_of(' ');
    const std::string text = block.text.substr(first, end - first);
    const std::size_t space = text.find(' ');
    const bool is_declaration = space != std::string::npos &&
                                std::isalnum(static_cast<unsigned char>(text[space + 1])) && text.find('(') > space;
    const bool is_branch = text.rfind("if ", 0) == 0;
    return is_declaration || is_branch || text.find_first_of("{};\n") != std::string::npos ? std::string() : text;
}

} // namespace

void Emitter::emit(const std::vector<Statement>& statements) {
    for (const Statement& s : statements)
        emit(s);
}

void Emitter::emit(const Statement& s) {
    if (s.kind != Statement::Kind::block)
        write_comment(s.span);
    switch (s.kind) {
    case Statement::Kind::expression:
        return emit_unused(*s.value);
    case Statement::Kind::declare:
        return emit_declaration(s);
    case Statement::Kind::branch:
        return emit_branch(s);
    case Statement::Kind::loop:
        return emit_loop(s);
    case Statement::Kind::photon_loop:
        return emit_photon_loop_inside(s);
    case Statement::Kind::block:
        return emit(s.body);
    case Statement::Kind::leave:
        return write_line("break;");
    case Statement::Kind::next:
        if (m_loops.back().is_photon_loop)
            return write_line("return;");
        if (m_loops.back().before_next)
            m_loops.back().before_next();
        return write_line("continue;");
    case Statement::Kind::give:
        return emit_return(s);
    case Statement::Kind::expose:
        return;
    }
}

void Emitter::emit_unused(const Expression& e) {
    if (e.kind == Expression::Kind::assignment) {
        if (!emit_reduction(e))
            emit_assignment(e, false);
        return;
    }
    const Code code = emit(e);
    if (code.text.find('(') != std::string::npos)
        write_line(code.text + ";"); // it may report something
}

void Emitter::emit_unused(const std::vector<Expression>& list) {
    for (const Expression& e : list)
        emit_unused(e);
}

void Emitter::emit_declaration(const Statement& s) {
    const Variable& declared = variable(s.variable);
    const std::string& name = m_names.at(s.variable);
    if (declared.array_size > 0) {
        const std::string type = declared.type == Type::integer ? "int" : "float";
        m_zeros.insert({declared.array_size, type});
        write_line(name + " = ZEROS_" + type + "_" + std::to_string(declared.array_size) + ";");
        m_block.changes = true;
    } else if (is_checked(s.variable)) {
        write_line(m_set_flags.at(s.variable) + " = false;");
        m_block.changes = true;
    }
    if (s.value)
        emit_unused(*s.value);
}

void Emitter::emit_branch(const Statement& s) {
    if (m_loop.choices.contains(&s))
        return emit_choice(*match_choice(m_program, s));
    open("if (" + emit_condition(*s.value).text + ")");
    emit(s.body);
    const std::vector<Statement>* otherwise = &s.otherwise;
    while (!otherwise->empty()) {
        const Statement& first = otherwise->front();
        Code condition;
        Block block;
        if (otherwise->size() == 1 && first.kind == Statement::Kind::branch && !m_loop.choices.contains(&first))
            block = capture([&] { condition = emit_condition(*first.value); });
        if (condition.text.empty() || !block.text.empty())
            break;
        close(" else if (" + condition.text + ") {");
        ++m_indent;
        write_comment(first.span);
        emit(first.body);
        otherwise = &first.otherwise;
    }
    if (!otherwise->empty()) {
        close(" else {");
        ++m_indent;
        emit(*otherwise);
    }
    close();
}

std::string Emitter::turn_check(const Statement& s) {
    return s.is_bounded && s.kind == Statement::Kind::loop ? "take_turn()" : "take_step(" + find_site({{}, &s}) + ")";
}

void Emitter::emit_loop(const Statement& s) {
    m_has_loops = true;
    emit_unused(s.first);
    Code condition{"true"};
    Block block;
    if (s.value)
        block = capture([&] { condition = emit_condition(*s.value); });
    std::string last;
    bool is_short = block.text.empty();
    for (const Expression& e : s.last) {
        const std::string single = find_single(capture([&] { emit_unused(e); }));
        is_short &= !single.empty();
        last += (last.empty() ? "" : ", ") + single;
    }
    const std::optional<PathCounter> counter = m_function ? std::nullopt : find_path_counter(m_program, m_loop, s);
    if (counter)
        m_path_counters.push_back(*counter);
    if (is_short)
        emit_short_loop(s, s.value ? condition : Code{}, last);
    else
        emit_long_loop(s);
    if (counter)
        m_path_counters.pop_back();
    const bool is_inside_loop = m_loops.size() > 1;       // the photon loop is the first
    if (!counter || !counter->is_short || is_inside_loop) // a few turns are shared after every photon
        write_line("share_turns();");
}

// Condition and last part are expressions of GLSL.
void Emitter::emit_short_loop(const Statement& s, const Code& condition, const std::string& last) {
    m_loops.push_back({});
    if (s.test_last) {
        open("do");
        write_line("if (!" + turn_check(s) + ") break;");
        emit(s.body);
        close(" while (" + (condition.text.empty() ? "true" : condition.text) + ");");
    } else {
        std::string check = condition.binding > Binding::conjunction ? "(" + condition.text + ")" : condition.text;
        check += (check.empty() ? "" : " && ") + turn_check(s);
        open(last.empty() ? "while (" + check + ")" : "for (; " + check + "; " + last + ")");
        emit(s.body);
        close();
    }
    m_loops.pop_back();
}

// They need statements of their own, also where the script says `continue`.
void Emitter::emit_long_loop(const Statement& s) {
    const auto leave_unless = [this, &s] {
        if (s.value)
            write_line("if (!(" + emit_condition(*s.value).text + ")) break;");
    };
    const auto finish_turn = [this, &s, leave_unless] {
        emit_unused(s.last);
        if (s.test_last)
            leave_unless();
    };
    m_loops.push_back({false, finish_turn});
    open("for (;;)");
    if (!s.test_last)
        leave_unless();
    write_line("if (!" + turn_check(s) + ") break;");
    emit(s.body);
    finish_turn();
    close();
    m_loops.pop_back();
}

// An ordinary loop here.
void Emitter::emit_photon_loop_inside(const Statement& s) {
    m_has_loops = true;
    const std::string& name = m_names.at(s.variable);
    write_line(name + " = 0;");
    m_loops.push_back({});
    open("for (; " + name + " < int(settings.photon_count) && " + turn_check(s) + "; ++" + name + ")");
    emit(s.body);
    close();
    m_loops.pop_back();
    write_line("share_turns();");
}

void Emitter::emit_return(const Statement& s) {
    if (m_function->result == Type::none || !s.value) {
        if (s.value)
            emit_unused(*s.value);
        return write_line(m_function->result == Type::none ? "return;"
                                                           : "return " + write_nothing(m_function->result) + ";");
    }
    const Code value = m_function->result == Type::list ? emit_list(*s.value) : emit_as(*s.value, m_function->result);
    write_line("return " + value.text + ";");
}

// One GLSL function for each call: its names and its photon may mean other things at the next.
void Emitter::emit_function(const Function& function, const Expression& call) {
    if (m_function_names.contains(call.function))
        return;
    std::string parameters;
    for (const std::uint32_t parameter : function.parameters)
        parameters += (parameters.empty() ? "" : ", ") + std::string(name_type(variable(parameter).type)) + " " +
                      m_names.at(parameter);
    const std::string name = make_name("f_", function.name + "_1");
    m_function_names[call.function] = name;

    const std::vector<std::uint32_t> own_variables = list_own_variables(m_program, function);
    m_function_variables.insert(own_variables.begin(), own_variables.end());

    const Function* outer = std::exchange(m_function, &function);
    const std::uint32_t indent = std::exchange(m_indent, 1), line = std::exchange(m_last_line, 0);
    std::vector<LoopContext> loops;
    std::swap(loops, m_loops);
    Block block = capture([&] {
        emit(function.body);
        if (function.may_end_without_value)
            write_line("fault_if(true, " + find_site(Fault::no_value, call.span) + ");");
        if (function.result != Type::none)
            write_line("return " + write_nothing(function.result) + ";");
    });
    std::swap(loops, m_loops);
    m_indent = indent;
    m_last_line = line;
    m_function = outer;

    std::string declarations;
    for (const std::uint32_t own : own_variables)
        declarations += declare_variable(own, std::find(function.parameters.begin(), function.parameters.end(), own) !=
                                                  function.parameters.end());
    m_functions += std::string(name_type(function.result)) + " " + name + "(" + parameters + ") {\n" + declarations +
                   block.text + "}\n\n";
}

} // namespace photonloupe::script
