// SPDX-License-Identifier: Apache-2.0
// Runs a script over a photon map: uniform code on the host, photon loops on the device.
#pragma once

#include <map>
#include <optional>

#include "photons/photon_map.h"
#include "script/compile_script.h"
#include "script/run/pass_runner.h"

namespace photonloupe::script {

// How often something happened to a parameter's values, and where first.
struct ValueCount {
    std::uint32_t count = 0;
    std::uint32_t first_photon = NO_PHOTON;
};

struct ParameterResult {
    DeclaredParameter declared;
    ValueCount unset, out_of_bounds, non_finite; // non-finite ones are unset, too
    std::uint32_t line = 0;                      // where the script sets it first; 0: nowhere that is known
};

struct ScriptRun {
    std::vector<ParameterResult> parameters;  // dimensions from 3 on
    std::vector<float> values;                // [photon][dimension - 3], NaN: unset
    std::optional<std::vector<float>> colors; // rgb a photon, NaN: unset
    std::vector<HistogramCounts> histograms;
    std::vector<std::string> prints;
    std::map<std::string, double> exposed; // values they had
    std::vector<FaultReport> faults;
    std::vector<LoopReport> loops;
    std::string stopped;
};

std::vector<DeclaredParameter> list_declared(const ScriptRun& run);

// The map's columns that a script reads, as users name them.
std::vector<std::string> list_columns(const Program& program);

// Throws ArgumentError naming a column of paths that the script reads and the map does not have.
void require_columns(const Program& program, const PhotonMap& photons);

// What neighbour queries need of the photons while a script changes their parameters.
struct ScriptQueries {
    FindRows find_rows;
    // Gives the photons the parameters that the script has set so far: [photon][dimension - 3], NaN where unset.
    std::function<void(std::span<const float> values, const std::vector<DeclaredParameter>&)> set_parameters;
};

// Where it `keeps`, what the map has stays until the script replaces it. Throws Error for values that are not exposed
// or out of range, and what devices throw.
ScriptRun run_script(gpu::Device& device, const PhotonMap& photons, const CompiledScript& script,
                     const RunSettings& settings, bool keeps, const ScriptQueries& queries, const Progress& progress);

} // namespace photonloupe::script
