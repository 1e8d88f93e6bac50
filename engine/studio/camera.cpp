// SPDX-License-Identifier: Apache-2.0
// Turns the orbit into a pose; projects and aims.
#include "studio/camera.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace photonloupe::studio {
namespace {

constexpr double STEEPEST = 1.5707; // just short of the pole, where "up" has no direction
constexpr double ZOOM_STEP = 0.85;
constexpr double NEAREST = 1e-12, FARTHEST = 1e15;

glm::dvec3 to_vector(const std::array<double, 3>& values) {
    return {values[0], values[1], values[2]};
}
std::array<double, 3> to_array(glm::dvec3 vector) {
    return {vector.x, vector.y, vector.z};
}

} // namespace

CameraPose find_pose(const CameraState& camera) {
    const double pitch = std::clamp(camera.pitch, -STEEPEST, STEEPEST);
    const glm::dvec3 backward{std::cos(pitch) * std::sin(camera.yaw), std::sin(pitch),
                              std::cos(pitch) * std::cos(camera.yaw)};
    const glm::dvec3 right{std::cos(camera.yaw), 0, -std::sin(camera.yaw)};
    CameraPose pose;
    pose.target = camera.target;
    pose.position = to_array(to_vector(camera.target) + backward * camera.distance);
    pose.right = to_array(right);
    pose.up = to_array(glm::cross(backward, right));
    pose.backward = to_array(backward);
    pose.yfov = camera.yfov;
    return pose;
}

glm::vec3 project(const shared::CameraFrame& frame, glm::vec3 point, std::uint32_t width, std::uint32_t height) {
    const glm::vec3 to_point = point - glm::vec3(frame.position);
    const glm::vec3 right(frame.right), up(frame.up);
    const float depth = glm::dot(to_point, glm::vec3(frame.forward));
    const float x = glm::dot(to_point, right) / (glm::dot(right, right) * depth);
    const float y = glm::dot(to_point, up) / (glm::dot(up, up) * depth);
    return {(x + 1) * 0.5f * static_cast<float>(width), (1 - y) * 0.5f * static_cast<float>(height), depth};
}

glm::vec3 aim(const shared::CameraFrame& frame, glm::vec2 pixel, std::uint32_t width, std::uint32_t height) {
    const float x = 2 * pixel.x / static_cast<float>(width) - 1;
    const float y = 1 - 2 * pixel.y / static_cast<float>(height);
    return glm::normalize(glm::vec3(frame.forward) + x * glm::vec3(frame.right) + y * glm::vec3(frame.up));
}

void fit_box(CameraState& camera, const Bounds& box) {
    double radius2 = 0;
    for (int i = 0; i < 3; ++i) {
        camera.target[i] = 0.5 * (box.lo[i] + box.hi[i]);
        radius2 += 0.25 * (box.hi[i] - box.lo[i]) * (box.hi[i] - box.lo[i]);
    }
    const double radius = radius2 > 0 ? std::sqrt(radius2) : 1.0;
    camera.distance = std::clamp(radius / std::sin(0.5 * camera.yfov), NEAREST, FARTHEST);
    camera.is_set = true;
}

void face_normal(CameraState& camera, glm::vec3 normal) {
    const float across = std::hypot(normal.x, normal.z);
    camera.pitch =
        std::clamp(std::atan2(static_cast<double>(normal.y), static_cast<double>(across)), -STEEPEST, STEEPEST);
    // Straight down there is no yaw to be had from the normal: north is up.
    camera.yaw = across > 1e-3f ? std::atan2(normal.x, normal.z) : 0.0;
}

void orbit(CameraState& camera, double right, double up) {
    camera.yaw = std::remainder(camera.yaw - right, 2 * 3.14159265358979323846);
    camera.pitch = std::clamp(camera.pitch + up, -STEEPEST, STEEPEST);
}

void pan(CameraState& camera, double right, double up) {
    const CameraPose pose = find_pose(camera);
    const double scale = 2 * camera.distance * std::tan(0.5 * camera.yfov);
    for (int i = 0; i < 3; ++i)
        camera.target[i] -= scale * (right * pose.right[i] + up * pose.up[i]);
}

void zoom(CameraState& camera, double steps) {
    camera.distance = std::clamp(camera.distance * std::pow(ZOOM_STEP, steps), NEAREST, FARTHEST);
}

} // namespace photonloupe::studio
