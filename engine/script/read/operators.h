// SPDX-License-Identifier: Apache-2.0
// The operators, as they are read and as the checked script has them.
#pragma once

#include <cstdint>

namespace photonloupe::script {

enum class Operator : std::uint8_t {
    none,
    negate,
    logical_not,
    add,
    subtract,
    multiply,
    divide,
    modulo,
    equal,
    not_equal,
    less,
    less_equal,
    greater,
    greater_equal,
    logical_and,
    logical_or,
};

} // namespace photonloupe::script
