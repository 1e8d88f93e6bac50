// SPDX-License-Identifier: Apache-2.0
// Where columns come from: each one's name, label, kind, what it needs, and how it is computed.
#pragma once

#include <functional>

#include "known_photons.h"

namespace photonloupe::inspect {

// What a map must have before a column can be had.
enum class Needs { nothing, paths, parameters, constraint, relaxation };

struct ColumnSource {
    std::string name;
    std::string label;
    Needs needs = Needs::nothing;
    float low = 0, high = 0; // declared; both 0: of its values
    float period = 0;
    bool is_discrete = false;
    std::function<std::vector<float>(const Photons&)> compute; // empty: on the device, by whoever asks
};

void list_photon_sources(std::vector<ColumnSource>& sources);
void list_path_sources(std::vector<ColumnSource>& sources);
void list_state_sources(std::vector<ColumnSource>& sources);
// One a parameter; a name that is taken, or is none, gets another.
void list_parameter_sources(std::vector<ColumnSource>& sources, const Photons& photons);

} // namespace photonloupe::inspect
