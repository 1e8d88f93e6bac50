// SPDX-License-Identifier: Apache-2.0
// What a script run gave, as the studio tells it.
#pragma once

#include "script/run/run_script.h"
#include "studio/results.h"

namespace photonloupe::studio {

ScriptResult describe_run(const script::ScriptRun& run, const script::Source& source);

} // namespace photonloupe::studio
