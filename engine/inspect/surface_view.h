// SPDX-License-Identifier: Apache-2.0
// The surfaces a camera sees: a point, a normal and an object per pixel, by one ray through each pixel's center.
#pragma once

#include <optional>

#include "core/progress.h"
#include "scene/scene_buffers.h"
#include "shared/inspect.h"

namespace photonloupe::inspect {

struct SurfaceView {
    std::uint32_t width = 0, height = 0;
    shared::CameraFrame camera{};
    std::array<double, 3> origin{}; // world place of the points' (0, 0, 0): the scene's
    gpu::Buffer points;             // a pixel: xyz metres, w depth along the view's axis, inf: nothing is seen
    gpu::Buffer normals;            // xyz unit, towards the eye; w bits: object
    std::uint64_t pixel_count() const { return std::uint64_t{width} * height; }
};

// What one pixel sees.
struct SurfacePoint {
    std::array<double, 3> position{}; // world, metres
    glm::vec3 normal{};               // towards the eye
    std::int32_t object = 0;
    float depth = 0; // metres along the view's axis
};

struct SurfaceViewSettings {
    std::uint32_t width = 512, height = 512;
    bool sees_through = false; // what mostly transmits is passed, straight on
};

// Nothing is followed through mirrors, and nothing bent: the first surface counts, or the first that is not glass.
// Throws Error for an image size out of range.
SurfaceView see_surfaces(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers,
                         const shared::CameraFrame& camera, const SurfaceViewSettings& settings,
                         const Progress& progress = {});

// None: the pixel sees no surface, or lies outside.
std::optional<SurfacePoint> read_surface(const SurfaceView& view, std::uint32_t column, std::uint32_t row);

} // namespace photonloupe::inspect
