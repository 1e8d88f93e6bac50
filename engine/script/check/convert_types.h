// SPDX-License-Identifier: Apache-2.0
// Gives every expression its type and inserts the conversions from integer to real.
#pragma once

#include "script/check/draft.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

// After infer_types. Reals given to what the script declares as integer are refused.
//
// Afterwards: the operands of arithmetic and comparisons have one type; pure mathematics take reals, or integers where
// the call's type is integer; int, floor, ceil and round of an integer are that integer itself; photons, vertices,
// axes, dimensions, counts, indices and printed values keep the type they have.
void convert_types(Draft& draft, Diagnostics& diagnostics);

} // namespace photonloupe::script
