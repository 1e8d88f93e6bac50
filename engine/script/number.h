// SPDX-License-Identifier: Apache-2.0
// A number of a script while it is computed: 32 bits, real or integer as its expression's type says.
#pragma once

#include <cstdint>
#include <limits>

namespace photonloupe::script {

// One scalar's (or array element's) running value as 32-bit words, as passes and interpreter keep it.
union Number {
    float real;
    std::int32_t integer;
};

inline constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();

inline Number make_real(float value) {
    return {.real = value};
}

inline Number make_integer(std::int32_t value) {
    return {.integer = value};
}

} // namespace photonloupe::script
