// SPDX-License-Identifier: Apache-2.0
// The view's camera: orbits a target; projects and aims.
#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "estimate/camera_frame.h"
#include "studio/state.h"

namespace photonloupe::studio {

// Where the camera stands, as renderers take it.
struct CameraPose : Camera {
    std::array<double, 3> target{};
};

CameraPose find_pose(const CameraState& camera);

// Pixels from the image's top left corner, and the depth along the view; behind the camera: depth ≤ 0.
glm::vec3 project(const shared::CameraFrame& frame, glm::vec3 point, std::uint32_t width, std::uint32_t height);
// Unit direction through a pixel.
glm::vec3 aim(const shared::CameraFrame& frame, glm::vec2 pixel, std::uint32_t width, std::uint32_t height);

// So that a box fills the view; keeps the angles.
void fit_box(CameraState& camera, const Bounds& box);
// Straight at a surface of that normal.
void face_normal(CameraState& camera, glm::vec3 normal);

void orbit(CameraState& camera, double right, double up); // radians
void pan(CameraState& camera, double right, double up);   // shares of the view's height
void zoom(CameraState& camera, double steps);             // positive: nearer

} // namespace photonloupe::studio
