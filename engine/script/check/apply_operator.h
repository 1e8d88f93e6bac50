// SPDX-License-Identifier: Apache-2.0
// What the operators do to two numbers of one type.
#pragma once

#include "script/number.h"
#include "script/program.h"

namespace photonloupe::script {

bool is_true(Type type, Number value); // not 0; NaN is true, as in C

Number apply_unary(Operator operation, Type type, Number value);

// Arithmetic gives the operands' type (division: reals only), comparisons an integer. Modulo by 0 is 0.
Number apply_operator(Operator operation, Type type, Number a, Number b);

} // namespace photonloupe::script
