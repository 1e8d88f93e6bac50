// SPDX-License-Identifier: Apache-2.0
// Rewrites an expression of a loop's body in terms that hold outside of it.
#pragma once

#include "script/plan/plan.h"

namespace photonloupe::script {

// Functions' parameters are replaced by what they are given, constants by their numbers.
Expression substitute_given(const Program& program, const PhotonLoop& loop, const Expression& expression);

} // namespace photonloupe::script
