// SPDX-License-Identifier: Apache-2.0
// A photon map with its trees and all else that is known of it.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "photons/map_trees.h"
#include "relax/relaxed_state.h"
#include "trace/trace_photons.h"

namespace photonloupe {

struct Photons : IndexedMap {
    TraceReport report;
    Store store = Store::caustic;
    std::optional<Emission> emission;          // none: they came from elsewhere
    std::shared_ptr<const RelaxedState> state; // null: neither constrained nor relaxed
    // Two have the same if they differ in parameters and colors alone.
    std::shared_ptr<const void> identity = std::make_shared<char>();
    std::shared_ptr<const void> made_by, scripted_by; // results of stages, remembered as long as it lives
};

// The same photons in the same memory, for a script to give other parameters and colors.
std::shared_ptr<Photons> share_photons(const Photons& photons);

// Some of the photons, in the order of their ids, with all columns there are.
std::shared_ptr<Photons> select_photons(gpu::Device& device, const Photons& photons,
                                        std::span<const std::uint32_t> ids);

// Where the photons lay before any relaxation, world metres.
std::vector<float> read_traced_positions(const Photons& photons);

} // namespace photonloupe
