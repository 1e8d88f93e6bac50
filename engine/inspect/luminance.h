// SPDX-License-Identifier: Apache-2.0
// Luminance of linear Rec. 709, as shaders/estimate/luminance.glsl has it.
#pragma once

#include <glm/vec3.hpp>

namespace photonloupe::inspect {

inline float find_luminance(const glm::vec3& rgb) {
    return 0.2126f * rgb.r + 0.7152f * rgb.g + 0.0722f * rgb.b;
}

} // namespace photonloupe::inspect
