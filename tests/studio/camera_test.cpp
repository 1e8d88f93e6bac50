// SPDX-License-Identifier: Apache-2.0
// The view's camera: aiming undoes projecting, boxes fit, limits hold.
#include <cmath>
#include <random>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include "studio/camera.h"

namespace photonloupe::studio {
namespace {

constexpr std::uint32_t WIDTH = 640, HEIGHT = 360;

double measure(const std::array<double, 3>& a, const std::array<double, 3>& b) {
    return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(Camera, aim_undoes_project) {
    std::mt19937 engine(1);
    std::uniform_real_distribution<float> place(-0.5f, 0.5f);
    CameraState camera;
    camera.target = {1000.5, -3, 2};
    camera.distance = 4;
    const CameraPose pose = find_pose(camera);
    const shared::CameraFrame frame = frame_camera({1000, 0, 0}, pose, WIDTH, HEIGHT);
    for (int i = 0; i < 100; ++i) {
        const glm::vec3 point = glm::vec3(0.5f, -3, 2) + glm::vec3(place(engine), place(engine), place(engine));
        const glm::vec3 pixel = project(frame, point, WIDTH, HEIGHT);
        ASSERT_GT(pixel.z, 0);
        const glm::vec3 way = aim(frame, {pixel.x, pixel.y}, WIDTH, HEIGHT);
        EXPECT_NEAR(glm::dot(way, glm::normalize(point - glm::vec3(frame.position))), 1, 1e-5);
    }
}

TEST(Camera, target_is_in_the_middle_and_depth_is_distance) {
    CameraState camera;
    camera.target = {1, 2, 3};
    camera.distance = 5;
    const shared::CameraFrame frame = frame_camera({}, find_pose(camera), WIDTH, HEIGHT);
    const glm::vec3 pixel = project(frame, {1, 2, 3}, WIDTH, HEIGHT);
    EXPECT_NEAR(pixel.x, WIDTH / 2.0f, 1e-2);
    EXPECT_NEAR(pixel.y, HEIGHT / 2.0f, 1e-2);
    EXPECT_NEAR(pixel.z, 5, 1e-4);
}

TEST(Camera, right_is_right_and_up_is_up) {
    CameraState camera;
    camera.yaw = camera.pitch = 0;
    const shared::CameraFrame frame = frame_camera({}, find_pose(camera), WIDTH, HEIGHT);
    EXPECT_GT(project(frame, {0.1f, 0, 0}, WIDTH, HEIGHT).x, WIDTH / 2.0f);
    EXPECT_LT(project(frame, {0, 0.1f, 0}, WIDTH, HEIGHT).y, HEIGHT / 2.0f);
    EXPECT_LE(project(frame, {0, 0, 2}, WIDTH, HEIGHT).z, 0);
}

TEST(Camera, pose_is_orthonormal_even_at_the_pole) {
    for (const double pitch : {-9.0, -1.5708, 0.0, 1.5708, 9.0}) {
        CameraState camera;
        camera.pitch = pitch;
        const CameraPose pose = find_pose(camera);
        for (const auto& axis : {pose.right, pose.up, pose.backward})
            EXPECT_NEAR(measure(axis, {}), 1, 1e-12);
        double across = 0;
        for (std::size_t i = 0; i < 3; ++i)
            across += pose.right[i] * pose.up[i];
        EXPECT_NEAR(across, 0, 1e-12);
    }
}

TEST(Camera, fitted_box_is_within_the_view) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
        CameraState camera;
        fit_box(camera, {{-scale, -2 * scale, 0}, {scale, 2 * scale, 3 * scale}});
        EXPECT_TRUE(camera.is_set);
        const shared::CameraFrame frame = frame_camera({}, find_pose(camera), WIDTH, HEIGHT);
        const auto size = static_cast<float>(scale);
        for (int corner = 0; corner < 8; ++corner) {
            const glm::vec3 at(corner & 1 ? size : -size, corner & 2 ? 2 * size : -2 * size, corner & 4 ? 3 * size : 0);
            const glm::vec3 pixel = project(frame, at, WIDTH, HEIGHT);
            EXPECT_GT(pixel.z, 0);
            EXPECT_TRUE(pixel.x >= 0 && pixel.x <= WIDTH && pixel.y >= 0 && pixel.y <= HEIGHT) << scale;
        }
    }
}

TEST(Camera, box_of_one_point_can_be_looked_at) {
    CameraState camera;
    fit_box(camera, {{1, 1, 1}, {1, 1, 1}});
    EXPECT_GT(camera.distance, 0);
    EXPECT_TRUE(std::isfinite(camera.distance));
}

TEST(Camera, orbit_stops_at_the_poles_and_yaw_stays_small) {
    CameraState camera;
    orbit(camera, 1e6, 1e6);
    EXPECT_LT(camera.pitch, 1.5708);
    EXPECT_LE(std::abs(camera.yaw), 3.1416);
    orbit(camera, 0, -1e6);
    EXPECT_GT(camera.pitch, -1.5708);
}

TEST(Camera, zoom_is_undone_and_limited) {
    CameraState camera;
    camera.distance = 2;
    zoom(camera, 3);
    EXPECT_LT(camera.distance, 2);
    zoom(camera, -3);
    EXPECT_NEAR(camera.distance, 2, 1e-12);
    for (const double steps : {1e9, -1e9}) {
        zoom(camera, steps);
        EXPECT_TRUE(camera.distance > 0 && std::isfinite(camera.distance));
    }
}

TEST(Camera, pan_moves_the_target_across_the_view) {
    CameraState camera;
    const std::array<double, 3> before = camera.target;
    const CameraPose pose = find_pose(camera);
    pan(camera, 0.25, -0.5);
    double along = 0;
    for (std::size_t i = 0; i < 3; ++i)
        along += (camera.target[i] - before[i]) * pose.backward[i];
    EXPECT_NEAR(along, 0, 1e-12);
    EXPECT_GT(measure(camera.target, before), 0);
}

TEST(Camera, faced_normal_points_at_the_camera) {
    for (const glm::vec3 normal :
         {glm::vec3(0, 1, 0), glm::vec3(0, -1, 0), glm::vec3(1, 0, 0), glm::vec3(0, 0.6f, -0.8f)}) {
        CameraState camera;
        face_normal(camera, normal);
        const CameraPose pose = find_pose(camera);
        double facing = 0;
        for (int i = 0; i < 3; ++i)
            facing += pose.backward[static_cast<std::size_t>(i)] * static_cast<double>(normal[i]);
        EXPECT_NEAR(facing, 1, 1e-6);
    }
}

} // namespace
} // namespace photonloupe::studio
