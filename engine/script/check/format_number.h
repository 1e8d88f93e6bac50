// SPDX-License-Identifier: Apache-2.0
// Numbers as messages and printed lines show them.
#pragma once

#include <string>

namespace photonloupe::script {

// The fewest digits that read back as the same 32-bit float (or integer); never with a locale's comma.
std::string format_number(double value);

} // namespace photonloupe::script
