// SPDX-License-Identifier: Apache-2.0
// Which media a place lies in: where lights and cameras begin.
#pragma once

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace photonloupe {

// The innermost medium and the one around it, at a place relative to the scene's origin; none in scenes without media.
// Media are closed: a way out meets the back of what it began in.
shared::Media find_media(const Scene& scene, const glm::dvec3& place);

} // namespace photonloupe
