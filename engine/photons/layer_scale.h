// SPDX-License-Identifier: Apache-2.0
// How a tree over positions and parameters weighs the two: whichever leaves more of the map out of a search in layers
// should be split first.
#pragma once

#include "photons/layers.h"

namespace photonloupe {

// Metres that one unit of parameters is worth: how far photons of one layer must be sought in space, over how far their
// layer reaches in parameter space; the median over some photons. Layers that reach everywhere make it small, and the
// tree one of positions; narrow ones make it large.
float choose_parameter_scale(gpu::Device& device, const ParameterTree& by_parameters, std::uint32_t k, float beta,
                             const Progress& progress = {});

} // namespace photonloupe
