// SPDX-License-Identifier: Apache-2.0
// One run of a pass: its buffers, and what is known of it so far.
#pragma once

#include <chrono>

#include "script/interpret/lanes.h"
#include "script/run/pass_runner.h"

namespace photonloupe::script {

struct PassRunner::Work {
    const PhotonLoop& loop;
    const EmittedPass& pass;
    Interpreter& interpreter;
    LoopReport& report;

    std::vector<std::uint32_t> uniforms;
    gpu::Buffer uniform_words, lane_words, fault_words, status_words, histogram_words, print_bits, late_bits;
    gpu::Buffer neighbor_rows;
    gpu::Buffer kept_parameters; // from before, when the pass reads what it writes

    std::vector<std::vector<std::uint32_t>> blocks; // totals
    std::uint32_t rounds = 1;
    bool has_late_photons = false;
    std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();

    shared::ScriptPass push(const PhotonMap& photons, const RunOutputs& outputs, const RunSettings& settings) const {
        shared::ScriptPass push{};
        push.photon_count = static_cast<std::uint32_t>(photons.count);
        push.seed = settings.seed;
        push.fuel = settings.fuel;
        push.parameter_count = static_cast<std::uint32_t>(outputs.columns.declared().size());
        push.origin = {photons.origin[0], photons.origin[1], photons.origin[2], 0.0};
        return push;
    }
};

} // namespace photonloupe::script
