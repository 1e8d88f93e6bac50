// SPDX-License-Identifier: Apache-2.0
// Evens out unequal fluxes of photons while they are relaxed (METHODS §3).
#pragma once

#include "photons/gather.h"

namespace photonloupe {

// Replaces the fluxes (rgb, tree order) by weighted means over the photons within `radii`, and scales each
// channel so that its total stays. Returns by how much the total had drifted, relative, the largest of the channels.
double diffuse_flux(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                    const gpu::Buffer& radii, gpu::Buffer& power, const Progress& progress);

} // namespace photonloupe
