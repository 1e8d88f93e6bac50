// SPDX-License-Identifier: Apache-2.0
// Colors from ids, from scripts and from columns.
#include "inspect/photon_colors.h"

#include <cmath>
#include <numbers>

#include "shared/random.h"

namespace photonloupe::inspect {

float linearize(float srgb) {
    return srgb <= 0.04045f ? srgb / 12.92f : std::pow((srgb + 0.055f) / 1.055f, 2.4f);
}

glm::vec3 linearize(const glm::vec3& srgb) {
    return {linearize(srgb.r), linearize(srgb.g), linearize(srgb.b)};
}

glm::vec3 hash_color(std::uint32_t id) {
    const std::uint32_t bits = shared::random_bits(0, id, 0, 0);
    const float hue = 2 * std::numbers::pi_v<float> * static_cast<float>(bits & 0xffffu) / 65536.0f;
    const float value = 0.35f + 0.45f * static_cast<float>(bits >> 16) / 65536.0f;
    const auto channel = [&](int i) {
        return value * (0.65f + 0.35f * std::cos(hue - 2 * std::numbers::pi_v<float> * static_cast<float>(i) / 3));
    };
    return linearize({channel(0), channel(1), channel(2)});
}

std::vector<glm::vec3> list_hash_colors(std::uint64_t count) {
    std::vector<glm::vec3> colors;
    for (std::uint64_t id = 0; id < count; ++id)
        colors.push_back(hash_color(static_cast<std::uint32_t>(id)));
    return colors;
}

std::vector<glm::vec3> list_encoded_colors(const PhotonMap& photons) {
    if (!photons.colors)
        return list_hash_colors(photons.count);
    std::vector<glm::vec3> colors;
    for (const glm::vec4& color : photons.colors->read<glm::vec4>(photons.count))
        colors.emplace_back(color);
    return colors;
}

Colormap choose_colormap(const Column& column) {
    return column.period > 0 ? Colormap::twilight : Colormap::cividis;
}

float find_color_share(const Column& column, float value) {
    // In double: a range may be wider than floats reach, or vanish.
    const double low = column.low;
    const double extent = column.period > 0 ? column.period : static_cast<double>(column.high) - low;
    double share = extent > 0 ? (value - low) / extent : value - low + 0.5;
    if (column.period > 0)
        share -= std::floor(share);
    return static_cast<float>(share);
}

std::vector<glm::vec3> list_column_colors(const Column& column) {
    const Colormap map = choose_colormap(column);
    std::vector<glm::vec3> colors;
    colors.reserve(column.values.size());
    for (const float value : column.values)
        colors.push_back(linearize(map_color(map, find_color_share(column, value))));
    return colors;
}

} // namespace photonloupe::inspect
