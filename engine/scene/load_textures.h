// SPDX-License-Identifier: Apache-2.0
// Decodes the images that materials use into one atlas of texels.
#pragma once

#include "scene/gltf_textures.h"
#include "scene/scene.h"

namespace photonloupe {

// What a texture makes of a factor of 1, least and most, by channel.
struct TextureRange {
    std::array<float, 4> least{1, 1, 1, 1};
    std::array<float, 4> most{1, 1, 1, 1};
};

// Of the scene's textures, and in front of them of none, as paints count them.
using TextureRanges = std::vector<TextureRange>;

// Fills the scene's atlas and textures, and for each material its paint. Images that can't be decoded are listed among
// what is ignored, and their surfaces keep their factors; too many texels are halved, with a note.
TextureRanges load_textures(const std::vector<MaterialTextures>& materials, const std::vector<ImageFile>& images,
                            Scene& scene);

// A texture at a point of a triangle, by the weights of its corners; as the kernels sample it.
glm::dvec4 sample_texture(const Scene& scene, float number, std::uint32_t triangle, const glm::dvec3& weights);

} // namespace photonloupe
