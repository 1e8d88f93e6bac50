// SPDX-License-Identifier: Apache-2.0
// Which images a file's materials are painted with, and how they lie on the surfaces.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scene/gltf_accessors.h"

namespace photonloupe {

// What of a material a texture may change.
enum class TextureSlot : std::uint8_t {
    base_color,
    metallic_roughness,
    normal,
    emission,
    transmission,
    translucency,
    translucency_color,
    gloss,
    gloss_color,
    coat,
    coat_roughness
};
constexpr std::size_t TEXTURE_SLOT_COUNT = 11;

enum class TextureWrap : std::uint8_t { repeat, clamp, mirror };

struct TextureUse {
    std::uint32_t image = 0;
    std::uint32_t coordinates = 0; // 0 or 1: TEXCOORD_0 or TEXCOORD_1
    // KHR_texture_transform: (u, v) → (a u + b v + c, d u + e v + f).
    std::array<double, 6> transform{1, 0, 0, 0, 1, 0};
    TextureWrap wrap_u = TextureWrap::repeat;
    TextureWrap wrap_v = TextureWrap::repeat;
    bool is_nearest = false;
    double scale = 1.0; // of normal textures
};

// Of one material, by slot.
using MaterialTextures = std::array<std::optional<TextureUse>, TEXTURE_SLOT_COUNT>;

// An image's file as it is stored; or the reason why there is none.
struct ImageFile {
    std::string name;
    std::vector<unsigned char> bytes;
    std::string problem;
};

// For each material. Adds to `ignored` what has no image that is read.
std::vector<MaterialTextures> check_textures(const JsonPlace& root, std::vector<std::string>& ignored);

// The images that materials use, the others empty; those that can't be read say so in `problem`.
std::vector<ImageFile> read_images(const JsonPlace& root, const std::filesystem::path& folder, AccessorTable& accessors,
                                   const std::vector<MaterialTextures>& textures);

} // namespace photonloupe
