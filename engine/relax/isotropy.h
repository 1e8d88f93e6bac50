// SPDX-License-Identifier: Apache-2.0
// How isotropic world space is around photons that are near in parameter space ([SJL15] section 5.2).
#pragma once

#include "photons/map_trees.h"

namespace photonloupe {

// Axis ratio t = √(λ₂/λ₁) of the world positions, in the tangent plane, of each photon's k neighbours in parameter
// space (eq. 5), by photon id. NaN where a photon has no parameters, fewer than two neighbours there, or all its
// neighbours share its place in either space.
std::vector<float> measure_isotropy(gpu::Device& device, const ParameterTree& tree, std::uint32_t k,
                                    const Progress& progress = {});

inline constexpr std::uint32_t BETA_NEIGHBORS = 100; // where nothing is said
inline constexpr double CLIPPED_SHARE = 0.05;

// β that cuts the neighbourhoods of only a share of the photons ([SJL15] section 5.2, eqs. 5, 6).
struct OptimalBeta {
    std::vector<float> isotropy; // axis ratios, as above
    double threshold = 0;        // t_β: what all but that share exceed
    double beta = 0;             // √(1/t_β)
};

// Empty where no photon has an axis ratio: every β gives the same layers. Throws ArgumentError where the map has no
// parameters, or none is large enough.
std::optional<OptimalBeta> find_optimal_beta(gpu::Device& device, IndexedMap& photons, std::uint32_t k, double clip,
                                             const Progress& progress = {});

// Why it is empty, and what to do.
std::string explain_no_ratio(const PhotonMap& photons);

} // namespace photonloupe
