// SPDX-License-Identifier: Apache-2.0
// Turns meshes into world-space triangles relative to the scene's origin.
#pragma once

#include "scene/accessor_column.h"
#include "scene/place_nodes.h"
#include "scene/scene.h"

namespace photonloupe {

// Fills origin, bounds, objects, triangles and normals, and notes what was dropped or replaced.
// A primitive without a material gets the index behind the file's last one.
void load_triangles(const tinygltf::Model& model, const std::vector<AccessorColumn>& columns,
                    const std::vector<PlacedNode>& nodes, Scene& scene);

} // namespace photonloupe
