// SPDX-License-Identifier: Apache-2.0
// What both the libFuzzer target and the seeded test do with any bytes: compile them as a script, and run what compiles
// over a few photons.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <string>

#include "script/compile_script.h"
#include "script/interpret/interpreter.h"

namespace photonloupe::test {

// Few photons with short paths, some of their numbers not finite.
inline script::HostPhotons make_fuzz_photons() {
    constexpr std::uint32_t PHOTONS = 5;
    script::HostPhotons photons;
    photons.count = PHOTONS;
    photons.fetched = ~0u;
    for (std::uint32_t i = 0; i < PHOTONS; ++i) {
        const float x = i == 3 ? NAN : i == 4 ? 1e38f : float(i) - 1;
        for (std::vector<float>* column : {&photons.positions, &photons.normals, &photons.power})
            column->insert(column->end(), {x, 2 * x, x * x});
        photons.emitters.push_back(std::int32_t(i) - 1);
        photons.path_starts.push_back(std::int64_t(photons.path_interactions.size()));
        for (std::uint32_t j = 0; j < i; ++j) {
            photons.path_vertices.insert(photons.path_vertices.end(), {x, float(j), -x});
            photons.path_normals.insert(photons.path_normals.end(), {0, 1, 0});
            photons.path_scatter.push_back(0.5f);
            photons.path_interactions.push_back(std::uint8_t(j % 3));
            photons.path_objects.push_back(-1);
        }
    }
    photons.path_starts.push_back(std::int64_t(photons.path_interactions.size()));
    photons.find_neighbors = [](script::NeighborQuery::Space, std::uint32_t photon, std::uint32_t k, float) {
        std::vector<std::int32_t> ids;
        for (std::uint32_t i = 0; i < PHOTONS && ids.size() < k; ++i)
            if (i != photon)
                ids.push_back(std::int32_t(i));
        return ids;
    };
    return photons;
}

inline void fuzz_script(const std::uint8_t* data, std::size_t size) {
    const script::Source source{"fuzz", std::string(reinterpret_cast<const char*>(data), size)};
    const auto compiled = script::compile_script(source);
    script::format_diagnostics(source, compiled->diagnostics);
    if (compiled->has_errors)
        return;
    script::HostPhotons photons = make_fuzz_photons();
    script::RunOutputs outputs;
    outputs.columns = script::ScriptColumns(photons.count);
    script::RunSettings settings;
    settings.fuel = 200;
    settings.most_seconds = 0.1;
    int looks = 0;
    const Progress impatient{[&](std::string_view, double) { return ++looks < 200; }};
    try {
        script::Interpreter(compiled->program, compiled->plan, photons, outputs, settings, impatient).run();
    } catch (const Cancelled&) {
    }
}

} // namespace photonloupe::test
