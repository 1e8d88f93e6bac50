// SPDX-License-Identifier: Apache-2.0
// How isotropic world space is around photons that are near in parameter space ([SJL15] section 5.2).
#pragma once

#include "photons/layers.h"

namespace photonloupe {

// Axis ratio t = √(λ₂/λ₁) of the world positions, in the tangent plane, of each photon's k neighbours in parameter
// space (eq. 5), by photon id. NaN where a photon has no parameters, fewer than two neighbours there, or all its
// neighbours share its place in either space.
std::vector<float> measure_isotropy(gpu::Device& device, const ParameterTree& tree, std::uint32_t k,
                                    const Progress& progress = {});

} // namespace photonloupe
