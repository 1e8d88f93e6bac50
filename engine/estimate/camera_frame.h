// SPDX-License-Identifier: Apache-2.0
// Which camera looks at the scene, as the kernels use it.
#pragma once

#include <optional>

#include "scene/scene.h"
#include "shared/render.h"

namespace photonloupe {

struct CameraChoice {
    std::string name;             // of one of the scene's; empty: the first, else one that fits the bounds
    std::optional<Camera> placed; // instead of any of them
};

// Throws SceneError naming the cameras there are.
Camera find_camera(const Scene& scene, const CameraChoice& choice);

// From `position` to `target`, with `up` roughly upwards in its image. Throws ArgumentError where it looks nowhere, or
// along `up`.
Camera aim_camera(const std::array<double, 3>& position, const std::array<double, 3>& target,
                  const std::array<double, 3>& up, double yfov);

// The vertical field of view is kept whatever the image's aspect; `origin` is the world place of the kernels' (0, 0,
// 0).
shared::CameraFrame frame_camera(const std::array<double, 3>& origin, const Camera& camera, std::uint32_t width,
                                 std::uint32_t height);

} // namespace photonloupe
