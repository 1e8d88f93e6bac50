// SPDX-License-Identifier: Apache-2.0
// PNG files: 8-bit sRGB for looking at, with the attributes as text chunks.
#pragma once

#include <filesystem>

#include "image/decode_image.h"
#include "image/image.h"

namespace photonloupe {

struct PngImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> rgb; // sRGB, 3 · width · height, row 0 at the top
    std::map<std::string, std::string> attributes;
};

// One linear value as stored: clip(linear · 2^exposure) through the sRGB curve; NaN is black.
std::uint8_t encode_srgb(float linear, double exposure);

// Throws Error.
std::vector<unsigned char> encode_png(const Image& image, double exposure);
void write_png(const std::filesystem::path& path, const Image& image, double exposure);

// Reads any PNG as 8-bit RGB (alpha dropped, gray expanded). Throws Error.
PngImage read_png(const std::filesystem::path& path);

// Any PNG as 8-bit texels with alpha. Throws Error.
RgbaImage decode_png_texels(const std::vector<unsigned char>& bytes);

} // namespace photonloupe
