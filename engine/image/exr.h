// SPDX-License-Identifier: Apache-2.0
// OpenEXR files: 32-bit float, ZIP, the attributes as strings in the header.
#pragma once

#include <filesystem>

#include "image/image.h"

namespace photonloupe {

// Keeps every bit, NaN and infinity included. Throws Error.
void write_exr(const std::filesystem::path& path, const Image& image);

// Reads R, G and B, or Y as gray, of type half, float or uint. Throws Error.
Image read_exr(const std::filesystem::path& path);
// The same from a file's bytes; `path` is what messages call it.
Image decode_exr(const std::filesystem::path& path, const std::vector<unsigned char>& bytes);

} // namespace photonloupe
