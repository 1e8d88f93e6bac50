// SPDX-License-Identifier: Apache-2.0
// Finds the loops whose turns have a provable bound; all others need fuel.
#pragma once

#include "script/check/draft.h"

namespace photonloupe::script {

// Sets Statement::is_bounded: the loop counts from a bounded start to a bounded limit (constants, path vertices,
// neighbor counts, variables that hold such) by a constant step, its variable is assigned nowhere else, and together
// with the loops around it, all of them bounded too, it makes at most MAX_BOUNDED_TURNS turns.
void bound_loops(Draft& draft);

constexpr double MAX_BOUNDED_TURNS = 1e6;

} // namespace photonloupe::script
