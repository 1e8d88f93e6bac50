// SPDX-License-Identifier: Apache-2.0
// "did you mean …": the known name nearest to one that is not.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace photonloupe::script {

// A name that differs by case alone wins; else the one fewest edits away, if that is not farther than a third of the
// name. Empty: nothing is near.
std::string suggest_name(std::string_view written, const std::vector<std::string_view>& known);

} // namespace photonloupe::script
