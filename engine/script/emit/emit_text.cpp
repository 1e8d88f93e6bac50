// SPDX-License-Identifier: Apache-2.0
// The emitter's lines, temporaries, names and fault sites.
#include <algorithm>
#include <cctype>

#include "script/emit/emitter.h"
#include "script/emit/glsl_numbers.h"

namespace photonloupe::script {
namespace {

constexpr std::size_t LONGEST_NAME = 40;     // of a script's; glslang takes 1,024
constexpr std::size_t LONGEST_COMMENT = 100; // of a script's line
constexpr std::uint32_t DEEPEST = 16;        // operators in one another, before a temporary is made
constexpr std::size_t LONGEST_TEXT = 300;    // of an expression

// A name or a number.
bool is_name(const std::string& text) {
    return std::all_of(text.begin(), text.end(),
                       [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '.'; });
}

} // namespace

void Emitter::write_line(const std::string& text) {
    m_block.text += std::string(4 * m_indent, ' ') + text + '\n';
}

void Emitter::open(const std::string& head) {
    write_line(head + " {");
    ++m_indent;
}

void Emitter::close(const std::string& tail) {
    --m_indent;
    write_line("}" + tail);
}

// The script's line, once; without what could end the comment or go on behind it.
void Emitter::write_comment(Span span) {
    const std::uint32_t line = m_program.source.find_place(span.begin).line;
    if (line == m_last_line)
        return;
    m_last_line = line;
    std::string text;
    for (const char c : m_program.source.line_text(line))
        text += c < ' ' || c > '~' || c == '\\' ? ' ' : c;
    const std::size_t first = text.find_first_not_of(' ');
    text = first == std::string::npos ? "" : text.substr(first, LONGEST_COMMENT);
    text.erase(text.find_last_not_of(' ') + 1);
    write_line("// " + std::to_string(line) + ": " + text);
}

void Emitter::append(const Block& block) {
    m_block.text += block.text;
    m_block.changes |= block.changes;
}

Code Emitter::keep(Type type, const Code& code) {
    if (code.is_stable && is_name(code.text))
        return code;
    return keep((type == Type::real ? "precise " : "") + name_type(type), code.text);
}

Code Emitter::keep(const std::string& type, const std::string& text) {
    const std::string name = "t" + std::to_string(++m_temporaries);
    write_line(type + " " + name + " = " + text + ";");
    return {name, Binding::primary, true};
}

Code Emitter::keep_shallow(Type type, Code code) {
    return code.depth > DEEPEST || code.text.size() > LONGEST_TEXT ? keep(type, code) : code;
}

std::string Emitter::make_unique(const std::string& wish) {
    std::string name = wish;
    for (int number = 2; !m_taken.insert(name).second; ++number)
        name = wish + "_" + std::to_string(number);
    return name;
}

// GLSL reserves names with two underscores side by side.
std::string Emitter::make_name(const std::string& prefix, const std::string& name) {
    std::string text = prefix;
    for (const char c : name.substr(0, LONGEST_NAME))
        text += c == '_' && text.back() == '_' ? 'u' : c;
    if (text.back() == '_')
        text += 'u';
    return make_unique(text);
}

std::string Emitter::find_site(const PassSite& wanted) {
    const auto is_wanted = [&](const PassSite& site) {
        const Span span = site.loop ? site.loop->span : site.fault.span;
        const Span other = wanted.loop ? wanted.loop->span : wanted.fault.span;
        return !site.loop == !wanted.loop && site.fault.kind == wanted.fault.kind && span.begin == other.begin &&
               span.end == other.end;
    };
    const auto found = std::find_if(m_pass.sites.begin(), m_pass.sites.end(), is_wanted);
    const std::string number = std::to_string(found - m_pass.sites.begin()) + "u";
    if (found == m_pass.sites.end())
        m_pass.sites.push_back(wanted);
    return number;
}

void Emitter::use(const std::string& library) {
    m_libraries.insert(library);
}

} // namespace photonloupe::script
