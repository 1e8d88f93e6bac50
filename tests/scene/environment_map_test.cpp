// SPDX-License-Identifier: Apache-2.0
// Directions drawn from an environment follow the density that is stated for them, texel by texel and within texels.
#include "scene/environment_map.h"

#include <cmath>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include "core/error.h"
#include "gpu/commands.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

constexpr double PI = std::numbers::pi;
constexpr double TURN = 0.7; // radians

// Bright and dim texels, and black ones.
Image make_sky(std::uint32_t height, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> draw(0, 1);
    Image sky{2 * height, height, {}, {}};
    for (std::uint32_t i = 0; i < sky.width * height; ++i) { // the first is bright
        const float bright = i > 0 && draw(random) < 0.3f ? 0.0f : std::pow(draw(random), 6.0f);
        for (int channel = 0; channel < 3; ++channel)
            sky.rgb.push_back(bright * draw(random));
    }
    return sky;
}

struct Drawn {
    glm::vec4 direction, seen;
};

std::vector<Drawn> draw(const EnvironmentMap& map, const std::vector<glm::uvec2>& fractions) {
    gpu::Device& device = get_device();
    const gpu::Buffer environment = gpu::make_buffer(device, map.texels, "environment");
    const gpu::Buffer input = gpu::make_buffer(device, fractions, "fractions");
    const gpu::Buffer output(device, fractions.size() * sizeof(Drawn), "directions");
    const auto count = static_cast<std::uint32_t>(fractions.size());
    gpu::Commands commands(device, "probe");
    commands.dispatch({"probe_environment.comp", 64, {}, {}},
                      {{"environment_map", environment}, {"inputs", input}, {"outputs", output}}, count, count);
    commands.run();
    return output.read<Drawn>(fractions.size());
}

std::vector<glm::uvec2> draw_fractions(std::size_t count) {
    std::mt19937 random(3);
    std::vector<glm::uvec2> fractions(count);
    for (glm::uvec2& fraction : fractions)
        fraction = {random(), random()};
    return fractions;
}

double find_largest(const Image& sky, std::uint32_t row, std::uint32_t column) {
    const float* pixel = &sky.rgb[3 * (std::size_t{row} * sky.width + column)];
    return std::max({pixel[0], pixel[1], pixel[2]});
}

// Each texel in 2 × 2 parts of equal solid angle.
class Parts {
public:
    explicit Parts(const Image& sky) : m_sky(sky) {}

    std::size_t find(const glm::dvec3& direction) const {
        const double azimuth = std::atan2(direction.z, direction.x) + TURN; // where it was before it was turned
        const double along = azimuth / (2 * PI) + 0.5;
        const double column = (along - std::floor(along)) * m_sky.width;
        const double polar = std::acos(std::clamp(direction.y, -1.0, 1.0)) / PI * m_sky.height;
        const auto row = std::min(m_sky.height - 1, static_cast<std::uint32_t>(polar));
        const double upper = std::cos(PI * row / m_sky.height), lower = std::cos(PI * (row + 1) / m_sky.height);
        const bool is_low = direction.y < 0.5 * (upper + lower);
        return (2 * row + is_low) * std::size_t{2} * m_sky.width +
               std::min<std::size_t>(static_cast<std::size_t>(2 * column), 2 * m_sky.width - 1);
    }

    // Shares of the power, by the integral over each.
    std::vector<double> list_shares() const {
        std::vector<double> shares;
        double total = 0;
        for (std::uint32_t row = 0; row < 2 * m_sky.height; ++row)
            for (std::uint32_t column = 0; column < 2 * m_sky.width; ++column) {
                const double solid =
                    std::cos(PI * (row / 2) / m_sky.height) - std::cos(PI * (row / 2 + 1) / m_sky.height);
                shares.push_back(find_largest(m_sky, row / 2, column / 2) * solid);
                total += shares.back();
            }
        for (double& share : shares)
            share /= total;
        return shares;
    }

private:
    const Image& m_sky;
};

TEST(EnvironmentMap, drawn_directions_follow_their_density) {
    constexpr std::size_t COUNT = 1 << 20;
    const Image sky = make_sky(8, 1);
    const EnvironmentMap map = make_environment_map("sky", sky, glm::dvec3(1), TURN);
    const Parts parts(sky);
    const std::vector<double> shares = parts.list_shares();
    std::vector<double> counts(shares.size());
    for (const Drawn& drawn : draw(map, draw_fractions(COUNT)))
        counts[parts.find(glm::dvec3(drawn.direction))] += 1;
    double chi2 = 0;
    int degrees = -1;
    for (std::size_t i = 0; i < shares.size(); ++i) {
        const double expected = shares[i] * COUNT;
        if (expected < 10) { // too few for χ²; a direction on a border may be counted beyond it
            EXPECT_LE(counts[i], expected + 4 * std::sqrt(expected) + 10);
            continue;
        }
        chi2 += std::pow(counts[i] - expected, 2) / expected;
        ++degrees;
    }
    EXPECT_GT(degrees, 200);
    EXPECT_LT(chi2, degrees + 4 * std::sqrt(2.0 * degrees)); // one false alarm in 30,000
}

TEST(EnvironmentMap, what_is_drawn_is_seen_where_it_is_drawn) {
    for (const std::uint32_t height : {1u, 2u, 7u, 64u}) {
        const EnvironmentMap map = make_environment_map("sky", make_sky(height, 5), glm::dvec3(1), TURN);
        std::size_t differing = 0;
        const std::vector<Drawn> all = draw(map, draw_fractions(1 << 16));
        for (const Drawn& drawn : all) {
            EXPECT_NEAR(glm::length(glm::vec3(drawn.direction)), 1, 1e-6);
            EXPECT_GT(drawn.direction.w, 0);
            const double density = drawn.direction.w / (4 * PI * map.mean_largest);
            EXPECT_NEAR(drawn.seen.w, density, 1e-6 * density);
            differing += std::max({drawn.seen.x, drawn.seen.y, drawn.seen.z}) != drawn.direction.w;
        }
        EXPECT_LE(differing, all.size() / 2000) << height; // on borders of texels
    }
}

TEST(EnvironmentMap, extreme_fractions_give_directions) {
    const EnvironmentMap map = make_environment_map("sky", make_sky(5, 9), glm::dvec3(1), 0);
    std::vector<glm::uvec2> corners;
    for (const std::uint32_t x : {0u, 1u, 0x7fffffffu, 0xffffffffu})
        for (const std::uint32_t y : {0u, 1u, 0x80000000u, 0xffffffffu})
            corners.emplace_back(x, y);
    for (const Drawn& drawn : draw(map, corners)) {
        EXPECT_NEAR(glm::length(glm::vec3(drawn.direction)), 1, 1e-6);
        EXPECT_GT(drawn.direction.w, 0);
    }
}

TEST(EnvironmentMap, mean_is_the_integral) {
    const Image sky = make_sky(16, 2);
    const EnvironmentMap map = make_environment_map("sky", sky, {2, 3, 4}, 0);
    glm::dvec3 mean(0);
    for (std::uint32_t row = 0; row < sky.height; ++row) {
        const double solid = std::cos(PI * row / sky.height) - std::cos(PI * (row + 1) / sky.height);
        for (std::uint32_t column = 0; column < sky.width; ++column)
            for (int channel = 0; channel < 3; ++channel)
                mean[channel] += (channel + 2) * sky.rgb[3 * (std::size_t{row} * sky.width + column) + channel] *
                                 solid / (2 * sky.width);
    }
    for (int channel = 0; channel < 3; ++channel)
        EXPECT_NEAR(map.mean[channel], mean[channel], 1e-6 * mean[channel]);
}

TEST(EnvironmentMap, large_skies_are_drawn_to_the_texel) {
    Image sky{4096, 2048, std::vector<float>(3ull * 4096 * 2048, 1e-3f), {}};
    constexpr std::uint32_t ROW = 300, COLUMN = 1000;
    for (int channel = 0; channel < 3; ++channel)
        sky.rgb[3 * (std::size_t{ROW} * sky.width + COLUMN) + channel] = 1e5f;
    const EnvironmentMap map = make_environment_map("sky", sky, glm::dvec3(1), 0);
    const double solid = (std::cos(PI * ROW / sky.height) - std::cos(PI * (ROW + 1) / sky.height)) / (2 * sky.width);
    const double share = 1e5 * solid / map.mean_largest;
    double met = 0;
    const std::vector<Drawn> all = draw(map, draw_fractions(1 << 17));
    for (const Drawn& drawn : all)
        met += drawn.direction.w > 1;
    const double expected = share * static_cast<double>(all.size());
    EXPECT_NEAR(met, expected, 4 * std::sqrt(expected * (1 - share)));
    EXPECT_GT(share, 0.05);
}

TEST(EnvironmentMap, what_is_no_sky_is_refused_by_its_path) {
    const auto explain = [](Image image, double factor = 1) -> std::string {
        try {
            make_environment_map("dusk.exr", image, glm::dvec3(factor), 0);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    };
    const auto fill = [](std::uint32_t width, std::uint32_t height, float value) {
        return Image{width, height, std::vector<float>(3ull * width * height, value), {}};
    };
    EXPECT_EQ(explain(fill(2, 1, 1)), "");
    EXPECT_NE(explain(fill(3, 2, 1)).find("dusk.exr: an image of 3 × 2 pixels"), std::string::npos);
    EXPECT_NE(explain(fill(0, 0, 1)).find("twice as wide as high"), std::string::npos);
    EXPECT_NE(explain(fill(4, 2, 0)).find("sends no light"), std::string::npos);
    EXPECT_NE(explain(fill(4, 2, -1)).find("sends no light"), std::string::npos);
    EXPECT_NE(explain(fill(4, 2, 1), 0).find("sends no light"), std::string::npos);
    EXPECT_NE(explain(fill(4, 2, 1e20f), 1e20).find("brighter than"), std::string::npos);
    for (const float bad : {std::nanf(""), INFINITY, -INFINITY}) {
        Image image = fill(4, 2, 1);
        image.rgb[3 * 6 + 1] = bad;
        EXPECT_NE(explain(image).find("column 2 of row 1 is"), std::string::npos) << explain(image);
    }
    Image mixed = fill(4, 2, 1);
    mixed.rgb[4] = -3;
    EXPECT_EQ(make_environment_map("dusk.exr", mixed, glm::dvec3(1), 0).negative_count, 1u);
}

} // namespace
} // namespace photonloupe::test
