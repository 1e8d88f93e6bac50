// SPDX-License-Identifier: Apache-2.0
// Picks and completes the stages' settings.
#include "studio/stage_choices.h"

namespace photonloupe::studio {
namespace {

// A map from a file may have come about any way.
std::optional<Emission> find_emission(const TraceState& trace) {
    return trace.map.empty() ? std::optional(trace.emission) : std::nullopt;
}

} // namespace

std::vector<Setting> list_choices(ImageState& image) {
    std::vector<Setting> rows = list_settings(image.render);
    std::erase_if(rows, [](const Setting& row) {
        return row.about.name == "width" || row.about.name == "height" || row.about.name == "mode";
    });
    return rows;
}

RelaxSettings decide_steps(const StudioState& state) {
    RelaxSettings settings = state.relax.choices;
    settings.steps = complete_choices(state, false).steps;
    return settings;
}

RelaxSettings complete_choices(const StudioState& state, bool has_parameters) {
    return complete_settings(state.relax.choices, find_emission(state.trace), has_parameters);
}

ImageState complete_choices(ImageState image, const TraceState& trace) {
    image.render.estimate = complete_settings(image.render.estimate, find_emission(trace));
    return image;
}

} // namespace photonloupe::studio
