// SPDX-License-Identifier: Apache-2.0
// Finds reads of variables that can't have a value yet, and marks those that may not have one.
#pragma once

#include "script/check/draft.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

// Reports reads that no value reaches on any path; sets Expression::may_be_unset where some path has none. Loops are
// all of the general kind at this time.
void check_assignment(Draft& draft, Diagnostics& diagnostics);

} // namespace photonloupe::script
