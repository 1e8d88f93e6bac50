// SPDX-License-Identifier: Apache-2.0
// Which way each photon may move: descriptors of its neighbourhood, measured once (METHODS §5).
#pragma once

#include "photons/layers.h"
#include "relax/settings.h"

namespace photonloupe {

// In tree order.
struct Constraint {
    gpu::Buffer along;        // u_b, w_u
    gpu::Buffer across;       // v_b, w_v
    gpu::Buffer offsets;      // xyz g = m/r, w neighbours used
    gpu::Buffer member_radii; // x r², y weight at r, z one-sidedness, w axis ratio t
};

// Measures the descriptor for every photon of the neighborhood's tree, by complete settings. `radii` gets the radii
// found.
Constraint measure_constraint(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                              const RelaxSettings& settings, const gpu::Buffer& radii, const Progress& progress);

} // namespace photonloupe
