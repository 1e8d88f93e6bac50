// SPDX-License-Identifier: Apache-2.0
// Turns glTF materials into the kernels' mixture of Lambert, mirror and dielectric.
#pragma once

#include <tiny_gltf.h>

#include "scene/load_textures.h"
#include "scene/scene.h"

namespace photonloupe {

// Fills materials and names, and reports what the materials of loaded triangles need and what is not modeled.
// Appends glTF's default material if an object asks for it.
void load_materials(const tinygltf::Model& model, const TextureRanges& ranges, Scene& scene);

// Notes what a material needs and what is not modeled of it. `least`: what textures leave of its factors at least.
void report_material(const shared::Material& material, const shared::Material& least, const std::string& label,
                     SceneReport& report);

} // namespace photonloupe
