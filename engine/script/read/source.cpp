// SPDX-License-Identifier: Apache-2.0
// Finds lines and columns in a script's text, whatever its line breaks and whether or not it is UTF-8.
#include "script/read/source.h"

#include <algorithm>

#include "script/read/utf8.h"

namespace photonloupe::script {
namespace {

// "\n", "\r\n" and a lone "\r" each end a line; the offset after the break, or `at` if there is none here.
std::size_t skip_line_break(std::string_view text, std::size_t at) {
    if (text[at] == '\n')
        return at + 1;
    if (text[at] == '\r')
        return at + 1 < text.size() && text[at + 1] == '\n' ? at + 2 : at + 1;
    return at;
}

} // namespace

Place Source::find_place(std::uint32_t offset) const {
    const std::size_t end = std::min<std::size_t>(offset, text.size());
    Place place;
    std::size_t line_begin = 0;
    for (std::size_t at = 0; at < end;) {
        const std::size_t next = skip_line_break(text, at);
        if (next == at) {
            ++at;
        } else if (next > end) {
            break; // between the two bytes of one break
        } else {
            ++place.line;
            line_begin = at = next;
        }
    }
    for (std::size_t at = line_begin; at < end; ++place.column) {
        at += decode_utf8(text, at).length;
        if (at > end)
            break; // inside a character
    }
    return place;
}

std::string_view Source::line_text(std::uint32_t line) const {
    const std::string_view whole = text;
    std::uint32_t current = 1;
    std::size_t begin = 0;
    for (std::size_t at = 0; at < whole.size();) {
        const std::size_t next = skip_line_break(whole, at);
        if (next == at) {
            ++at;
            continue;
        }
        if (current == line)
            return whole.substr(begin, at - begin);
        ++current;
        begin = at = next;
    }
    return current == line ? whole.substr(begin) : std::string_view();
}

} // namespace photonloupe::script
