// SPDX-License-Identifier: Apache-2.0
// Animations: what moves which node, checked.
#pragma once

#include <string>
#include <vector>

#include "scene/gltf_accessors.h"

namespace photonloupe {

enum class AnimatedPart : std::uint8_t { translation, rotation, scale, weights };
enum class Interpolation : std::uint8_t { linear, step, cubic };

// One part of one node over time. Values: for each key one element, or of cubic ones in-tangent, value, out-tangent.
struct AnimationChannel {
    std::uint32_t node = 0;
    AnimatedPart part = AnimatedPart::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<double> times;  // seconds, increasing
    std::vector<double> values; // `width` numbers an element
    std::uint32_t width = 3;
};

// The channels of the first animation, as glTF does not say which one plays; the others are named in `ignored`.
// `approved` holds the nodes: those with a matrix can't be animated.
std::vector<AnimationChannel> check_animations(const JsonPlace& root, AccessorTable& accessors, const Json& approved,
                                               std::vector<std::string>& ignored);

} // namespace photonloupe
