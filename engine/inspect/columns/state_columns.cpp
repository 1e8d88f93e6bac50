// SPDX-License-Identifier: Apache-2.0
// Columns that a constraint or a relaxation left, and the isotropy.
#include <cmath>

#include <glm/geometric.hpp>

#include "inspect/columns/column_source.h"

namespace photonloupe::inspect {
namespace {

using Field = std::vector<float> RelaxedState::*;

glm::dvec3 take_vector(const std::vector<float>& values, std::size_t at) {
    return {values[at], values[at + 1], values[at + 2]};
}

auto read_scalar(Field field, std::size_t width = 1, std::size_t offset = 0) {
    return [=](const Photons& photons) {
        const std::vector<float>& column = (*photons.state).*field;
        std::vector<float> values;
        for (std::size_t i = offset; i < column.size(); i += width)
            values.push_back(column[i]);
        return values;
    };
}

auto read_length(Field field) {
    return [field](const Photons& photons) {
        const std::vector<float>& column = (*photons.state).*field;
        std::vector<float> values;
        for (std::size_t i = 0; i < column.size(); i += 3)
            values.push_back(static_cast<float>(glm::length(take_vector(column, i))));
        return values;
    };
}

// |D·u_b| and |D·v_b|, the half-axes of the drift ellipse (METHODS §5.5).
auto read_drift_along(std::size_t axis) {
    return [axis](const Photons& photons) {
        const RelaxedState& state = *photons.state;
        std::vector<float> values;
        for (std::size_t i = 0; 3 * i < state.drift.size(); ++i)
            values.push_back(static_cast<float>(
                std::abs(glm::dot(take_vector(state.drift, 3 * i), take_vector(state.basis, 6 * i + 3 * axis)))));
        return values;
    };
}

} // namespace

void list_state_sources(std::vector<ColumnSource>& sources) {
    const auto add = [&](const char* name, const char* label, Needs needs,
                         std::function<std::vector<float>(const Photons&)> compute) {
        sources.push_back({name, label, needs, 0, 0, 0, false, std::move(compute)});
    };
    add("drift", "drift [m]", Needs::relaxation, read_length(&RelaxedState::drift));
    add("drift_u", "drift along u_b [m]", Needs::constraint, read_drift_along(0));
    add("drift_v", "drift along v_b [m]", Needs::constraint, read_drift_along(1));
    add("pressure", "pressure |f'|/r", Needs::relaxation, read_scalar(&RelaxedState::pressure));
    add("w_u", "constraint weight w_u", Needs::constraint, read_scalar(&RelaxedState::weights, 2, 0));
    add("w_v", "constraint weight w_v", Needs::constraint, read_scalar(&RelaxedState::weights, 2, 1));
    add("gradient", "gradient |∇f/f| [1/m]", Needs::constraint, read_length(&RelaxedState::gradient));
    add("one_sidedness", "one-sidedness c_m", Needs::constraint, read_scalar(&RelaxedState::one_sidedness));
    add("isotropy", "isotropy t", Needs::parameters, {});
}

} // namespace photonloupe::inspect
