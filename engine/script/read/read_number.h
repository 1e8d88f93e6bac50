// SPDX-License-Identifier: Apache-2.0
// Reads the numbers of a script: decimal, hexadecimal, with point or exponent.
#pragma once

#include <cstdint>
#include <string_view>

namespace photonloupe::script {

struct NumberReading {
    std::size_t length = 1;  // characters taken, letters that run into the number included
    bool is_integer = false; // decimal up to 2^31 (which only a minus makes fit) or hexadecimal of 32 bits
    std::uint32_t integer = 0;
    double value = 0;         // rounded once, to the nearest 32-bit float
    std::string_view problem; // empty: none
};

// `text` begins with a digit, or with a point and a digit. A decimal integer past 2^31 is a real number.
NumberReading read_number(std::string_view text);

} // namespace photonloupe::script
