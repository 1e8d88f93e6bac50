// SPDX-License-Identifier: Apache-2.0
// Checks an image of the sky and sums its radiance into cumulative shares, texel by texel and row by row.
#include "scene/environment_map.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "core/error.h"

namespace photonloupe {
namespace {

// 8,192 × 4,096 texels of 16 bytes are 512 MiB on the device.
constexpr std::uint64_t MOST_TEXELS = 1ull << 25;
// Of radiances, far from where sums of 32-bit floats end.
constexpr double LARGEST_RADIANCE = 1e30;

[[noreturn]] void refuse_image(const std::filesystem::path& path, const std::string& what, const char* remedy) {
    throw SceneError(path.string() + ": " + what + "; " + remedy);
}

void check_shape(const std::filesystem::path& path, const Image& image) {
    const std::string size = std::to_string(image.width) + " × " + std::to_string(image.height) + " pixels";
    if (image.width == 0 || image.width != 2 * image.height)
        refuse_image(path, "an image of " + size + " is no equirectangular environment",
                     "give one that is twice as wide as high");
    if (std::uint64_t{image.width} * image.height > MOST_TEXELS)
        refuse_image(path, size + " are more than the " + std::to_string(MOST_TEXELS) + " that are accepted",
                     "scale it down to 8192 × 4096");
}

// Share of the sphere above the border between rows `row - 1` and `row`.
double find_share_above(std::uint32_t row, std::uint32_t height) {
    const double half = std::sin(0.5 * std::numbers::pi * row / height);
    return half * half;
}

float write_fraction(double fraction) {
    return std::bit_cast<float>(
        static_cast<std::uint32_t>(std::llround(fraction * std::ldexp(1.0, shared::ENVIRONMENT_FRACTION_BITS))));
}

// One channel of a pixel, `at` values into the image.
float read_radiance(EnvironmentMap& map, const Image& image, std::size_t at, double factor) {
    const double value = image.rgb[at], radiance = std::max(value, 0.0) * factor;
    map.negative_count += value < 0;
    if (std::isfinite(value) && radiance <= LARGEST_RADIANCE)
        return static_cast<float>(radiance);
    const std::string where = "the pixel in column " + std::to_string(at / 3 % image.width) + " of row " +
                              std::to_string(at / 3 / image.width) + " is ";
    if (!std::isfinite(value))
        refuse_image(map.path, where + (std::isnan(value) ? "NaN" : "infinite"), "repair the image");
    refuse_image(map.path, where + "brighter than 1e30 W/(m² sr)", "lower the intensity");
}

// Radiances of a row, its first texel towards +x; cumulative shares in w. Returns the row's sum of largest channels.
double fill_row(EnvironmentMap& map, const Image& image, std::uint32_t row, const glm::dvec3& factor, glm::dvec3& sum) {
    glm::vec4* texels = &map.texels[1 + map.height + std::size_t{row} * map.width];
    double whole = 0;
    for (std::uint32_t i = 0; i < map.width; ++i) {
        const std::size_t at = 3 * (std::size_t{row} * map.width + (i + map.width / 2) % map.width);
        for (int channel = 0; channel < 3; ++channel)
            texels[i][channel] = read_radiance(map, image, at + std::size_t(channel), factor[channel]);
        sum += glm::dvec3(texels[i]);
        whole += std::max({texels[i].r, texels[i].g, texels[i].b});
    }
    double before = 0;
    for (std::uint32_t i = 0; i < map.width; ++i) {
        before += std::max({texels[i].r, texels[i].g, texels[i].b});
        texels[i].w = write_fraction(whole > 0 ? std::min(before / whole, 1.0) : 1.0);
    }
    return whole / map.width;
}

} // namespace

EnvironmentMap make_environment_map(const std::filesystem::path& path, const Image& image, const glm::dvec3& factor,
                                    double rotation) {
    check_shape(path, image);
    EnvironmentMap map{path, image.width, image.height, {}, 0, {}, 0};
    map.texels.resize(1 + map.height + std::size_t{map.width} * map.height);
    std::vector<double> shares; // of the rows, of the mean of the largest channel
    for (std::uint32_t row = 0; row < map.height; ++row) {
        const double solid = find_share_above(row + 1, map.height) - find_share_above(row, map.height);
        glm::dvec3 sum(0.0);
        shares.push_back(fill_row(map, image, row, factor, sum) * solid);
        map.mean += sum * (solid / map.width);
        map.mean_largest += shares.back();
    }
    if (!(map.mean_largest > 0))
        refuse_image(path, "it sends no light: all of it times its intensity and color is 0",
                     "give another image or intensity");
    double before = 0;
    for (std::uint32_t row = 0; row < map.height; ++row) {
        before += shares[row];
        map.texels[1 + row].w = write_fraction(std::min(before / map.mean_largest, 1.0));
    }
    const double turn = -rotation / (2 * std::numbers::pi);
    const shared::EnvironmentHeader header{map.width, map.height, static_cast<float>(turn - std::floor(turn)),
                                           static_cast<float>(4 * std::numbers::pi * map.mean_largest)};
    map.texels[0] = std::bit_cast<glm::vec4>(header);
    return map;
}

} // namespace photonloupe
