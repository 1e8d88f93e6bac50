// SPDX-License-Identifier: Apache-2.0
// Linear pixels as screens show them.
#pragma once

#include <cstdint>
#include <vector>

#include "image/image.h"
#include "studio/state.h"

namespace photonloupe::studio {

// RGBA8, by the exposure and curve chosen: sRGB clips, filmic rolls off ([Narkowicz 2015], ACES fit).
std::vector<std::uint32_t> map_tones(const Image& image, const ImageState& choices);

// The same with false colors laid over, as strongly as chosen. Both have one size.
std::vector<std::uint32_t> overlay_colors(const Image& image, const Image& colors, const ImageState& choices);

} // namespace photonloupe::studio
