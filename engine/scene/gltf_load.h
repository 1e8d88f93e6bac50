// SPDX-License-Identifier: Apache-2.0
// Loads a scene from bytes in memory, for fuzzing and for scenes that never were files.
#pragma once

#include <optional>
#include <span>

#include "scene/scene.h"

namespace photonloupe {

// As load_scene, for the bytes of a .gltf or .glb. `name` is what messages call it and becomes Scene::path.
// `time`, s: where its first animation has things then, else they are at rest. URIs are resolved below `folder`; with
// an empty folder only embedded data is accepted.
Scene load_scene_from_memory(std::span<const unsigned char> bytes, const std::filesystem::path& folder,
                             const std::string& name, std::optional<double> time = std::nullopt);

} // namespace photonloupe
