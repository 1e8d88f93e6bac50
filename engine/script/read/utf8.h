// SPDX-License-Identifier: Apache-2.0
// Steps through text that should be UTF-8 and may be anything.
#pragma once

#include <cstdint>
#include <string_view>

namespace photonloupe::script {

struct Utf8Character {
    std::uint32_t code_point = 0;
    std::uint32_t length = 1; // bytes; 1 for a byte that begins no valid character
    bool is_valid = false;
};

// The character at `at` (< text.size()): overlong forms, surrogates and values past U+10FFFF are not valid.
Utf8Character decode_utf8(std::string_view text, std::size_t at);

// Not a control character (a tab is fine), not a mark that turns the direction of writing, not a bad byte.
bool is_printable(const Utf8Character& character);

} // namespace photonloupe::script
