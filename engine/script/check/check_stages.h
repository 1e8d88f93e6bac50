// SPDX-License-Identifier: Apache-2.0
// What check_script runs once there is a tree, stage after stage.
#pragma once

#include "script/check/draft.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

// Sets Variable::type of every scalar and array, and Function::result of every function that returns a value: integer
// where everything assigned is one.
void infer_types(Draft& draft);

// pow's result is an integer when its base is and its exponent is a whole number from 0 on written in the script
// (unless both are written and the power has more than 32 bits).
bool is_integer_power(const Expression& call, bool is_integer_base);

// After infer_types: gives every expression its type. Reals given to what the script declares as integer are refused.
//
// Afterwards: the operands of arithmetic and comparisons have one type; pure mathematics take reals, or integers where
// the call's type is integer; int, floor, ceil and round of an integer are that integer itself; photons, vertices,
// axes, dimensions, counts, indices and printed values keep the type they have.
void convert_types(Draft& draft, Diagnostics& diagnostics);

// Gives arrays their sizes (Variable::array_size) and refuses those that are too large.
void resolve_array_sizes(Draft& draft, Diagnostics& diagnostics);

// Reports reads that no value reaches on any path; sets Expression::may_be_unset where some path has none. Loops are
// all of the general kind at this time.
void check_assignment(Draft& draft, Diagnostics& diagnostics);

// Finds Variable::holds_photon_count, then turns `for (i = 0; i < getNumPhotons(); i++)` and its variants into photon
// loops, unless they stand inside another (then they stay ordinary loops). Reports declarePhotonParameter inside one.
void find_photon_loops(Draft& draft, Diagnostics& diagnostics);

// Sets Statement::is_bounded: the loop counts from a bounded start to a bounded limit (constants, path vertices,
// neighbor counts, variables that hold such) by a constant step, its variable is assigned nowhere else, and together
// with the loops around it, all of them bounded too, it makes at most MAX_BOUNDED_TURNS turns. All others need fuel.
void bound_loops(Draft& draft);

constexpr double MAX_BOUNDED_TURNS = 1e6;

// Constant indices, photons, vertices, axes, channels, dimensions and counts: whole numbers within their bounds.
void check_values(const Draft& draft, Diagnostics& diagnostics);

// Neighbor counts, beta and histogram bounds inside photon loops are the same for all photons. They are rewritten to be
// evaluated before the loop: constants and functions' parameters are replaced by what they stand for.
void check_uniform_arguments(Draft& draft, Diagnostics& diagnostics);

// The arrays that one photon loop declares.
void check_photon_arrays(const Draft& draft, Diagnostics& diagnostics);

// Exposed variables have a default in their range: Variable::default_value.
void check_exposed(Draft& draft, Diagnostics& diagnostics);

// Parameters are declared in dimensions 3, 4, 5 … and set only where they are declared.
void check_parameters(const Draft& draft, Diagnostics& diagnostics);

// The photon columns that one predefined call reads: its row of the table, and the position where getPhotonParameter
// may be asked for dimensions 0-2. And those of the whole program.
std::uint32_t find_columns(const Program& program, const Expression& call);
std::uint32_t find_columns(const Program& program);

} // namespace photonloupe::script
