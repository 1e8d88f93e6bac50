// SPDX-License-Identifier: Apache-2.0
// Parameters of photons in tree order, and how far each photon's layer reaches in parameter space (METHODS §4).
#pragma once

#include <span>

#include "photons/gather.h"
#include "photons/photon_map.h"

namespace photonloupe {

// A tree over the three widest parameters, for exact queries in the space of all of them.
struct ParameterTree {
    KdTree tree;                     // `positions` holds the widest parameters, `normals.w` the emitter
    GatherShape shape;               // its period is that of those axes
    gpu::Buffer parameters;          // in the tree's order
    gpu::Buffer periods;             // a float per parameter, 0: it does not wrap
    std::vector<std::uint32_t> axes; // the parameters that the tree's axes are
    float limit2 = 0;                // beyond every squared distance
};

// The photons of a tree as kernels gather them.
struct Layers {
    gpu::Buffer parameters;              // vec4 rows; empty without parameters
    gpu::Buffer reach2;                  // (β·r_q)²
    gpu::Buffer periods;                 // as in ParameterTree
    const gpu::Buffer* ranges = nullptr; // of the nodes of a layered tree
};

// Packs a value per axis and photon and uploads them; a photon with a NaN among them has none at all.
ParameterColumns make_parameters(gpu::Device& device, std::span<const float> values, std::vector<ParameterAxis> axes);

// Squared distance of packed rows, in the kernels' order of operations; NaN where either photon has none.
float measure_parameters(std::uint32_t count, std::span<const float> periods, std::span<const glm::vec4> a,
                         std::span<const glm::vec4> b);

// Throws Error when the map has none.
const ParameterColumns& require_parameters(const PhotonMap& photons);

ParameterTree build_parameter_tree(gpu::Device& device, const PhotonMap& photons, const Progress& progress = {});

// Makes kernels of that shape look at the map's parameters.
void add_parameters(GatherShape& shape, const PhotonMap& photons);

// Squared r_q(i), the distance to the k-th neighbour in parameter space, by photon id; inf where there are fewer.
gpu::Buffer find_parameter_radii2(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::uint32_t k, const Progress& progress = {});

// Parameters in the order of a tree, and (β·r_q)² from squared r_q by id (empty: not wanted).
Layers order_parameters(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const gpu::Buffer& radii2,
                        float beta, const Progress& progress = {});

// Both together: the layers of the photons of `tree`, reaching β times the distance to the k-th neighbour.
Layers find_layers(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                   const KdTree& tree, std::uint32_t k, float beta, const Progress& progress = {});

} // namespace photonloupe
