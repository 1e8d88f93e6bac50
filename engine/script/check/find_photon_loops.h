// SPDX-License-Identifier: Apache-2.0
// Recognizes the loops that run a variable over all photons.
#pragma once

#include "script/check/draft.h"
#include "script/read/diagnostics.h"

namespace photonloupe::script {

// Finds Variable::holds_photon_count, then turns `for (i = 0; i < getNumPhotons(); i++)` and its variants into photon
// loops, unless they stand inside another (then they stay ordinary loops). Reports declarePhotonParameter inside one.
void find_photon_loops(Draft& draft, Diagnostics& diagnostics);

} // namespace photonloupe::script
