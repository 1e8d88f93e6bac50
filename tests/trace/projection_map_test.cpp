// SPDX-License-Identifier: Apache-2.0
// Projection maps: no direction toward specular geometry is left out, and solid angles are what they should be.
#include "trace/projection_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include "scene/probe_rays.h"

namespace photonloupe::test {
namespace {

std::int64_t budget = 1ll << 40; // all there is to be had
constexpr double SPHERE = 4 * std::numbers::pi;

Scene make_mirrors(const std::vector<Corners>& triangles) {
    Scene scene = make_scene(triangles);
    scene.materials[0].base_color_metallic.w = 1;
    return scene;
}

shared::Light make_light(glm::vec3 position) {
    shared::Light light{};
    light.position_kind = {position, 0.0f};
    light.intensity = glm::vec4(1);
    return light;
}

ProjectionMap project(const Scene& scene, const shared::Light& light) {
    return project_light(scene, frame_emission(scene, light, true), true, budget);
}

std::uint32_t find_cell(const ProjectionMap& map, const glm::dvec3& toward) {
    const glm::dvec3 direction = glm::normalize(toward);
    const auto row = std::min(map.rows - 1, std::uint32_t((1 - direction.y) * 0.5 * map.rows));
    const double turn = std::atan2(direction.z, direction.x) / (2 * std::numbers::pi);
    return row << 16 | std::min(map.columns - 1, std::uint32_t((turn - std::floor(turn)) * map.columns));
}

// Points all over the triangle, crowded at its corners and edges.
std::vector<glm::dvec3> draw_points(const Corners& corners, int count, std::mt19937& random) {
    std::uniform_real_distribution<double> uniform(0, 1);
    std::vector<glm::dvec3> points{glm::dvec3(corners[0]), glm::dvec3(corners[1]), glm::dvec3(corners[2])};
    for (int i = 0; i < count; ++i) {
        const double power = i % 3 == 0 ? 1 : i % 3 == 1 ? 8 : 30;
        glm::dvec3 weights(uniform(random), uniform(random), uniform(random));
        weights = {std::pow(weights.x, power), std::pow(weights.y, power), std::pow(weights.z, power)};
        weights /= weights.x + weights.y + weights.z;
        points.push_back(weights.x * glm::dvec3(corners[0]) + weights.y * glm::dvec3(corners[1]) +
                         weights.z * glm::dvec3(corners[2]));
    }
    return points;
}

void expect_covered(const std::vector<Corners>& triangles, glm::vec3 position, int points_each = 300) {
    const ProjectionMap map = project(make_mirrors(triangles), make_light(position));
    const std::set<std::uint32_t> cells(map.cells.begin(), map.cells.end());
    std::mt19937 random(1);
    for (const Corners& corners : triangles)
        for (const glm::dvec3& point : draw_points(corners, points_each, random)) {
            const glm::dvec3 toward = point - glm::dvec3(position);
            if (toward != glm::dvec3(0)) {
                ASSERT_TRUE(cells.contains(find_cell(map, toward)))
                    << "toward " << toward.x << ", " << toward.y << ", " << toward.z;
            }
        }
}

std::vector<Corners> draw_triangles(int count, float size, float distance, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Corners> triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 center = distance * draw_direction(random);
        const glm::vec3 a = draw_direction(random), b = draw_direction(random), c = draw_direction(random);
        triangles.push_back({center + size * a, center + size * b, center + size * c});
    }
    return triangles;
}

TEST(ProjectionMap, covers_random_triangles) {
    for (unsigned seed = 0; seed < 50; ++seed)
        expect_covered(draw_triangles(1, 0.3f, 1.0f, seed), {0.1f, 0.2f, 0.3f});
}

TEST(ProjectionMap, covers_many_small_triangles) {
    expect_covered(draw_triangles(2000, 0.01f, 1.0f, 3), {0, 0, 0}, 20);
}

TEST(ProjectionMap, covers_triangles_larger_than_their_distance) {
    for (unsigned seed = 0; seed < 20; ++seed)
        expect_covered(draw_triangles(3, 5.0f, 1.0f, seed), {0, 0, 0});
}

TEST(ProjectionMap, covers_tiny_and_distant_triangles) {
    expect_covered(draw_triangles(5, 1e-6f, 1.0f, 4), {0, 0, 0});
    expect_covered(draw_triangles(5, 1.0f, 1e5f, 5), {0, 0, 0});
}

TEST(ProjectionMap, covers_slivers) {
    for (const glm::vec3& along : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0.6f, 0, 0.8f)})
        expect_covered({{glm::vec3(0.3f) - 2.0f * along, glm::vec3(0.3f) + 2.0f * along,
                         glm::vec3(0.3f, 0.300002f, 0.3f) + along}},
                       {0, 0, 0}, 3000);
}

TEST(ProjectionMap, covers_geometry_over_the_poles_and_the_seam) {
    for (const glm::vec3& center :
         {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0, 1, 1e-7f)})
        for (float size : {1e-4f, 0.1f, 3.0f})
            expect_covered({{center + size * glm::vec3(1, 0, 0.3f), center + size * glm::vec3(-0.6f, 0.1f, 0.5f),
                             center + size * glm::vec3(0.1f, -0.2f, -1)}},
                           {0, 0, 0}, 3000);
}

TEST(ProjectionMap, covers_a_closed_mirror_around_the_light) {
    expect_covered(make_ball(2, 0.1f, 6), {0.2f, -0.1f, 0.3f}, 50);
}

TEST(ProjectionMap, covers_geometry_that_touches_the_light) {
    const Corners corners{glm::vec3(0, 0, 0), glm::vec3(1, 0, 0), glm::vec3(0, 0, 1)};
    for (const glm::vec3& light : {corners[0], (corners[0] + corners[1]) * 0.5f, glm::vec3(0.25f, 0, 0.25f),
                                   glm::vec3(0.25f, 1e-7f, 0.25f), glm::vec3(2, 0, 0), glm::vec3(-1e-6f, 0, -1e-6f)})
        expect_covered({corners}, light, 3000);
}

TEST(ProjectionMap, of_everything_is_the_whole_sphere) {
    EXPECT_DOUBLE_EQ(make_full_projection().find_share(), 1);
}

TEST(ProjectionMap, of_a_closed_mirror_is_the_whole_sphere) {
    const Scene scene = make_mirrors(make_ball(2, 0.1f, 7));
    EXPECT_DOUBLE_EQ(project(scene, make_light({0, 0, 0})).find_share(), 1);
}

TEST(ProjectionMap, solid_angle_is_the_sum_of_its_cells) {
    const ProjectionMap map = project(make_mirrors(draw_triangles(10, 0.2f, 1, 8)), make_light({0, 0, 0}));
    EXPECT_DOUBLE_EQ(map.find_share() * SPHERE, double(map.cells.size()) * SPHERE / map.rows / map.columns);
}

// Van Oosterom and Strackee 1983.
double find_solid_angle(const Corners& corners) {
    const glm::dvec3 a = glm::normalize(glm::dvec3(corners[0])), b = glm::normalize(glm::dvec3(corners[1])),
                     c = glm::normalize(glm::dvec3(corners[2]));
    return 2 *
           std::abs(std::atan2(glm::dot(a, glm::cross(b, c)), 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a)));
}

TEST(ProjectionMap, exceeds_the_geometry_by_its_border_only) {
    for (float size : {0.05f, 0.2f, 1.0f}) {
        const Corners corners{glm::vec3(1, -size, -size), glm::vec3(1, size, -size), glm::vec3(1, 0, size)};
        const double exact = find_solid_angle(corners);
        const double marked = project(make_mirrors({corners}), make_light({0, 0, 0})).find_share() * SPHERE;
        EXPECT_GT(marked, exact) << size;
        EXPECT_LT(marked, exact * 1.25) << size;
    }
}

TEST(ProjectionMap, leaves_out_what_is_not_specular) {
    const ProjectionMap map = project(make_scene(draw_triangles(10, 0.2f, 1, 9)), make_light({0, 0, 0}));
    EXPECT_TRUE(map.cells.empty());
}

TEST(ProjectionMap, lists_its_cells_row_by_row) {
    const ProjectionMap map = project(make_mirrors(draw_triangles(10, 0.2f, 1, 10)), make_light({0, 0, 0}));
    ASSERT_EQ(map.row_members.size(), map.rows);
    std::uint32_t next = 0;
    for (std::uint32_t row = 0; row < map.rows; ++row) {
        EXPECT_EQ(map.row_members[row].x, next);
        for (std::uint32_t i = 0; i < map.row_members[row].y; ++i)
            EXPECT_EQ(map.cells.at(next++) >> 16, row);
    }
    EXPECT_EQ(next, map.cells.size());
    EXPECT_TRUE(std::is_sorted(map.cells.begin(), map.cells.end()));
}

} // namespace
} // namespace photonloupe::test
