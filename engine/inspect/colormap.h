// SPDX-License-Identifier: Apache-2.0
// Colors for numbers: perceptually ordered maps that color-blind readers tell apart too.
#pragma once

#include <glm/vec3.hpp>

namespace photonloupe::inspect {

enum class Colormap {
    cividis,  // ordered values
    viridis,  // ordered values, more colorful
    twilight, // periodic values: both ends are one color
};

// What has no value, sRGB.
constexpr glm::vec3 UNSET_COLOR{0.45f, 0.45f, 0.45f};

// sRGB color of a share in [0, 1], clamped; NaN: UNSET_COLOR.
glm::vec3 map_color(Colormap map, float share);

} // namespace photonloupe::inspect
