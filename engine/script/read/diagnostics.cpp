// SPDX-License-Identifier: Apache-2.0
// Collects diagnostics and writes them as text with the source line and a caret under the span.
#include "script/read/diagnostics.h"

#include <algorithm>

#include "script/read/utf8.h"

namespace photonloupe::script {
namespace {

// A longer line is shown around the span only; enough for what people write, little enough for any terminal.
constexpr std::size_t MAX_SHOWN_COLUMNS = 160;
constexpr std::size_t COLUMNS_BEFORE_SPAN = 60;

// The line and, below it, the carets: one column a code point, tabs kept, control characters and bad bytes as "?".
std::string quote_line(const Source& source, const Diagnostic& diagnostic) {
    const Place place = source.find_place(diagnostic.span.begin);
    const std::string_view line = source.line_text(place.line);
    const std::size_t begin = line.empty() ? 0 : std::size_t(line.data() - source.text.data());
    std::string shown, carets;
    std::size_t column = 1, caret_count = 0;
    const std::size_t first = place.column > COLUMNS_BEFORE_SPAN ? place.column - COLUMNS_BEFORE_SPAN : 1;
    if (first > 1) {
        shown += "...";
        carets += "   ";
    }
    for (std::size_t at = 0; at < line.size(); ++column) {
        const Utf8Character character = decode_utf8(line, at);
        const std::string_view bytes = line.substr(at, character.length);
        const std::size_t offset = begin + at;
        at += character.length;
        if (column < first)
            continue;
        if (column >= first + MAX_SHOWN_COLUMNS) {
            shown += "...";
            break;
        }
        shown += is_printable(character) ? std::string(bytes) : "?";
        if (column < place.column) {
            carets += bytes == "\t" ? "\t" : " ";
        } else if (caret_count == 0 || offset < diagnostic.span.end) {
            carets += '^';
            ++caret_count;
        }
    }
    if (caret_count == 0)
        carets += '^';
    return shown + '\n' + carets;
}

} // namespace

void Diagnostics::add(std::string code, Span span, std::string message, std::string note) {
    const Severity severity = code.starts_with('W') ? Severity::warning : Severity::error;
    // Each call has its own copy of its function; one mistake in it is told once.
    std::string key = code + ' ' + std::to_string(span.begin) + ' ' + std::to_string(span.end) + ' ' + message;
    if (m_known.insert(std::move(key)).second)
        m_list.push_back({std::move(code), severity, span, std::move(message), std::move(note)});
}

bool Diagnostics::has_errors() const {
    return std::any_of(m_list.begin(), m_list.end(),
                       [](const Diagnostic& diagnostic) { return diagnostic.severity == Severity::error; });
}

std::vector<Diagnostic> Diagnostics::sorted() const {
    std::vector<Diagnostic> list = m_list;
    std::stable_sort(list.begin(), list.end(), [](const Diagnostic& a, const Diagnostic& b) {
        return a.span.begin != b.span.begin ? a.span.begin < b.span.begin : a.span.end < b.span.end;
    });
    std::size_t errors = 0;
    std::erase_if(list, [&](const Diagnostic& diagnostic) {
        return diagnostic.severity == Severity::error && ++errors > MAX_ERRORS;
    });
    return list;
}

std::string format_diagnostic(const Source& source, const Diagnostic& diagnostic) {
    const Place place = source.find_place(diagnostic.span.begin);
    std::string text = source.name + ':' + std::to_string(place.line) + ':' + std::to_string(place.column) + ": " +
                       (diagnostic.severity == Severity::error ? "error " : "warning ") + diagnostic.code + ": " +
                       diagnostic.message + '\n' + quote_line(source, diagnostic);
    if (!diagnostic.note.empty())
        text += ' ' + diagnostic.note;
    return text + '\n';
}

std::string format_diagnostics(const Source& source, const std::vector<Diagnostic>& diagnostics) {
    std::string text;
    for (const Diagnostic& diagnostic : diagnostics)
        text += format_diagnostic(source, diagnostic);
    return text;
}

ScriptError::ScriptError(const Source& source, std::vector<Diagnostic> diagnostics)
    : Error(format_diagnostics(source, diagnostics)), m_diagnostics(std::move(diagnostics)) {}

} // namespace photonloupe::script
