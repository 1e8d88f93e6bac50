// SPDX-License-Identifier: Apache-2.0
// Finds or makes the camera and brings it into map coordinates.
#include "estimate/camera_frame.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <glm/geometric.hpp>

#include "core/error.h"

namespace photonloupe {
namespace {

using glm::dvec3;

dvec3 to_vector(const std::array<double, 3>& v) {
    return {v[0], v[1], v[2]};
}
std::array<double, 3> to_array(const dvec3& v) {
    return {v.x, v.y, v.z};
}

constexpr double SHORTEST = 1e-30; // of a vector with a direction

// Of any length that a double has; empty: it has no direction.
std::optional<dvec3> find_direction(const dvec3& vector) {
    const double largest = std::max({std::abs(vector.x), std::abs(vector.y), std::abs(vector.z)});
    if (!(largest > SHORTEST))
        return std::nullopt;
    return glm::normalize(vector / largest);
}

// Looks down at the bounds from above and in front, far enough to see all of them.
Camera fit_camera(const Scene& scene) {
    const dvec3 lo = to_vector(scene.bounds.lo), hi = to_vector(scene.bounds.hi);
    const double radius = std::max(0.5 * glm::length(hi - lo), 1e-30);
    Camera camera;
    camera.name = "fitted";
    const dvec3 backward = glm::normalize(dvec3(0.5, 0.9, 1.0));
    const dvec3 right = glm::normalize(glm::cross(dvec3(0, 1, 0), backward));
    camera.position = to_array((lo + hi) * 0.5 + backward * (radius / std::sin(0.5 * camera.yfov)));
    camera.right = to_array(right);
    camera.up = to_array(glm::cross(backward, right));
    camera.backward = to_array(backward);
    return camera;
}

} // namespace

Camera aim_camera(const std::array<double, 3>& position, const std::array<double, 3>& target,
                  const std::array<double, 3>& up, double yfov) {
    const std::optional<dvec3> backward = find_direction(to_vector(position) - to_vector(target));
    if (!backward)
        throw ArgumentError("the camera's position and target are one point; it looks nowhere");
    const std::optional<dvec3> right = find_direction(glm::cross(to_vector(up), *backward));
    if (!right)
        throw ArgumentError("the camera's up lies along its view; choose another");
    Camera camera;
    camera.position = position;
    camera.right = to_array(*right);
    camera.up = to_array(glm::cross(*backward, *right));
    camera.backward = to_array(*backward);
    camera.yfov = yfov;
    return camera;
}

Camera find_camera(const Scene& scene, const CameraChoice& choice) {
    if (choice.placed)
        return *choice.placed;
    const std::string& name = choice.name;
    if (name.empty())
        return scene.cameras.empty() ? fit_camera(scene) : scene.cameras.front();
    std::string names;
    for (const Camera& camera : scene.cameras) {
        if (camera.name == name)
            return camera;
        names += (names.empty() ? "" : ", ") + camera.name;
    }
    throw SceneError(scene.path.string() + ": no camera '" + name + "'; there " +
                     (names.empty() ? "are none, leave the name out" : "are: " + names));
}

shared::CameraFrame frame_camera(const std::array<double, 3>& origin, const Camera& camera, std::uint32_t width,
                                 std::uint32_t height) {
    const double reach_up = std::tan(0.5 * camera.yfov);
    const double reach_right = reach_up * width / height;
    const glm::vec3 position(to_vector(camera.position) - to_vector(origin));
    return {glm::vec4(position, 1.0f), glm::vec4(glm::vec3(to_vector(camera.right) * reach_right), 0.0f),
            glm::vec4(glm::vec3(to_vector(camera.up) * reach_up), 0.0f),
            glm::vec4(glm::vec3(-to_vector(camera.backward)), 0.0f)};
}

} // namespace photonloupe
