// SPDX-License-Identifier: Apache-2.0
// The photon columns that calls read.
#pragma once

#include "script/program.h"

namespace photonloupe::script {

// Of one predefined call: its row of the table, and the position where getPhotonParameter may be asked for dimensions
// 0-2.
std::uint32_t find_columns(const Program& program, const Expression& call);

// Of the whole program.
std::uint32_t find_columns(const Program& program);

} // namespace photonloupe::script
