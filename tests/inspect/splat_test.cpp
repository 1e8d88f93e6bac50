// SPDX-License-Identifier: Apache-2.0
// Photons as points: against sums made one by one on the host, and what must not change a picture.
#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "inspect/inspect_maps.h"
#include "inspect/splat_photons.h"
#include "inspect/surface_view.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

constexpr std::uint32_t SIDE = 48;

std::vector<glm::vec3> scatter_places(std::size_t count, float height) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> spread(-1.2f, 1.2f);
    std::vector<glm::vec3> places;
    for (std::size_t i = 0; i < count; ++i)
        places.emplace_back(spread(random), height, spread(random));
    return places;
}

SplatView look(const SurfaceView* surface = nullptr) {
    return {SIDE, SIDE, look_down(), {0, 0, 0}, surface};
}

std::vector<std::uint32_t> draw(const std::vector<glm::vec3>& places, std::span<const std::uint32_t> colors = {},
                                std::span<const std::uint32_t> marks = {}, const SurfaceView* surface = nullptr,
                                const SplatStyle& style = {}) {
    const Photons photons = make_floor_photons(places);
    return splat_photons(get_device(), photons.map, look(surface), colors, marks, style)
        .read<std::uint32_t>(std::uint64_t{SIDE} * SIDE);
}

// The weights that a disc with a soft rim leaves, by pixel.
std::vector<double> sum_weights(const std::vector<glm::vec3>& places, const SplatStyle& style) {
    const shared::CameraFrame frame = look_down();
    std::vector<double> sums(SIDE * SIDE);
    for (const glm::vec3& place : places) {
        const glm::vec3 away = place - glm::vec3(frame.position);
        const glm::vec3 right(frame.right), up(frame.up);
        const double depth = glm::dot(away, glm::vec3(frame.forward));
        const double x = (glm::dot(away, right) / (glm::dot(right, right) * depth) + 1) * 0.5 * SIDE;
        const double y = (1 - glm::dot(away, up) / (glm::dot(up, up) * depth)) * 0.5 * SIDE;
        for (std::uint32_t row = 0; row < SIDE; ++row)
            for (std::uint32_t column = 0; column < SIDE; ++column) {
                const double distance = std::hypot(column + 0.5 - x, row + 0.5 - y);
                const double weight = std::clamp(style.radius + 0.5 - distance, 0.0, 1.0);
                sums[row * SIDE + column] += std::floor(weight * shared::SPLAT_UNIT + 0.5) / shared::SPLAT_UNIT;
            }
    }
    return sums;
}

TEST(SplatPhotons, covers_pixels_as_sums_on_the_host_say) {
    const std::vector<glm::vec3> places = scatter_places(400, 0);
    SplatStyle style;
    style.radius = 1.7f;
    style.background = glm::vec3(0.2f);
    style.plain = glm::vec3(1.0f);
    const std::vector<std::uint32_t> pixels = draw(places, {}, {}, nullptr, style);
    const std::vector<double> sums = sum_weights(places, style);
    std::size_t covered = 0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
        const double opacity = 1 - std::exp(-style.strength * sums[i]);
        const double expected = 255 * (0.2 + (1 - 0.2) * opacity);
        // One fixed-point unit per point at its rim, where single precision decides otherwise, and the last bit.
        EXPECT_NEAR(static_cast<double>(pixels[i] & 255), expected, 4.0) << "pixel " << i;
        covered += sums[i] > 0;
    }
    EXPECT_GT(covered, SIDE * SIDE / 2);
}

TEST(SplatPhotons, is_the_same_in_any_order_of_photons) {
    std::vector<glm::vec3> places = scatter_places(3000, 0);
    const std::vector<std::uint32_t> pixels = draw(places);
    std::reverse(places.begin(), places.end());
    EXPECT_EQ(draw(places), pixels);
}

TEST(SplatPhotons, shows_the_colors_of_photons) {
    const std::vector<std::uint32_t> color{0xff3264c8}; // ABGR: red 200, green 100, blue 50
    SplatStyle style;
    style.strength = 50; // opaque
    const std::vector<std::uint32_t> pixels = draw({{0, 0, 0}}, color, {}, nullptr, style);
    const std::uint32_t center = pixels[SIDE / 2 * SIDE + SIDE / 2];
    EXPECT_NEAR(center & 255, 200u, 4u);
    EXPECT_NEAR(center >> 8 & 255, 100u, 4u);
    EXPECT_NEAR(center >> 16 & 255, 50u, 4u);
}

TEST(SplatPhotons, lays_chosen_photons_over_the_others) {
    const std::vector<glm::vec3> places{{0, 0, 0}, {0, 0, 0}};
    const std::vector<std::uint32_t> colors{0xff0000ff, 0xff00ff00};
    SplatStyle style;
    style.strength = 50;
    const std::vector<std::uint32_t> first{1, 0}, second{0, 1};
    const std::size_t center = SIDE / 2 * SIDE + SIDE / 2;
    EXPECT_GT(draw(places, colors, first, nullptr, style)[center] & 255, 240u);
    EXPECT_GT(draw(places, colors, second, nullptr, style)[center] >> 8 & 255, 240u);
}

TEST(SplatPhotons, hides_photons_behind_what_the_camera_sees) {
    const Scene floor = make_floor();
    const SurfaceView view =
        see_surfaces(get_device(), floor, upload_scene(get_device(), floor), look_down(), {SIDE, SIDE});
    SplatStyle style;
    style.strength = 50;
    const std::size_t center = SIDE / 2 * SIDE + SIDE / 2;
    const std::vector<std::uint32_t> none = draw({{5, 0, 5}}, {}, {}, &view, style);
    EXPECT_NE(draw({{0, 0, 0}}, {}, {}, &view, style)[center], none[center]);
    EXPECT_NE(draw({{0, 0.3f, 0}}, {}, {}, &view, style)[center], none[center]);
    EXPECT_EQ(draw({{0, -0.3f, 0}}, {}, {}, &view, style)[center], none[center]);
}

TEST(SplatPhotons, leaves_out_what_is_behind_the_camera_or_beside_the_image) {
    const std::vector<std::uint32_t> empty = draw({{0, 1e6f, 0}});
    EXPECT_EQ(draw({{0, 3, 0}}), empty);
    EXPECT_EQ(draw({{1e20f, 0, 0}, {0, 2, 0}}), empty);
    EXPECT_TRUE(std::all_of(empty.begin(), empty.end(), [&](std::uint32_t pixel) { return pixel == empty[0]; }));
}

} // namespace
} // namespace photonloupe::test
