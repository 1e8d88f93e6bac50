// SPDX-License-Identifier: Apache-2.0
// Reads numbers without the locale's help.
#include "script/read/read_number.h"

#include <charconv>
#include <cmath>
#include <system_error>

namespace photonloupe::script {
namespace {

constexpr std::uint64_t LARGEST_DECIMAL = 0x80000000u; // 2^31: "-2147483648" is an integer

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

bool is_word_character(char c) {
    return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
}

std::size_t skip_digits(std::string_view text, std::size_t at) {
    while (at < text.size() && is_digit(text[at]))
        ++at;
    return at;
}

std::size_t skip_word(std::string_view text, std::size_t at) {
    while (at < text.size() && is_word_character(text[at]))
        ++at;
    return at;
}

NumberReading read_hexadecimal(std::string_view text) {
    NumberReading reading;
    reading.length = skip_word(text, 2);
    const char* const end = text.data() + reading.length;
    std::uint64_t integer = 0;
    const auto [stop, error] = std::from_chars(text.data() + 2, end, integer, 16);
    if (stop != end || reading.length == 2)
        reading.problem = "a hexadecimal number is 0x and digits 0-9, a-f";
    else if (error != std::errc() || integer > 0xFFFFFFFFu)
        reading.problem = "this number has more than 32 bits";
    else
        reading.integer = std::uint32_t(integer);
    reading.is_integer = true;
    reading.value = std::int32_t(reading.integer);
    return reading;
}

// Too small for a float is 0, too large is infinite.
double round_to_float(std::string_view digits) {
    double wide = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), wide).ec == std::errc::result_out_of_range) {
        const std::size_t exponent = digits.find_first_of("eE");
        const bool is_small = exponent != std::string_view::npos ? digits.substr(exponent + 1).starts_with('-')
                                                                 : digits.starts_with('0') || digits.starts_with('.');
        return is_small ? 0.0 : HUGE_VAL;
    }
    float narrow = 0;
    if (std::from_chars(digits.data(), digits.data() + digits.size(), narrow).ec == std::errc::result_out_of_range)
        return wide > 1 ? HUGE_VAL : double(float(wide));
    return double(narrow);
}

} // namespace

NumberReading read_number(std::string_view text) {
    if (text.size() > 1 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X'))
        return read_hexadecimal(text);
    NumberReading reading;
    std::size_t at = skip_digits(text, 0);
    const std::size_t whole = at;
    if (at < text.size() && text[at] == '.')
        at = skip_digits(text, at + 1);
    if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
        const std::size_t sign = at + 1 < text.size() && (text[at + 1] == '+' || text[at + 1] == '-') ? 2 : 1;
        const std::size_t end = skip_digits(text, at + sign);
        if (end > at + sign)
            at = end;
    }
    const std::string_view digits = text.substr(0, at);
    reading.length = skip_word(text, at);
    if (reading.length > at)
        reading.problem = "a number can't run into letters";
    std::uint64_t integer = 0;
    const bool fits = std::from_chars(digits.data(), digits.data() + at, integer).ec == std::errc();
    reading.is_integer = at == whole && fits && integer <= LARGEST_DECIMAL;
    if (reading.is_integer) {
        reading.integer = std::uint32_t(integer);
        reading.value = double(integer);
        return reading;
    }
    reading.value = round_to_float(digits);
    if (std::isinf(reading.value)) {
        reading.problem = "no 32-bit float is this large";
        reading.value = 0;
    }
    return reading;
}

} // namespace photonloupe::script
