// SPDX-License-Identifier: Apache-2.0
// The script's functions by name, and the refusal of recursion: functions are inlined.
#pragma once

#include <map>
#include <string>

#include "script/read/diagnostics.h"
#include "script/read/syntax.h"

namespace photonloupe::script {

using FunctionTable = std::map<std::string, const SyntaxFunction*>;

// Reports names defined twice or taken by the language.
FunctionTable build_function_table(const SyntaxScript& script, Diagnostics& diagnostics);

// Reports every cycle of calls at the call that closes it. False: there is one.
bool check_recursion(const FunctionTable& table, Diagnostics& diagnostics);

} // namespace photonloupe::script
