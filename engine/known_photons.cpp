// SPDX-License-Identifier: Apache-2.0
// Copies of maps that share memory, and parts of maps.
#include "known_photons.h"

#include "photons/map_columns.h"
#include "photons/select_photons.h"

namespace photonloupe {

std::shared_ptr<Photons> share_photons(const Photons& photons) {
    const std::lock_guard lock(*photons.mutex);
    auto shared = std::make_shared<Photons>();
    shared->map = share_map(photons.map);
    shared->report = photons.report;
    shared->store = photons.store;
    shared->emission = photons.emission;
    shared->state = photons.state;
    shared->trees = photons.trees;
    shared->identity = photons.identity;
    shared->made_by = photons.made_by;
    shared->scripted_by = photons.scripted_by;
    return shared;
}

std::shared_ptr<Photons> select_photons(gpu::Device& device, const Photons& photons,
                                        std::span<const std::uint32_t> ids) {
    const std::lock_guard lock(*photons.mutex);
    auto some = std::make_shared<Photons>();
    some->map = select_photons(device, photons.map, ids);
    some->report = photons.report;
    some->store = photons.store;
    some->emission = photons.emission;
    if (!photons.state)
        return some;
    RelaxedState state;
    for (const auto field : {&RelaxedState::traced, &RelaxedState::drift, &RelaxedState::pressure, &RelaxedState::basis,
                             &RelaxedState::weights, &RelaxedState::gradient, &RelaxedState::one_sidedness})
        state.*field = select_rows(*photons.state.*field, photons.map.count, ids);
    some->state = std::make_shared<const RelaxedState>(std::move(state));
    return some;
}

std::vector<float> read_traced_positions(const Photons& photons) {
    return photons.state && !photons.state->traced.empty() ? photons.state->traced : read_positions(photons.map);
}

} // namespace photonloupe
