// SPDX-License-Identifier: Apache-2.0
// What a run of a script is told, and the limits it keeps (docs/script.md, Loops over photons).
#pragma once

#include <cstdint>
#include <map>
#include <string>

namespace photonloupe::script {

struct RunSettings {
    std::map<std::string, double> values; // of exposed variables; the rest keep what the script assigns
    std::uint32_t seed = 1;               // of random()
    std::uint32_t fuel = 1'000'000;       // turns of loops without a provable bound: a photon's, and uniform code's
    std::uint32_t most_exhausted = 1000;  // photons that may run out before a photon loop stops
    double most_seconds = 60;             // a photon loop may take
};

} // namespace photonloupe::script
