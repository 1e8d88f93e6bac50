// SPDX-License-Identifier: Apache-2.0
// What a constraint and a relaxation know of each photon, as the host's columns.
#pragma once

#include <vector>

namespace photonloupe {

// By photon id; columns that were not measured are empty.
struct RelaxedState {
    std::vector<float> traced;        // 3 a photon: where it was before any relaxation, world metres
    std::vector<float> drift;         // 3: metres since the constraint was measured
    std::vector<float> pressure;      // |f'|/r of the last step
    std::vector<float> basis;         // 6: u_b, v_b
    std::vector<float> weights;       // 2: w_u, w_v
    std::vector<float> gradient;      // 3: ∇f/f in 1/m
    std::vector<float> one_sidedness; // c_m
};

} // namespace photonloupe
