// SPDX-License-Identifier: Apache-2.0
// A number of a script while it is computed: 32 bits, real or integer as its expression's type says.
#pragma once

#include <cstdint>

namespace photonloupe::script {

// One scalar's (or array element's) running value as 32-bit words, as passes and interpreter keep it.
union Number {
    float real;
    std::int32_t integer;
};

inline Number make_real(float value) {
    Number number;
    number.real = value;
    return number;
}

inline Number make_integer(std::int32_t value) {
    Number number;
    number.integer = value;
    return number;
}

} // namespace photonloupe::script
