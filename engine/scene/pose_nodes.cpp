// SPDX-License-Identifier: Apache-2.0
// Steps, straight lines, Hermite splines; rotations along the shorter arc (glTF 2.0, appendix C).
#include "scene/pose_nodes.h"

#include <algorithm>
#include <cmath>

namespace photonloupe {
namespace {

using Values = std::vector<double>;

// Quaternions this close are mixed in a straight line, where the arc's sine has no digits.
constexpr double SAME_ROTATION = 1 - 1e-9;

// Of element `index`, the `width` numbers.
Values take(const AnimationChannel& channel, std::size_t index) {
    const auto first = channel.values.begin() + static_cast<std::ptrdiff_t>(index * channel.width);
    return {first, first + channel.width};
}

void normalize(Values& quaternion) {
    double length = 0;
    for (const double part : quaternion)
        length += part * part;
    length = std::sqrt(length);
    for (double& part : quaternion)
        part = length > 0 ? part / length : part;
    if (!(length > 0))
        quaternion = {0, 0, 0, 1};
}

Values mix(const Values& a, const Values& b, double weight_a, double weight_b) {
    Values mixed(a.size());
    for (std::size_t i = 0; i < a.size(); ++i)
        mixed[i] = weight_a * a[i] + weight_b * b[i];
    return mixed;
}

Values turn(Values from, Values to, double share) {
    normalize(from);
    normalize(to);
    double cosine = 0;
    for (std::size_t i = 0; i < 4; ++i)
        cosine += from[i] * to[i];
    const double sign = cosine < 0 ? -1 : 1;
    cosine = std::min(std::abs(cosine), 1.0);
    if (cosine > SAME_ROTATION)
        return mix(from, to, 1 - share, sign * share);
    const double angle = std::acos(cosine), sine = std::sin(angle);
    return mix(from, to, std::sin((1 - share) * angle) / sine, sign * std::sin(share * angle) / sine);
}

// Elements of a key: in-tangent, value, out-tangent.
Values follow_spline(const AnimationChannel& channel, std::size_t key, double share, double seconds) {
    const double t = share, t2 = t * t, t3 = t2 * t;
    const Values from = take(channel, 3 * key + 1), leaving = take(channel, 3 * key + 2);
    const Values arriving = take(channel, 3 * (key + 1)), to = take(channel, 3 * (key + 1) + 1);
    Values value(channel.width);
    for (std::size_t i = 0; i < value.size(); ++i)
        value[i] = (2 * t3 - 3 * t2 + 1) * from[i] + seconds * (t3 - 2 * t2 + t) * leaving[i] +
                   (-2 * t3 + 3 * t2) * to[i] + seconds * (t3 - t2) * arriving[i];
    return value;
}

Values sample(const AnimationChannel& channel, double time) {
    const bool is_cubic = channel.interpolation == Interpolation::cubic;
    const auto take_key = [&](std::size_t key) { return take(channel, is_cubic ? 3 * key + 1 : key); };
    const auto after = std::upper_bound(channel.times.begin(), channel.times.end(), time);
    if (after == channel.times.begin())
        return take_key(0);
    const auto key = static_cast<std::size_t>(after - channel.times.begin()) - 1;
    if (after == channel.times.end() || channel.interpolation == Interpolation::step)
        return take_key(key);
    const double seconds = channel.times[key + 1] - channel.times[key];
    const double share = (time - channel.times[key]) / seconds;
    if (is_cubic)
        return follow_spline(channel, key, share, seconds);
    const Values from = take_key(key), to = take_key(key + 1);
    return channel.part == AnimatedPart::rotation ? turn(from, to, share) : mix(from, to, 1 - share, share);
}

} // namespace

void pose_nodes(tinygltf::Model& model, const std::vector<AnimationChannel>& channels, double time) {
    for (const AnimationChannel& channel : channels) {
        tinygltf::Node& node = model.nodes[channel.node];
        Values value = sample(channel, time);
        switch (channel.part) {
        case AnimatedPart::translation:
            node.translation = std::move(value);
            break;
        case AnimatedPart::rotation:
            normalize(value);
            node.rotation = std::move(value);
            break;
        case AnimatedPart::scale:
            node.scale = std::move(value);
            break;
        case AnimatedPart::weights:
            node.weights = std::move(value);
            break;
        }
    }
}

} // namespace photonloupe
