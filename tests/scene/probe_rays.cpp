// SPDX-License-Identifier: Apache-2.0
// Runs the intersection probe, and computes what it should find.
#include "scene/probe_rays.h"

#include <algorithm>
#include <map>

#include <glm/geometric.hpp>

#include "scene/bvh.h"
#include "scene/scene_buffers.h"
#include "support/shared_device.h"

namespace photonloupe::test {

ProbeRay aim(glm::vec3 origin, glm::vec3 target) {
    const glm::vec3 direction(glm::normalize(glm::dvec3(target) - glm::dvec3(origin)));
    return {{origin, 0.0f}, {direction, std::numeric_limits<float>::infinity()}};
}

std::vector<Corners> list_corners(const Scene& scene) {
    std::vector<Corners> corners;
    for (const shared::Triangle& triangle : scene.triangles)
        corners.push_back(
            {glm::vec3(triangle.v0_object), glm::vec3(triangle.v1_material), glm::vec3(triangle.v2_source)});
    return corners;
}

Scene make_scene(const std::vector<Corners>& triangles) {
    Scene scene;
    for (const Corners& corners : triangles)
        scene.triangles.push_back({{corners[0], 0.0f}, {corners[1], 0.0f}, {corners[2], 0.0f}});
    scene.normals.resize(triangles.size());
    build_bvh(scene);
    scene.materials.resize(1);
    return scene;
}

std::vector<ProbeHit> intersect(const Scene& scene, const std::vector<ProbeRay>& rays, bool any_hit) {
    gpu::Device& device = get_device();
    const SceneBuffers buffers = upload_scene(device, scene);
    const gpu::Buffer input = gpu::make_buffer(device, rays, "probe rays");
    const gpu::Buffer output(device, rays.size() * sizeof(ProbeHit), "probe hits");
    const auto count = static_cast<std::uint32_t>(rays.size());
    gpu::Commands commands(device, "probe");
    commands.dispatch({"probe_intersect.comp", 64, {any_hit ? "ANY_HIT true" : "ANY_HIT false"}, {}},
                      {{"geometry", buffers.geometry}, {"inputs", input}, {"outputs", output}}, count, count);
    commands.run();
    return output.read<ProbeHit>(rays.size());
}

ExactHit meet_exactly(const Corners& triangle, const ProbeRay& ray) {
    const glm::dvec3 origin(ray.origin), direction(ray.direction);
    const glm::dvec3 a(triangle[0]), b(triangle[1]), c(triangle[2]);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double t = glm::dot(normal, a - origin) / glm::dot(normal, direction);
    const glm::dvec3 point = origin + t * direction;
    const auto measure_side = [&](const glm::dvec3& from, const glm::dvec3& to) {
        const glm::dvec3 inward = glm::cross(normal, to - from);
        return glm::dot(point - from, inward) / glm::length(inward);
    };
    return {t, std::min({measure_side(a, b), measure_side(b, c), measure_side(c, a)})};
}

double measure_distance(const Corners& triangle, glm::dvec3 point) {
    const glm::dvec3 corners[] = {glm::dvec3(triangle[0]), glm::dvec3(triangle[1]), glm::dvec3(triangle[2])};
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 from = corners[i], along = corners[(i + 1) % 3] - from;
        const double length2 = glm::dot(along, along);
        const double share = length2 > 0 ? std::clamp(glm::dot(point - from, along) / length2, 0.0, 1.0) : 0.0;
        nearest = std::min(nearest, glm::length(point - from - share * along));
    }
    const glm::dvec3 normal = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double area2 = glm::length(normal);
    if (area2 == 0)
        return nearest;
    const double height = glm::dot(point - corners[0], normal) / area2;
    const glm::vec3 start(point + normal * (2 / area2));
    const ProbeRay down{{start, 0}, {glm::vec3(-normal / area2), 0}};
    return meet_exactly(triangle, down).margin >= 0 ? std::abs(height) : nearest;
}

std::vector<Corners> make_ball(int levels, float shake, unsigned seed) {
    const float g = 1.618034f;
    const glm::vec3 v[12] = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                             {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
    const int faces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                              {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                              {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
    std::vector<Corners> triangles;
    for (const auto& face : faces)
        triangles.push_back({v[face[0]], v[face[1]], v[face[2]]});
    for (int level = 0; level < levels; ++level) {
        std::vector<Corners> finer;
        for (const auto& [a, b, c] : triangles) {
            const glm::vec3 ab = (a + b) * 0.5f, bc = (b + c) * 0.5f, ca = (c + a) * 0.5f;
            finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
        }
        triangles = std::move(finer);
    }
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> factor(1 - shake, 1 + shake);
    std::map<std::array<float, 3>, glm::vec3> moved; // equal corners stay equal
    for (Corners& corners : triangles)
        for (glm::vec3& corner : corners) {
            auto [place, is_new] = moved.try_emplace({corner.x, corner.y, corner.z});
            if (is_new)
                place->second = glm::normalize(corner) * factor(random);
            corner = place->second;
        }
    return triangles;
}

glm::vec3 draw_direction(std::mt19937& random) {
    std::normal_distribution<double> normal;
    const double x = normal(random), y = normal(random), z = normal(random);
    return glm::vec3(glm::normalize(glm::dvec3(x, y, z)));
}

} // namespace photonloupe::test
