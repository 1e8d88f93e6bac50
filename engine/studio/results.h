// SPDX-License-Identifier: Apache-2.0
// What the state's work has given so far: it stands until newer work replaces it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "image/image.h"
#include "pipeline.h"

namespace photonloupe::studio {

struct HistogramResult {
    std::string name;
    double low = 0, high = 0;
    std::vector<double> counts;
};

struct ScriptResult {
    std::vector<HistogramResult> histograms;
    std::vector<std::string> prints;
    std::vector<std::string> report; // a line each: passes, faults, parameters
    double milliseconds = 0;
};

// One step of relaxation.
struct StepResult {
    double mean_displacement = 0; // metres
    double mean_move = 0;         // of |move|/r
    double low_frequency = 0;     // power of white noise is 1; NaN: not measured
    double noise = 0;             // relative standard deviation of the estimate; NaN: not measured
};

struct ComparisonResult {
    double rmse = 0, relmse = 0, flip = 0; // FLIP NaN: not measured
};

struct IsotropyResult {
    std::vector<float> values;
    double beta = 0;
    double threshold = 0; // t_β
};

struct Results {
    std::shared_ptr<const Scene> scene;
    std::shared_ptr<Photons> photons;  // with what the script gave them, where they were traced
    std::shared_ptr<Photons> relaxed;  // null: not relaxed
    std::uint64_t photons_version = 0; // rises with every change of photons or relaxed
    std::optional<ScriptResult> script;
    std::vector<StepResult> steps;
    std::optional<IsotropyResult> isotropy;
    std::optional<Image> image;  // linear
    std::optional<Image> colors; // the same view in false color
    std::optional<Image> reference;
    std::optional<Image> error; // as shown
    std::optional<ComparisonResult> comparison;
    std::uint64_t image_version = 0; // rises with every change of those
};

} // namespace photonloupe::studio
