// SPDX-License-Identifier: Apache-2.0
// Maps and views for the tests of engine/inspect.
#pragma once

#include <random>
#include <vector>

#include <glm/geometric.hpp>

#include "photons/map_columns.h"
#include "photons/nearest_query.h"
#include "pipeline.h"
#include "scene/probe_rays.h"
#include "shared/render.h"
#include "support/shared_device.h"

namespace photonloupe::test {

inline Photons make_photons(const std::vector<glm::vec3>& positions, const std::vector<glm::vec3>& normals) {
    std::vector<float> places, directions, power(3 * positions.size(), 1.0f);
    for (std::size_t i = 0; i < positions.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            places.push_back(positions[i][axis]);
            directions.push_back(normals[i][axis]);
        }
    const std::vector<std::int32_t> emitter(positions.size()), object(positions.size(), -1);
    const std::vector<std::uint64_t> emitted(positions.size());
    Photons photons;
    photons.map = make_map(get_device(), {places, directions, power, emitter, emitted, object});
    return photons;
}

inline Photons make_floor_photons(const std::vector<glm::vec3>& positions) {
    return make_photons(positions, std::vector<glm::vec3>(positions.size(), glm::vec3(0, 1, 0)));
}

// The square [-1, 1]² at y = 0.
inline Scene make_floor() {
    return make_scene({{{{-1, 0, -1}, {-1, 0, 1}, {1, 0, 1}}}, {{{-1, 0, -1}, {1, 0, 1}, {1, 0, -1}}}});
}

// From two metres above, the floor fills the image; z points down in it.
inline shared::CameraFrame look_down() {
    return {{0, 2, 0, 1}, {0.5f, 0, 0, 0}, {0, 0, -0.5f, 0}, {0, -1, 0, 0}};
}

inline std::vector<glm::vec3> draw_points(std::size_t count, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<float> coordinate(-1.0f, 1.0f);
    std::vector<glm::vec3> points(count);
    for (glm::vec3& point : points)
        point = {coordinate(random), coordinate(random), coordinate(random)};
    return points;
}

} // namespace photonloupe::test
