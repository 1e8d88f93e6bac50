// SPDX-License-Identifier: Apache-2.0
// Runs scripts with their passes on the device, beside the interpreter, over photons made by hand.
#pragma once

#include <optional>
#include <string>

#include "script/interpret.h"

namespace photonloupe::script::tests {

// Random photons on random paths of so many vertices (0: 2 to 7), in a world whose origin is elsewhere.
HostPhotons make_random_photons(std::uint32_t count, std::uint32_t seed = 1, std::uint32_t vertices = 0);

// As `interpret`. Throws where a pass cannot be compiled.
Ran run_on_device(const std::string& text, HostPhotons photons, const RunSettings& settings = {});

struct Comparison {
    double ulps = 0;                        // of numbers
    double absolute = 0;                    // or that near
    std::optional<bool> is_parallel = true; // what all its photon loops must be; absent: either
};

// Runs a script both ways and expects the same variables, parameters, colors, histograms, prints and faults.
void expect_same(const std::string& text, const HostPhotons& photons, const Comparison& comparison = {},
                 const RunSettings& settings = {});

} // namespace photonloupe::script::tests
