// SPDX-License-Identifier: Apache-2.0
// An image as a value: linear Rec. 709 pixels and the text that says where they come from.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace photonloupe {

struct Image {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<float> rgb;                        // 3 · width · height, row 0 at the top
    std::map<std::string, std::string> attributes; // scene hash, settings, seed, version …
};

// Larger ones are refused in both directions: what a typing error or a hostile header asks for.
constexpr std::uint32_t MAX_IMAGE_SIDE = 65536;
// 2^27 pixels of 12 bytes are 1.5 GiB.
constexpr std::uint64_t MAX_IMAGE_PIXELS = 1ull << 27;

// Throws Error, starting with `where`, for a size of zero or beyond the limits.
void check_image_size(std::uint64_t width, std::uint64_t height, const std::string& where);
// Also checks that there are as many values as pixels ask for.
void check_image(const Image& image, const std::string& where);

// The whole file; throws Error, also for files larger than any image this program writes.
std::vector<unsigned char> read_image_file(const std::string& path);

} // namespace photonloupe
