// SPDX-License-Identifier: Apache-2.0
// Fills in what depends on the map: steps, constraint, β.
#include "relax/complete_settings.h"

#include "core/error.h"
#include "relax/isotropy.h"

namespace photonloupe {
namespace {

void require_layers(const char* name, std::optional<Space> space) {
    if (space == Space::parameter)
        throw ArgumentError(std::string(name) +
                            "=\"parameter\" needs parameters; set_parameters() or a script sets them");
}

} // namespace

CompleteSettings complete_settings(gpu::Device& device, IndexedMap& photons, const RelaxSettings& given,
                                   std::optional<Emission> emission, const Progress& progress) {
    const bool has_parameters = photons.map.parameters.has_value();
    CompleteSettings complete{complete_settings(given, emission, has_parameters), {}};
    RelaxSettings& settings = complete.settings;
    if (!has_parameters) {
        require_layers("constraint", settings.constraint);
        require_layers("repel", settings.repel);
    }
    if (!settings.uses_layers()) {
        settings.beta = 0;
    } else if (!settings.beta) {
        const auto found = find_optimal_beta(device, photons, BETA_NEIGHBORS, CLIPPED_SHARE, progress);
        settings.beta = found ? found->beta : RelaxSettings().beta;
        if (!found)
            complete.notes.push_back(explain_no_ratio(photons.map));
    }
    return complete;
}

} // namespace photonloupe
