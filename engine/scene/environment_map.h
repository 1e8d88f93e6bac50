// SPDX-License-Identifier: Apache-2.0
// An environment that an image says: radiance by direction, and the tables directions are drawn from.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image/image.h"
#include "shared/scene.h"

namespace photonloupe {

// Equirectangular, radiance constant over each texel: rows are equal steps of the angle to +y, from it down to -y;
// columns equal steps of the azimuth atan2(z, x), the middle of the image towards +x, what is right of it towards +z.
struct EnvironmentMap {
    std::filesystem::path path;
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    glm::dvec3 mean{0.0};           // W/(m² sr) over all directions
    double mean_largest = 0;        // of the largest channel, which directions are drawn by
    std::vector<glm::vec4> texels;  // shared::EnvironmentHeader, rows, image (shaders/scene/environment.glsl)
    std::size_t negative_count = 0; // values below 0, which count as 0
};

// `factor` times the image, turned about y by `rotation` radians, counter-clockwise seen from above. Throws SceneError
// that starts with the path for images that are not twice as wide as high, too large, black, or not finite.
EnvironmentMap make_environment_map(const std::filesystem::path& path, const Image& image, const glm::dvec3& factor,
                                    double rotation);

} // namespace photonloupe
