// SPDX-License-Identifier: Apache-2.0
// The kernels' ray-scene intersection against a naive twin in double precision, on random and on nasty geometry.
#include <algorithm>
#include <bit>
#include <cmath>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include "scene/probe_rays.h"

namespace photonloupe::test {
namespace {

// Rounding of coordinates of size 1 to float, of the shear and of the edge functions: some ten of 6e-8 each.
constexpr double TOLERANCE = 2e-6;
constexpr int RAYS = 20'000;

bool is_hit(const ProbeHit& hit) {
    return std::isfinite(hit.t);
}

glm::dvec3 find_point(const ProbeRay& ray, double t) {
    return glm::dvec3(ray.origin) + t * glm::dvec3(ray.direction);
}

std::vector<Corners> make_soup(int count, float size, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<Corners> triangles;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 center = draw_direction(random) * 0.7f;
        const glm::vec3 a = draw_direction(random), b = draw_direction(random), c = draw_direction(random);
        triangles.push_back({center + size * a, center + size * b, center + size * c});
    }
    return triangles;
}

std::vector<ProbeRay> draw_rays(int count, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<ProbeRay> rays;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 origin = draw_direction(random) * 2.0f;
        rays.push_back(aim(origin, draw_direction(random) * 0.7f));
    }
    return rays;
}

// The hit lies on its triangle and nothing that is met clearly lies before it.
void expect_nearest(const Scene& scene, const std::vector<ProbeRay>& rays, double tolerance = TOLERANCE) {
    const std::vector<Corners> triangles = list_corners(scene);
    const std::vector<ProbeHit> hits = intersect(scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE("ray " + std::to_string(i));
        double nearest = std::numeric_limits<double>::infinity();
        for (const Corners& triangle : triangles)
            if (const ExactHit exact = meet_exactly(triangle, rays[i]); exact.t > tolerance && exact.margin > tolerance)
                nearest = std::min(nearest, exact.t);
        ASSERT_LE(hits[i].t, nearest + tolerance * 10);
        if (is_hit(hits[i])) {
            ASSERT_LE(measure_distance(triangles[hits[i].triangle], find_point(rays[i], hits[i].t)), tolerance);
        }
    }
}

TEST(Intersect, random_triangles_are_met_as_by_the_twin) {
    expect_nearest(make_scene(make_soup(500, 0.2f, 1)), draw_rays(RAYS / 4, 2));
}

TEST(Intersect, large_overlapping_triangles_are_met_as_by_the_twin) {
    expect_nearest(make_scene(make_soup(100, 1.5f, 3)), draw_rays(RAYS / 4, 4));
}

TEST(Intersect, one_triangle_is_met_as_by_the_twin) {
    expect_nearest(make_scene(make_soup(1, 1.0f, 5)), draw_rays(1000, 6));
}

TEST(Intersect, barycentric_weights_give_the_point) {
    const Scene scene = make_scene(make_soup(500, 0.2f, 1));
    const std::vector<Corners> triangles = list_corners(scene);
    const std::vector<ProbeRay> rays = draw_rays(RAYS, 7);
    const std::vector<ProbeHit> hits = intersect(scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (is_hit(hits[i])) {
            const auto [a, b, c] = triangles[hits[i].triangle];
            const double b1 = hits[i].b1, b2 = hits[i].b2;
            const glm::dvec3 point = (1 - b1 - b2) * glm::dvec3(a) + b1 * glm::dvec3(b) + b2 * glm::dvec3(c);
            // The distance may be off by the tolerance divided by the cosine; the point is only off the ray's side.
            const glm::dvec3 away = point - glm::dvec3(rays[i].origin);
            ASSERT_LE(glm::length(glm::cross(away, glm::dvec3(rays[i].direction))), TOLERANCE) << "ray " << i;
        }
}

TEST(Intersect, any_hit_agrees_with_nearest_on_whether_there_is_one) {
    const Scene scene = make_scene(make_soup(500, 0.2f, 1));
    const std::vector<ProbeRay> rays = draw_rays(RAYS, 8);
    const std::vector<ProbeHit> nearest = intersect(scene, rays), any = intersect(scene, rays, true);
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(is_hit(nearest[i]), is_hit(any[i])) << "ray " << i;
}

TEST(Intersect, nothing_beyond_the_farthest_distance_is_met) {
    const Scene scene = make_scene(make_soup(500, 0.2f, 1));
    std::vector<ProbeRay> rays = draw_rays(RAYS, 9);
    const std::vector<ProbeHit> whole = intersect(scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        rays[i].direction.w = i % 2 ? whole[i].t : std::nextafter(whole[i].t, 100.0f);
    const std::vector<ProbeHit> cut = intersect(scene, rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        if (is_hit(whole[i])) {
            ASSERT_EQ(is_hit(cut[i]), i % 2 == 0) << "ray " << i;
        }
}

// A strip of slivers 1 m long and 1 µm wide, each sharing its long edges with its neighbors.
std::vector<Corners> make_slivers(int count) {
    std::vector<Corners> triangles;
    const auto left = [](int i) { return glm::vec3(float(i) * 1e-6f, -0.5f, 0); };
    const auto right = [](int i) { return glm::vec3((float(i) + 0.5f) * 1e-6f, 0.5f, 0); };
    for (int i = 0; i < count; ++i) {
        triangles.push_back({left(i), left(i + 1), right(i)});
        triangles.push_back({right(i), left(i + 1), right(i + 1)});
    }
    return triangles;
}

TEST(Intersect, strip_of_slivers_a_million_times_longer_than_wide_lets_nothing_through) {
    constexpr int SLIVERS = 500;
    const Scene scene = make_scene(make_slivers(SLIVERS));
    std::mt19937 random(10);
    std::uniform_real_distribution<float> x(2e-6f, (SLIVERS - 2) * 1e-6f), y(-0.49f, 0.49f), side(-0.5f, 0.5f);
    std::vector<ProbeRay> rays;
    for (int i = 0; i < RAYS; ++i)
        rays.push_back(aim({side(random), side(random), i % 2 ? 1.0f : -1.0f}, {x(random), y(random), 0}));
    const std::vector<ProbeHit> hits = intersect(scene, rays);
    int missed = 0, asked = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        // Rays whose rounded direction leaves the strip are not asked.
        const glm::dvec3 place = find_point(rays[i], -double(rays[i].origin.z) / rays[i].direction.z);
        if (place.x > 1e-6 && place.x < (SLIVERS - 1) * 1e-6)
            ++asked, missed += !is_hit(hits[i]) || std::abs(find_point(rays[i], hits[i].t).z) > TOLERANCE;
    }
    EXPECT_EQ(missed, 0) << "of " << asked;
    EXPECT_GT(asked, RAYS / 2);
}

std::vector<glm::vec3> list_edge_points(const std::vector<Corners>& triangles, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> share(0, 1);
    std::vector<glm::vec3> points;
    for (const Corners& corners : triangles)
        for (int i = 0; i < 3; ++i) {
            const glm::vec3 from = corners[i], to = corners[(i + 1) % 3];
            points.insert(points.end(), {from, (from + to) * 0.5f, from + (to - from) * share(random)});
        }
    return points;
}

int count_leaks(const std::vector<Corners>& closed, const std::vector<glm::vec3>& origins) {
    const Scene scene = make_scene(closed);
    int leaks = 0;
    for (const glm::vec3& origin : origins) {
        std::vector<ProbeRay> rays;
        for (const glm::vec3& point : list_edge_points(closed, 12))
            rays.push_back(aim(origin, point));
        for (const ProbeHit& hit : intersect(scene, rays))
            leaks += !is_hit(hit);
    }
    return leaks;
}

TEST(Intersect, closed_ball_keeps_rays_aimed_at_its_edges_and_vertices) {
    EXPECT_EQ(count_leaks(make_ball(3, 0.05f, 11), {{0, 0, 0}, {0.3f, -0.2f, 0.1f}, {0.01f, 0.7f, 0.0f}}), 0);
}

TEST(Intersect, flattened_ball_keeps_rays_aimed_at_its_edges_and_vertices) {
    std::vector<Corners> flat = make_ball(3, 0.05f, 13);
    for (Corners& corners : flat)
        for (glm::vec3& corner : corners)
            corner.z *= 1e-3f;
    EXPECT_EQ(count_leaks(flat, {{0, 0, 0}, {0.3f, -0.2f, 1e-4f}}), 0);
}

TEST(Intersect, closed_box_keeps_rays_along_its_axes_and_diagonals) {
    std::vector<Corners> box;
    for (int axis = 0; axis < 3; ++axis)
        for (float side : {-1.0f, 1.0f}) {
            glm::vec3 corner[4];
            for (int i = 0; i < 4; ++i) {
                corner[i][axis] = side;
                corner[i][(axis + 1) % 3] = i == 0 || i == 3 ? -1.0f : 1.0f;
                corner[i][(axis + 2) % 3] = i < 2 ? -1.0f : 1.0f;
            }
            box.insert(box.end(), {{corner[0], corner[1], corner[2]}, {corner[0], corner[2], corner[3]}});
        }
    std::vector<ProbeRay> rays;
    for (float x : {-1.0f, -0.0f, 0.0f, 1e-30f, 1.0f})
        for (float y : {-1.0f, -0.0f, 0.0f, 1e-40f, 1.0f})
            for (float z : {-1.0f, -0.0f, 0.0f, 1.0f})
                for (glm::vec3 origin : {glm::vec3(0), glm::vec3(0.5f, 0, 0), glm::vec3(0.25f, -0.5f, 0.125f)})
                    if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == 1.0f)
                        rays.push_back({{origin, 0}, {glm::normalize(glm::vec3(x, y, z)), INFINITY}});
    for (const ProbeHit& hit : intersect(make_scene(box), rays))
        EXPECT_TRUE(is_hit(hit));
}

TEST(Intersect, axis_parallel_rays_are_met_as_by_the_twin) {
    std::mt19937 random(14);
    std::uniform_real_distribution<float> place(-0.8f, 0.8f);
    std::vector<ProbeRay> rays;
    for (int i = 0; i < 3000; ++i) {
        ProbeRay ray;
        ray.origin = {place(random), place(random), place(random), 0};
        ray.direction[std::size_t(i % 3)] = i % 2 ? 1.0f : -1.0f;
        rays.push_back(ray);
    }
    expect_nearest(make_scene(make_soup(500, 0.2f, 1)), rays);
}

TEST(Intersect, duplicated_triangles_are_met_where_one_would_be) {
    const std::vector<Corners> soup = make_soup(100, 0.3f, 15);
    std::vector<Corners> copies;
    for (int i = 0; i < 12; ++i)
        copies.insert(copies.end(), soup.begin(), soup.end());
    const std::vector<ProbeRay> rays = draw_rays(RAYS, 16);
    const std::vector<ProbeHit> once = intersect(make_scene(soup), rays), often = intersect(make_scene(copies), rays);
    for (std::size_t i = 0; i < rays.size(); ++i)
        ASSERT_EQ(once[i].t, often[i].t) << "ray " << i;
}

TEST(Intersect, triangles_of_no_area_are_never_met) {
    std::vector<Corners> triangles;
    for (float x : {-0.5f, 0.0f, 0.25f})
        triangles.insert(triangles.end(), {{glm::vec3(x), glm::vec3(x), glm::vec3(x)},
                                           {glm::vec3(x, -1, 0), glm::vec3(x, 0, 0), glm::vec3(x, 1, 0)},
                                           {glm::vec3(x, -1, 0), glm::vec3(x, -1, 0), glm::vec3(x, 1, 0)}});
    std::vector<ProbeRay> rays = draw_rays(1000, 17);
    for (float x : {-0.5f, 0.0f, 0.25f})
        for (glm::vec3 target : {glm::vec3(x), glm::vec3(x, 0, 0), glm::vec3(x, 0.5f, 0)})
            rays.push_back(aim({x, 0.1f, 1.0f}, target));
    for (const ProbeHit& hit : intersect(make_scene(triangles), rays))
        EXPECT_FALSE(is_hit(hit));
}

TEST(Intersect, scene_without_triangles_is_never_met) {
    for (const ProbeHit& hit : intersect(make_scene({}), draw_rays(1000, 18)))
        EXPECT_FALSE(is_hit(hit));
}

class IntersectScaled : public ::testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(, IntersectScaled, ::testing::Values(-20, 20),
                         [](const auto& info) { return info.param < 0 ? "down" : "up"; });

TEST_P(IntersectScaled, scene_gives_the_same_bits_scaled) {
    const float scale = std::ldexp(1.0f, GetParam());
    std::vector<Corners> triangles = make_soup(500, 0.2f, 1);
    std::vector<ProbeRay> rays = draw_rays(RAYS, 19);
    const std::vector<ProbeHit> hits = intersect(make_scene(triangles), rays);
    for (Corners& corners : triangles)
        for (glm::vec3& corner : corners)
            corner *= scale;
    for (ProbeRay& ray : rays)
        ray.origin *= scale;
    const std::vector<ProbeHit> scaled = intersect(make_scene(triangles), rays);
    for (std::size_t i = 0; i < rays.size(); ++i) {
        ASSERT_EQ(scaled[i].t, hits[i].t * scale) << "ray " << i;
        ASSERT_EQ(scaled[i].triangle, hits[i].triangle) << "ray " << i;
        ASSERT_EQ(scaled[i].b1, hits[i].b1) << "ray " << i;
    }
}

} // namespace
} // namespace photonloupe::test
