// SPDX-License-Identifier: Apache-2.0
// A kd-tree over positions and parameters (METHODS §9): nodes are split along whichever is widest, so that photons of
// other layers, which cross in space, are left out of a walk by their node's range of parameters.
#pragma once

#include "photons/layers.h"

namespace photonloupe {

// The tree over positions, emitters and up to three parameters; its order is that of its own `tree`.
struct LayeredTree {
    KdTree tree;        // boxes are those of the positions
    gpu::Buffer ranges; // two vec4s a node: least and greatest layer number and parameters (by heap index)
};

// The parameters whose ranges the nodes know and a walk can leave nodes out by; those that wrap cannot serve.
std::vector<std::uint32_t> list_range_axes(const PhotonMap& photons, const ParameterTree& parameter_tree);

// The layer number is twice the emitter, plus one where a photon has no parameters.
LayeredTree build_layered_tree(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                               const Progress& progress = {});

} // namespace photonloupe
