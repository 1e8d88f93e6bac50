// SPDX-License-Identifier: Apache-2.0
// Finds the variables that assignments declare: script-wide at top level, local in a function.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "script/read/syntax.h"

namespace photonloupe::script {

struct AssignedName {
    std::string name;
    Span span;            // of its first assignment
    bool is_list = false; // a query's result is assigned to it
};

// Every assigned name that no block around the assignment declares, in source order, each once. `declared`: names that
// are declared around it all (a function's parameters).
std::vector<AssignedName> collect_assigned_names(const std::vector<SyntaxStatement>& statements,
                                                 const std::set<std::string>& declared);

// What `float x;` and the like declare in the outermost block, with the place.
std::vector<AssignedName> collect_declared_names(const std::vector<SyntaxStatement>& statements);

} // namespace photonloupe::script
