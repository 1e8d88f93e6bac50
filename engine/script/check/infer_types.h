// SPDX-License-Identifier: Apache-2.0
// Decides which variables are integers: those that everything assigned to is one. Whole program, to a fixed point.
#pragma once

#include "script/check/draft.h"

namespace photonloupe::script {

// Sets Variable::type of every scalar and array, and Function::result of every function that returns a value.
void infer_types(Draft& draft);

// pow's result is an integer when its base is and its exponent is a whole number from 0 on written in the script
// (unless both are written and the power has more than 32 bits).
bool is_integer_power(const Expression& call, bool is_integer_base);

} // namespace photonloupe::script
