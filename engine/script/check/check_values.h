// SPDX-License-Identifier: Apache-2.0
// Checks what is known about arguments and indices when the script is compiled.
#pragma once

#include "script/check/draft.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

// Constant indices, photons, vertices, axes, channels, dimensions and counts: whole numbers within their bounds.
void check_values(const Draft& draft, Diagnostics& diagnostics);

// Gives arrays their sizes (Variable::array_size) and refuses those that are too large.
void resolve_array_sizes(Draft& draft, Diagnostics& diagnostics);

// After find_photon_loops: the arrays that one photon loop declares.
void check_photon_arrays(const Draft& draft, Diagnostics& diagnostics);

// Neighbor counts, beta and histogram bounds inside photon loops are the same for all photons. They are rewritten to be
// evaluated before the loop: constants and functions' parameters are replaced by what they stand for.
void check_uniform_arguments(Draft& draft, Diagnostics& diagnostics);

// Exposed variables have a default in their range: Variable::default_value.
void check_exposed(Draft& draft, Diagnostics& diagnostics);

// Parameters are declared in dimensions 3, 4, 5 … and set only where they are declared.
void check_parameters(const Draft& draft, Diagnostics& diagnostics);

} // namespace photonloupe::script
