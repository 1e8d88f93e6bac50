// SPDX-License-Identifier: Apache-2.0
// Turns a planned photon loop into the GLSL of one compute pass, with tables of what the host must bring and fetch.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "script/plan/fault_sites.h"
#include "script/plan/lane_layout.h"
#include "script/plan/plan.h"

namespace photonloupe::script {

// Layouts and meanings of the words: shaders/shared/script.h.

// A variable's words in `uniform_words`: a scalar's one, an array's numbers, a list's first word in neighbor_rows and
// length. `set_word`: 1 where the variable holds something.
struct UniformSlot {
    std::uint32_t variable = 0;
    std::uint32_t first_word = 0;
    std::optional<std::uint32_t> set_word;
};

// A place where photons may go wrong (`fault`), or run out of fuel (`loop`).
struct PassSite {
    FaultSite fault;
    const Statement* loop = nullptr;
};

struct PassQuery {
    const NeighborQuery* query = nullptr; // in the plan
    std::uint32_t first_word = 0;         // of QUERY_STRIDE uniform words
};

struct PassHistogram {
    const Expression* call = nullptr;
    std::string name;
    Expression low, high;           // in terms of uniform names alone
    std::optional<Expression> bins; // absent: the default
    std::uint32_t first_word = 0;   // of HISTOGRAM_STRIDE uniform words
};

struct EmittedPass {
    std::string glsl; // begins with its includes; bindings as pragmas

    std::vector<UniformSlot> uniforms;
    std::optional<std::uint32_t> moments_2d_word, moments_3d_word, decomposition_word; // from before the loop
    std::vector<PassQuery> queries;
    std::vector<PassHistogram> histograms;
    std::uint32_t uniform_word_count = 0;

    // Of `lane_words`; before the first dispatch they hold make_identity(). No slots: nothing is reduced; else dispatch
    // one group (ScriptPass).
    LaneLayout lanes;

    std::vector<PassSite> sites;        // in the order of fault_words
    bool can_miss_photons = true;       // a photon in late_bits has left no trace; else the interpreter takes the loop
    std::optional<Diagnostic> too_long; // the pass has more GLSL than MAX_GLSL_BYTES; glsl is empty then
};

constexpr std::size_t MAX_GLSL_BYTES = 128 * 1024;

// `loop` is parallel; both must outlive the result.
EmittedPass emit_pass(const Program& program, const PhotonLoop& loop);

} // namespace photonloupe::script
