// SPDX-License-Identifier: Apache-2.0
// Shortest round-trip formatting.
#include "script/check/format_number.h"

#include <charconv>
#include <cmath>

namespace photonloupe::script {

std::string format_number(double value) {
    if (std::isnan(value))
        return "NaN";
    if (std::isinf(value))
        return value > 0 ? "inf" : "-inf";
    char digits[64];
    const bool is_whole = value == std::floor(value) && std::fabs(value) < 1e15;
    const auto result = is_whole && (value != 0 || !std::signbit(value))
                            ? std::to_chars(digits, digits + sizeof digits, (long long)(value))
                            : std::to_chars(digits, digits + sizeof digits, float(value));
    return std::string(digits, result.ptr);
}

} // namespace photonloupe::script
