// SPDX-License-Identifier: Apache-2.0
// The lights as the tracing kernel draws from them: projection maps, fluxes and choice probabilities.
#pragma once

#include <vector>

#include "scene/scene.h"
#include "shared/trace.h"
#include "trace/settings.h"

namespace photonloupe {

struct EmitterTable {
    std::vector<shared::LightEmission> emitters;
    std::vector<std::uint32_t> cells;
    std::vector<glm::uvec2> cell_rows;
    double solid_angle = 0;
};

// Throws SceneError when no light can send anything where it would be stored, with the reason.
EmitterTable build_emitters(const Scene& scene, Store store);

} // namespace photonloupe
