// SPDX-License-Identifier: Apache-2.0
// A photon map with all that is known of it, and the trees that queries need of it.
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "photons/layers.h"
#include "relax/relaxed_state.h"
#include "trace/trace_photons.h"

namespace photonloupe {

// How far layers reach: β times the distance to the k-th neighbour in parameter space.
struct LayerReach {
    std::uint32_t k = 50;
    float beta = 3.0f;
    bool operator==(const LayerReach&) const = default;
};

// Built when first asked for and then kept, by whichever thread asks first.
struct MapTrees {
    std::shared_ptr<const KdTree> positions;
    std::shared_ptr<const ParameterRows> rows; // relaxations keep them
    std::shared_ptr<const ParameterTree> parameters;
    std::shared_ptr<const ParameterTree> layered;
    LayerReach layered_for; // what it was built to suit
};

// Any number of threads may ask at the same time; who changes the columns is alone with it.
struct Photons {
    PhotonMap map;
    TraceReport report;
    Store store = Store::caustic;
    std::shared_ptr<const RelaxedState> state; // null: neither constrained nor relaxed
    MapTrees trees;
    // Two have the same if they differ in parameters and colors alone.
    std::shared_ptr<const void> identity = std::make_shared<char>();
    std::shared_ptr<const void> made_by, scripted_by; // results of stages, remembered as long as it lives
    std::unique_ptr<std::recursive_mutex> mutex = std::make_unique<std::recursive_mutex>(); // of the trees
};

// The same photons in the same memory, for a script to give other parameters and colors.
std::shared_ptr<Photons> share_photons(const Photons& photons);

// Some of the photons, in the order of their ids, with all columns there are.
std::shared_ptr<Photons> select_photons(gpu::Device& device, const Photons& photons,
                                        std::span<const std::uint32_t> ids);

// Replaces the parameters, whose trees go; the caller holds the photons' mutex.
void take_parameters(Photons& photons, std::optional<ParameterColumns> parameters);

// Values of all photons, a row each; without axes it has none any more.
void set_parameters(gpu::Device& device, Photons& photons, std::vector<float> values, std::vector<ParameterAxis> axes);

// Where the photons lay before any relaxation, world metres.
std::vector<float> read_traced_positions(const Photons& photons);

} // namespace photonloupe
