// SPDX-License-Identifier: Apache-2.0
// Parameters of photons as rows of layer number and parameters, the trees that know them, and how far each photon's
// layer reaches in parameter space (METHODS §4).
#pragma once

#include <span>

#include "photons/gather.h"
#include "photons/photon_map.h"

namespace photonloupe {

// Packs a value per axis and photon and uploads them; a photon with a NaN among them has none at all.
ParameterColumns make_parameters(gpu::Device& device, std::vector<float> values, std::vector<ParameterAxis> axes);

// Throws Error when the map has none.
const ParameterColumns& require_parameters(const PhotonMap& photons);

// A map's parameters for searches.
struct ParameterRows {
    RangeRows rows;      // by photon id: layer number, parameters (0 where a photon has none)
    gpu::Buffer periods; // a vec4 for each of a row's: periods of its axes, 0: it does not wrap
    bool has_periods = false;
    std::vector<std::string> notes; // what makes parameter space useless, with the cure
};

// The number of a photon's layer: emitter + 1, negative where it has no parameters.
float number_layer(std::int32_t emitter, bool is_set);

// Throws Error for parameters whose distances no 32-bit float holds.
ParameterRows make_parameter_rows(gpu::Device& device, const PhotonMap& photons);

// A tree that knows parameters, with what searches in it need.
struct ParameterTree {
    std::shared_ptr<const ParameterRows> parameters;
    KdTree tree;
    float parameter_scale = 0; // metres that a unit of a parameter counts; 0: split along parameters alone
};

// Split along parameters alone: for queries in parameter space.
ParameterTree build_parameter_tree(gpu::Device& device, const PhotonMap& photons,
                                   std::shared_ptr<const ParameterRows> parameters, const Progress& progress = {});
// Split along positions and parameters: for queries in space among the photons of a layer.
ParameterTree build_layered_tree(gpu::Device& device, const PhotonMap& photons,
                                 std::shared_ptr<const ParameterRows> parameters, float parameter_scale,
                                 const Progress& progress = {});

// What is sought in such a tree; layers and intervals are still to be named.
Neighborhood look_in(const KdTree& tree, const ParameterRows& rows, Measure measure);
inline Neighborhood look_in(const ParameterTree& tree, Measure measure) {
    return look_in(tree.tree, *tree.parameters, measure);
}

// The distance r_q of each query to its k-th neighbour in parameter space as radii (x squared, w photons found, their
// own photon among them).
gpu::Buffer find_parameter_radii(gpu::Device& device, const ParameterTree& tree, const Queries& queries,
                                 std::uint32_t k, const Progress& progress = {});

// (β·r_q)² of all photons in the order of `layered`; r_q is inf where fewer than k have parameters.
gpu::Buffer find_layer_reaches(gpu::Device& device, const ParameterTree& by_parameters, const KdTree& layered,
                               std::uint32_t k, float beta, const Progress& progress = {});

// How a layered tree weighs positions and parameters: metres that one unit of parameters is worth, so that whichever
// leaves more of the map out of a search is split first. How far photons of one layer must be sought in space, over how
// far their layer reaches in parameter space; the median over some photons. Layers that reach everywhere make it small,
// and the tree one of positions; narrow ones make it large.
float choose_parameter_scale(gpu::Device& device, const ParameterTree& by_parameters, std::uint32_t k, float beta,
                             const Progress& progress = {});

// The share of photons whose layer reaches over all of parameter space, from their squared reaches.
double measure_boundless_share(const ParameterTree& tree, std::span<const float> reaches2);

} // namespace photonloupe
