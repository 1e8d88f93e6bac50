// SPDX-License-Identifier: Apache-2.0
// Squares of power: shares are integrals of what shines, and no way from a light to geometry is left out of its map.
#include "trace/emission_frame.h"

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include "scene/emitting_objects.h"
#include "scene/probe_rays.h"
#include "trace/projection_map.h"

namespace photonloupe::test {
namespace {

using glm::dvec3;

std::int64_t budget = 1ll << 40; // all there is to be had

shared::Light make_spot(double inner, double outer) {
    const auto cap = [](double angle) { return static_cast<float>(1 - std::cos(angle)); };
    return {{0.1f, 2.0f, 0.3f, std::bit_cast<float>(shared::LIGHT_SPOT)},
            glm::vec4(1),
            glm::vec4(glm::normalize(glm::vec3(0.2f, -1.0f, 0.4f)), 0),
            {cap(inner), cap(outer), 0, 0}};
}

TEST(EmissionFrame, share_of_a_spot_is_the_integral_of_its_profile) {
    const double inner = 0.4, outer = 0.9;
    const EmissionFrame frame = frame_emission(Scene{}, make_spot(inner, outer), true);
    const auto shine = [&](double angle) {
        const double ramp = (std::cos(angle) - std::cos(outer)) / (std::cos(inner) - std::cos(outer));
        return std::pow(std::clamp(ramp, 0.0, 1.0), 2) * 2 * std::numbers::pi * std::sin(angle);
    };
    constexpr int STEPS = 100'000;
    const double step = outer / STEPS;
    double sum = 0;
    std::vector<double> sums;
    for (int i = 0; i < STEPS; ++i)
        sums.push_back(sum += shine((i + 0.5) * step) * step);
    EXPECT_NEAR(frame.find_measure({}), sum, 1e-6 * sum);
    for (int i = 999; i < STEPS; i += 1000)
        EXPECT_NEAR(frame.find_share((i + 1) * step), sums[i] / sum, 1e-6);
    EXPECT_GT(frame.find_share(outer + 1e-4), 1);
    EXPECT_NEAR(frame.widest(), outer, 1e-6);
}

// Where on the square a photon from `origin` along `direction` lies.
std::uint32_t find_cell(const ProjectionMap& map, const EmissionFrame& frame, const dvec3& direction) {
    const double cosine = glm::dot(direction, frame.axis);
    const double share = frame.find_share(std::acos(std::clamp(cosine, -1.0, 1.0)));
    const double turn = std::atan2(glm::dot(direction, frame.v), glm::dot(direction, frame.u)) / (2 * std::numbers::pi);
    const auto row = std::min(map.rows - 1, static_cast<std::uint32_t>(share * map.rows));
    return row << 16 | std::min(map.columns - 1, static_cast<std::uint32_t>((turn - std::floor(turn)) * map.columns));
}

glm::vec3 draw_vector(std::mt19937& random) {
    return draw_direction(random) * std::uniform_real_distribution<float>(0, 1)(random);
}

dvec3 draw_point(const Corners& corners, std::mt19937& random) {
    std::exponential_distribution<double> draw(1);
    const double a = draw(random), b = draw(random), c = draw(random);
    return (a * dvec3(corners[0]) + b * dvec3(corners[1]) + c * dvec3(corners[2])) / (a + b + c);
}

Scene make_mirrors(const std::vector<Corners>& triangles) {
    Scene scene = make_scene(triangles);
    scene.materials[0].base_color_metallic.w = 1;
    return scene;
}

TEST(EmissionFrame, no_way_from_a_spot_is_left_out) {
    std::mt19937 random(1);
    for (const auto& [inner, outer] : {std::pair(0.1, 0.5), {0.0, 1.5}, {0.02, 0.03}}) {
        const shared::Light light = make_spot(inner, outer);
        const dvec3 at(light.position_kind), along(light.direction);
        std::vector<Corners> triangles;
        for (int i = 0; i < 20; ++i)
            triangles.push_back({glm::vec3(at + along * (1.0 + 0.1 * i)) + 0.2f * draw_vector(random),
                                 glm::vec3(at + along * 2.0) + 0.4f * draw_vector(random),
                                 glm::vec3(at + along * 1.5) + 0.3f * draw_vector(random)});
        const Scene scene = make_mirrors(triangles);
        const EmissionFrame frame = frame_emission(scene, light, true);
        const ProjectionMap map = project_light(scene, frame, true, budget);
        const std::set<std::uint32_t> cells(map.cells.begin(), map.cells.end());
        for (int i = 0; i < 20'000; ++i) {
            const dvec3 direction = glm::normalize(draw_point(triangles[i % 20], random) - at);
            if (std::acos(glm::dot(direction, along)) < 0.999 * outer)
                ASSERT_TRUE(cells.contains(find_cell(map, frame, direction))) << i;
        }
    }
}

// A panel of two triangles and mirrors near it, some as near as it is wide.
TEST(EmissionFrame, no_way_from_a_panel_is_left_out) {
    std::mt19937 random(2);
    for (const bool is_two_sided : {false, true}) {
        const Corners lower{{{-0.3f, 1, -0.2f}, {0.3f, 1.1f, -0.2f}, {0.3f, 1.1f, 0.2f}}};
        const Corners upper{{{-0.3f, 1, -0.2f}, {0.3f, 1.1f, 0.2f}, {-0.3f, 1, 0.2f}}};
        std::vector<Corners> triangles;
        for (int i = 0; i < 12; ++i) {
            const glm::vec3 middle = 1.5f * draw_vector(random);
            triangles.push_back({middle, middle + 0.2f * draw_vector(random), middle + 0.1f * draw_vector(random)});
        }
        Scene scene = make_scene(triangles);
        scene.materials[0].base_color_metallic.w = 1;
        shared::Material lamp{};
        lamp.emission_transmission = {1, 1, 1, 0};
        lamp.roughness_thin.z = is_two_sided;
        scene.materials.push_back(lamp);
        scene.objects = {{"mirrors", 0, 12}, {"lamp", 1, 2}};
        for (const Corners& corners : {lower, upper})
            scene.triangles.push_back(
                {{corners[0], std::bit_cast<float>(static_cast<std::uint32_t>(scene.objects.size() - 1))},
                 {corners[1], std::bit_cast<float>(1u)},
                 {corners[2], 0.0f}});
        list_emitting_objects(scene);
        ASSERT_EQ(scene.lights.size(), 1u);
        const EmissionFrame frame = frame_emission(scene, scene.lights[0], true);
        EXPECT_TRUE(frame.is_flat);
        EXPECT_EQ(frame.sides, is_two_sided ? 2 : 1);
        const ProjectionMap map = project_light(scene, frame, true, budget);
        const std::set<std::uint32_t> cells(map.cells.begin(), map.cells.end());
        int shone = 0;
        for (int i = 0; i < 20'000; ++i) {
            const dvec3 from = draw_point(i % 2 ? lower : upper, random);
            const dvec3 direction = glm::normalize(draw_point(triangles[i % 12], random) - from);
            if (!is_two_sided && glm::dot(direction, frame.axis) < 1e-3)
                continue;
            ++shone;
            ASSERT_TRUE(cells.contains(find_cell(map, frame, direction))) << i;
        }
        EXPECT_GT(shone, 1000);
    }
}

TEST(EmissionFrame, no_start_of_directional_light_is_left_out) {
    std::mt19937 random(3);
    std::vector<Corners> triangles;
    for (int i = 0; i < 20; ++i) {
        const glm::vec3 middle = 2.0f * draw_vector(random);
        triangles.push_back({middle, middle + 0.3f * draw_vector(random), middle + 0.02f * draw_vector(random)});
    }
    const Scene scene = make_mirrors(triangles);
    const shared::Light sun{{0, 0, 0, std::bit_cast<float>(shared::LIGHT_DIRECTIONAL)},
                            glm::vec4(1),
                            glm::vec4(glm::normalize(glm::vec3(0.3f, -1, 0.1f)), 0),
                            glm::vec4(0)};
    const EmissionFrame frame = frame_emission(scene, sun, true);
    const ProjectionMap map = project_light(scene, frame, true, budget);
    EXPECT_LT(map.find_share(), 0.5);
    const std::set<std::uint32_t> cells(map.cells.begin(), map.cells.end());
    for (int i = 0; i < 20'000; ++i) {
        const dvec3 d = draw_point(triangles[i % 20], random) - frame.origin;
        EXPECT_GT(glm::dot(d, frame.axis), 0) << "it starts before everything";
        const auto find = [&](const dvec3& axis, std::uint32_t count) {
            const double share = glm::dot(d, axis) / glm::dot(axis, axis);
            return std::min(count - 1, static_cast<std::uint32_t>(std::max(share, 0.0) * count));
        };
        ASSERT_TRUE(cells.contains(find(frame.v, map.rows) << 16 | find(frame.u, map.columns))) << i;
    }
}

} // namespace
} // namespace photonloupe::test
