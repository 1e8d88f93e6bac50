// SPDX-License-Identifier: Apache-2.0
// Runs scripts in the interpreter over a few photons made by hand.
#pragma once

#include <string>
#include <vector>

#include "core/progress.h"
#include "script/interpret/host_photons.h"
#include "script/interpret/lanes.h"
#include "script/interpret/run_outputs.h"
#include "script/interpret/run_settings.h"

namespace photonloupe::script::tests {

// Photons i at (i, 10 i, 100 i), path of vertices (i, j, 0) with normals towards y, flux (1, 2, 3) W.
HostPhotons make_photons(std::uint32_t count, std::uint32_t vertices = 3);

struct Ran {
    Program program;
    RunOutputs outputs;
    ScriptState state;
    std::string errors; // of checking; then nothing ran

    // Variables of the script by name, after the run.
    float real(const std::string& name, std::size_t element = 0) const;
    std::int32_t integer(const std::string& name, std::size_t element = 0) const;
    bool is_set(const std::string& name) const;
    const FaultReport* find_fault(Fault kind) const;

private:
    std::uint32_t find(const std::string& name) const;
};

Ran interpret(const std::string& text, HostPhotons photons = make_photons(8), const RunSettings& settings = {},
              const Progress& progress = {});

} // namespace photonloupe::script::tests
