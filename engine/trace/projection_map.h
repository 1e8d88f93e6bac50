// SPDX-License-Identifier: Apache-2.0
// Which directions a light should shoot in: a grid of equal-solid-angle cells, marked where specular geometry lies.
#pragma once

#include <cstdint>
#include <vector>

#include "scene/scene.h"

namespace photonloupe {

// Rows are equal steps of y = cos(angle from +y) from 1 to -1, columns equal steps of azimuth atan2(z, x) from 0.
struct ProjectionMap {
    std::uint32_t rows = 1;
    std::uint32_t columns = 1;
    std::vector<std::uint32_t> cells;    // row << 16 | column, row by row
    std::vector<glm::uvec2> row_members; // per row: first entry in cells, marked cells
    double solid_angle() const;          // of the marked cells, sr
};

// Every direction.
ProjectionMap make_full_projection();

// Directions from `light` that meet a mirror or dielectric triangle, conservatively: a cell that contains specular
// geometry is always marked. The grid is refined until enough cells are marked to aim well at small objects.
ProjectionMap project_specular(const Scene& scene, const shared::Light& light);

} // namespace photonloupe
