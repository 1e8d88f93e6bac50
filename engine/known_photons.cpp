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
    if (!photons.state)
        return some;
    RelaxedState state;
    for (const auto field : {&RelaxedState::traced, &RelaxedState::drift, &RelaxedState::pressure, &RelaxedState::basis,
                             &RelaxedState::weights, &RelaxedState::gradient, &RelaxedState::one_sidedness})
        state.*field = select_rows(*photons.state.*field, photons.map.count, ids);
    some->state = std::make_shared<const RelaxedState>(std::move(state));
    return some;
}

void take_parameters(Photons& photons, std::optional<ParameterColumns> parameters) {
    photons.trees = {photons.trees.positions, {}, {}, {}, {}};
    photons.map.parameters = std::move(parameters);
}

void set_parameters(gpu::Device& device, Photons& photons, std::vector<float> values, std::vector<ParameterAxis> axes) {
    std::optional<ParameterColumns> parameters;
    if (!axes.empty())
        parameters = make_parameters(device, std::move(values), std::move(axes));
    const std::lock_guard lock(*photons.mutex);
    take_parameters(photons, std::move(parameters));
}

std::vector<float> read_traced_positions(const Photons& photons) {
    return photons.state && !photons.state->traced.empty() ? photons.state->traced : read_positions(photons.map);
}

} // namespace photonloupe
