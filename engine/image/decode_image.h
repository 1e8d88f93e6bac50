// SPDX-License-Identifier: Apache-2.0
// PNG, JPEG and WebP files of textures, told apart by their first bytes.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace photonloupe {

// 8-bit red, green, blue, alpha, red in the lowest byte; row 0 at the top. Encoded as in the file.
struct RgbaImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint32_t> texels;
};

// Larger images are refused before memory is taken for them.
constexpr std::uint32_t MAX_TEXTURE_SIDE = 16384;
constexpr std::uint64_t MAX_TEXTURE_PIXELS = 1ull << 27;

// An image of zeros. Throws Error for a size that no texture has.
RgbaImage make_texels(std::uint64_t width, std::uint64_t height);

// Throws Error with the reason, without naming the file.
RgbaImage decode_image(std::span<const unsigned char> bytes);

} // namespace photonloupe
