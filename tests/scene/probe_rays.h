// SPDX-License-Identifier: Apache-2.0
// Rays and triangles for tests of the kernels' intersection, and a naive twin in double precision.
#pragma once

#include <limits>
#include <random>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "scene/scene.h"

namespace photonloupe::test {

struct ProbeRay {
    glm::vec4 origin{0};
    glm::vec4 direction{0, 0, 0, std::numeric_limits<float>::infinity()}; // w: farthest distance
};

struct ProbeHit {
    float t;
    float b1;
    float b2;
    std::uint32_t triangle;
};

using Corners = std::array<glm::vec3, 3>;

ProbeRay aim(glm::vec3 origin, glm::vec3 target);

// Corners in the order the scene stores them, so that hits' indices are valid here.
std::vector<Corners> list_corners(const Scene& scene);
// A scene of these triangles with its BVH, and one material.
Scene make_scene(const std::vector<Corners>& triangles);

// On the shared device.
std::vector<ProbeHit> intersect(const Scene& scene, const std::vector<ProbeRay>& rays, bool any_hit = false);

// A triangle met by a ray, in double precision. `margin` is the distance in metres between the place where the ray
// meets the plane and the nearest edge, negative outside.
struct ExactHit {
    double t;
    double margin;
};

ExactHit meet_exactly(const Corners& triangle, const ProbeRay& ray);
double measure_distance(const Corners& triangle, glm::dvec3 point);

// Closed: an icosahedron split `levels` times, on the unit sphere, shaken by up to `shake` with vertices kept shared.
std::vector<Corners> make_ball(int levels, float shake, unsigned seed);

glm::vec3 draw_direction(std::mt19937& random);

} // namespace photonloupe::test
