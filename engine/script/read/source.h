// SPDX-License-Identifier: Apache-2.0
// The text of a script and places in it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace photonloupe::script {

// Bytes [begin, end) of the source.
struct Span {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

// Line and column as editors count them, from 1; columns count code points (a tab is one).
struct Place {
    std::uint32_t line = 1;
    std::uint32_t column = 1;
};

struct Source {
    std::string name; // what messages call it: the file's name, or "script"
    std::string text;

    Place find_place(std::uint32_t offset) const;
    std::string_view line_text(std::uint32_t line) const; // without its line break
};

} // namespace photonloupe::script
