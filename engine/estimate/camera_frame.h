// SPDX-License-Identifier: Apache-2.0
// Which camera looks at the scene, as the kernels use it.
#pragma once

#include "scene/scene.h"
#include "shared/render.h"

namespace photonloupe {

// The camera of that name; with an empty name the first, or, without cameras, one that sees all of the scene.
// Throws SceneError naming the cameras there are.
Camera find_camera(const Scene& scene, const std::string& name);

// The vertical field of view is kept whatever the image's aspect.
shared::CameraFrame frame_camera(const Scene& scene, const Camera& camera, std::uint32_t width, std::uint32_t height);

} // namespace photonloupe
