// SPDX-License-Identifier: Apache-2.0
// Values that are known when the script is compiled.
#pragma once

#include <optional>

#include "script/check/draft.h"

namespace photonloupe::script {

// The value of an expression of literals, variables with Variable::constant and pure mathematics, exactly as a run
// would compute it (32-bit floats, wrapping integers).
std::optional<double> evaluate_constant(const Program& program, const Expression& expression);

// Finds Variable::constant: all its assignments give it the same value. Never of arrays, lists and exposed variables.
void find_constants(Draft& draft);

} // namespace photonloupe::script
