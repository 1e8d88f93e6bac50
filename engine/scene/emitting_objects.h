// SPDX-License-Identifier: Apache-2.0
// Objects that emit become area lights.
#pragma once

#include "scene/scene.h"

namespace photonloupe {

// Lists the emitting triangles of each object and adds a light for it; after the triangles have their final order.
void list_emitting_objects(Scene& scene);

} // namespace photonloupe
