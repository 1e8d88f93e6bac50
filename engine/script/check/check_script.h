// SPDX-License-Identifier: Apache-2.0
// From a script's text to the checked, typed tree.
#pragma once

#include "script/program.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

// Reports everything that is wrong with the script; the program may only be run if `diagnostics` has no errors.
Program check_script(const Source& source, Diagnostics& diagnostics);

} // namespace photonloupe::script
