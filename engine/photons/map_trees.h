// SPDX-License-Identifier: Apache-2.0
// A photon map with the trees that queries need of it: built when first asked for and then kept.
#pragma once

#include <mutex>

#include "photons/layers.h"

namespace photonloupe {

// How far layers reach: β times the distance to the k-th neighbour in parameter space.
struct LayerReach {
    std::uint32_t k = 50;
    float beta = 3.0f;
    bool operator==(const LayerReach&) const = default;
};

struct MapTrees {
    std::shared_ptr<const KdTree> positions;
    std::shared_ptr<const ParameterRows> rows; // relaxations keep them
    std::shared_ptr<const ParameterTree> parameters;
    std::shared_ptr<const ParameterTree> layered;
    LayerReach layered_for; // what it was built to suit
};

// Any number of threads may ask at the same time; who changes the columns is alone with it.
struct IndexedMap {
    PhotonMap map;
    MapTrees trees;
    std::unique_ptr<std::recursive_mutex> mutex = std::make_unique<std::recursive_mutex>(); // of the trees
};

std::shared_ptr<const KdTree> find_tree(gpu::Device& device, IndexedMap& photons, const Progress& progress = {});
// Of parameters alone.
std::shared_ptr<const ParameterTree> find_parameter_tree(gpu::Device& device, IndexedMap& photons,
                                                         const Progress& progress = {});
// Of positions and parameters: one built before, whatever it suits best, or where `reach` is given one that suits it.
std::shared_ptr<const ParameterTree> find_layered_tree(gpu::Device& device, IndexedMap& photons,
                                                       const Progress& progress = {},
                                                       std::optional<LayerReach> reach = {});
// All that views ask for, ahead.
void build_view_trees(gpu::Device& device, IndexedMap& photons, const Progress& progress = {});

bool has_tree(const IndexedMap& photons);

// Replaces the parameters, whose trees go; the caller holds the mutex.
void take_parameters(IndexedMap& photons, std::optional<ParameterColumns> parameters);

// Values of all photons, a row each; without axes it has none any more.
void set_parameters(gpu::Device& device, IndexedMap& photons, std::vector<float> values,
                    std::vector<ParameterAxis> axes);

} // namespace photonloupe
