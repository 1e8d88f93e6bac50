// SPDX-License-Identifier: Apache-2.0
// The files of shaders/script/ that passes include where they need them, in order.
#pragma once

#include <span>
#include <string_view>

namespace photonloupe::script {

struct PassLibrary {
    std::string_view name;
    std::string_view binding; // declared by the file; empty: none
};
std::span<const PassLibrary> list_pass_libraries();

} // namespace photonloupe::script
