// SPDX-License-Identifier: Apache-2.0
// Adds to a scene what its file lacks: lights and a floor.
#pragma once

#include "scene/scene.h"

namespace photonloupe {

// A copy with one thing more, which its `additions` and its hash tell of. `text` is JSON:
//   {"add": "light", "kind": "point" | "spot" | "directional" | "area" | "environment", "position", "direction",
//   "intensity", "color", "size", "cone"}: METHODS §0's units, metres, radians; a spot's cone is its inner and outer
//    angle, an area light faces its direction;
//   {"add": "light", "kind": "environment", "image", "rotation", "intensity", "color", "hash"}: radiance from an
//   equirectangular EXR file (scene/environment_map.h), times intensity and color; the copy's `additions` have the
//   file's hash, and a hash that is given must be the file's;
//   {"add": "light", "kind": "auto"}: a point light above and before what the bounds hold;
//   {"add": "floor", "y"}: a diffuse square of albedo 0.5, a thousandth of the scene's size below it if nothing is
//   said.
// Throws SceneError for what is missing or out of range.
Scene add_to_scene(const Scene& scene, const std::string& text);

} // namespace photonloupe
