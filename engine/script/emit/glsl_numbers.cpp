// SPDX-License-Identifier: Apache-2.0
// Writes numbers as GLSL literals.
#include "script/emit/glsl_numbers.h"

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>

namespace photonloupe::script {
namespace {

std::string write_real(float value) {
    if (!std::isfinite(value) || (value != 0 && std::abs(value) < std::numeric_limits<float>::min())) {
        char text[16];
        const auto end = std::to_chars(text, text + sizeof text, std::bit_cast<std::uint32_t>(value), 16).ptr;
        return "uintBitsToFloat(0x" + std::string(text, end) + "u)";
    }
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    std::string literal(text, end);
    if (literal.find_first_of(".e") == std::string::npos)
        literal += ".0";
    return literal;
}

std::string write_integer(std::int32_t value) {
    return value == std::numeric_limits<std::int32_t>::min() ? "int(0x80000000u)" : std::to_string(value);
}

} // namespace

std::string write_number(Type type, double value) {
    return type == Type::integer ? write_integer(std::int32_t(value)) : write_real(float(value));
}

std::string name_type(Type type) {
    return type == Type::none ? "void" : type == Type::integer ? "int" : type == Type::list ? "ivec2" : "float";
}

std::string write_nothing(Type type) {
    return type == Type::integer ? "0" : type == Type::list ? "ivec2(0)" : "NAN";
}

} // namespace photonloupe::script
