// SPDX-License-Identifier: Apache-2.0
// The words of a script: what the lexer hands to the parser.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "script/read/diagnostics.h"
#include "script/read/source.h"

namespace photonloupe::script {

enum class TokenKind : std::uint8_t { end, identifier, keyword, number, text, symbol, unsupported };

struct Token {
    TokenKind kind = TokenKind::end;
    Span span;
    std::string_view spelling; // as written; empty at the end
    bool is_reported = false;  // an unsupported one that the lexer has complained about
    std::string label;         // of a text: without quotes, escapes resolved
    bool is_integer = false;   // of a number: written without point and exponent, and no larger than 2^31
    std::uint32_t integer = 0; // then its value: up to 2^31 in decimal, any 32 bits in hexadecimal
    double value = 0;          // of every number

    bool is(std::string_view word) const {
        return (kind == TokenKind::symbol || kind == TokenKind::keyword) && spelling == word;
    }
};

// The last token is always `end`. Views point into `source.text`. What can't be read is reported and left out.
std::vector<Token> split_tokens(const Source& source, Diagnostics& diagnostics);

} // namespace photonloupe::script
