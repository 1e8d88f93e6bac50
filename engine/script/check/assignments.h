// SPDX-License-Identifier: Apache-2.0
// Everything that gives a variable a value, wherever control goes.
#pragma once

#include <vector>

#include "script/check/draft.h"

namespace photonloupe::script {

struct Assignments {
    std::vector<const Expression*> values; // of plain assignments, and of arguments given to a parameter
    bool is_changed = false;               // += and its like, ++, --
    bool is_exposed = false;               // the run may give it any value
};

// By variable; the pointers live as long as the tree is not rebuilt. Values given to arrays' elements are left out.
std::vector<Assignments> collect_assignments(const Draft& draft);

} // namespace photonloupe::script
