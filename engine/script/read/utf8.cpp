// SPDX-License-Identifier: Apache-2.0
// Decodes UTF-8, one checked character at a time.
#include "script/read/utf8.h"

namespace photonloupe::script {

Utf8Character decode_utf8(std::string_view text, std::size_t at) {
    const auto byte_at = [&](std::size_t place) { return std::uint32_t(static_cast<unsigned char>(text[place])); };
    const std::uint32_t lead = byte_at(at);
    if (lead < 0x80u)
        return {lead, 1, true};
    const std::uint32_t length = lead >= 0xF0u ? 4 : lead >= 0xE0u ? 3 : 2;
    if (lead < 0xC2u || lead > 0xF4u || text.size() - at < length)
        return {lead, 1, false};
    std::uint32_t code_point = lead & (0xFFu >> (length + 1));
    for (std::uint32_t i = 1; i < length; ++i) {
        const std::uint32_t byte = byte_at(at + i);
        if ((byte & 0xC0u) != 0x80u)
            return {lead, 1, false};
        code_point = code_point << 6 | (byte & 0x3Fu);
    }
    const std::uint32_t least = length == 2 ? 0x80u : length == 3 ? 0x800u : 0x10000u;
    if (code_point < least || code_point > 0x10FFFFu || (code_point >= 0xD800u && code_point <= 0xDFFFu))
        return {lead, 1, false};
    return {code_point, length, true};
}

bool is_printable(const Utf8Character& character) {
    const std::uint32_t code = character.code_point;
    const bool is_control = (code < 0x20u && code != '\t') || (code >= 0x7Fu && code < 0xA0u);
    const bool is_direction = (code >= 0x200Eu && code <= 0x200Fu) || (code >= 0x202Au && code <= 0x202Eu) ||
                              (code >= 0x2066u && code <= 0x2069u);
    return character.is_valid && !is_control && !is_direction && code != 0x2028u && code != 0x2029u;
}

} // namespace photonloupe::script
