// SPDX-License-Identifier: Apache-2.0
// Exposure, curve, and 8 bits.
#include "studio/tone_map.h"

#include <algorithm>
#include <cmath>

#include "image/png.h"

namespace photonloupe::studio {
namespace {

float roll_off(float x) {
    return std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
}

std::uint32_t encode(float red, float green, float blue, const ImageState& choices) {
    std::uint32_t packed = 0xff000000u;
    int shift = 0;
    for (const float linear : {red, green, blue}) {
        const bool is_filmic = choices.tone == "filmic";
        const float shown = is_filmic ? roll_off(std::max(linear * std::exp2(choices.exposure), 0.0f)) : linear;
        packed |= std::uint32_t{encode_srgb(shown, is_filmic ? 0.0 : choices.exposure)} << shift;
        shift += 8;
    }
    return packed;
}

} // namespace

std::vector<std::uint32_t> map_tones(const Image& image, const ImageState& choices) {
    std::vector<std::uint32_t> pixels;
    pixels.reserve(image.rgb.size() / 3);
    for (std::size_t i = 0; i + 2 < image.rgb.size(); i += 3)
        pixels.push_back(encode(image.rgb[i], image.rgb[i + 1], image.rgb[i + 2], choices));
    return pixels;
}

std::vector<std::uint32_t> overlay_colors(const Image& image, const Image& colors, const ImageState& choices) {
    std::vector<std::uint32_t> pixels;
    pixels.reserve(image.rgb.size() / 3);
    for (std::size_t i = 0; i + 2 < std::min(image.rgb.size(), colors.rgb.size()); i += 3) {
        const auto mix = [&](std::size_t at) { return std::lerp(image.rgb[at], colors.rgb[at], choices.overlay); };
        pixels.push_back(encode(mix(i), mix(i + 1), mix(i + 2), choices));
    }
    return pixels;
}

} // namespace photonloupe::studio
