// SPDX-License-Identifier: Apache-2.0
// Photons as points over the surfaces seen: how dense they lie, in their colors, chosen ones over the rest.
#pragma once

#include <array>
#include <span>

#include "core/progress.h"
#include "photons/photon_map.h"
#include "shared/splat.h"

namespace photonloupe::inspect {

struct SurfaceView;

struct SplatStyle {
    float radius = 1.0f;        // of a point, pixels
    float strength = 0.5f;      // optical depth of one point
    glm::vec3 background{0.1f}; // sRGB, as the rest
    glm::vec3 plain{0.92f};     // of points without a color
};

// Where the camera stands; without a surface view nothing hides photons.
struct SplatView {
    std::uint32_t width = 0, height = 0;
    shared::CameraFrame camera{};
    std::array<double, 3> origin{};       // world place of the camera's (0, 0, 0)
    const SurfaceView* surface = nullptr; // of the same camera and size
};

// `colors` RGBA8 by photon id (sRGB), or empty; `marks` by id, 0: context, or empty: all are chosen.
// Returns RGBA8 pixels, row 0 at the top. The same bits whatever the order of photons.
gpu::Buffer splat_photons(gpu::Device& device, const PhotonMap& photons, const SplatView& view,
                          std::span<const std::uint32_t> colors, std::span<const std::uint32_t> marks,
                          const SplatStyle& style, const Progress& progress = {});

} // namespace photonloupe::inspect
