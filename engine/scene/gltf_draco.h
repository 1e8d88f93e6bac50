// SPDX-License-Identifier: Apache-2.0
// Primitives compressed by KHR_draco_mesh_compression.
#pragma once

#include "scene/gltf_accessors.h"

namespace photonloupe {

// Gives the primitive's accessors what its extension holds; leaves primitives alone that lack the extension or whose
// positions are there uncompressed. Returns whether the triangles are now a plain list.
bool decode_draco(const JsonPlace& primitive, AccessorTable& accessors);

} // namespace photonloupe
