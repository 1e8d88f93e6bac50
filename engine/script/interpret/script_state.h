// SPDX-License-Identifier: Apache-2.0
// What a script has computed so far: passes take their uniform values from it and bring reductions back.
#pragma once

#include <vector>

#include "script/interpret/reductions.h"

namespace photonloupe::script {

// A variable's content: one number, or an array's; lists of neighbours hold ids.
struct VariableState {
    std::vector<Number> numbers;
    std::vector<std::int32_t> list;
    bool is_set = false;
};

struct ScriptState {
    std::vector<VariableState> variables; // of Program::variables
    Moments pca_2d, pca_3d;
    Decomposition decomposition;
};

} // namespace photonloupe::script
