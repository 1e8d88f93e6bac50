// SPDX-License-Identifier: Apache-2.0
// Which part of a light's power is worth shooting: a grid of cells of equal power, marked where what it should meet
// lies.
#pragma once

#include <cstdint>
#include <vector>

#include "trace/emission_frame.h"

namespace photonloupe {

// Rows and columns of the unit square of an EmissionFrame; of a point light, rows are equal steps of y from 1 to -1 and
// columns equal steps of azimuth atan2(z, x) from 0.
struct ProjectionMap {
    std::uint32_t rows = 1;
    std::uint32_t columns = 1;
    std::vector<std::uint32_t> cells;    // row << 16 | column, row by row
    std::vector<glm::uvec2> row_members; // per row: first entry in cells, marked cells
    double find_share() const;           // of the light's power in marked cells
};

// All of it.
ProjectionMap make_full_projection();

// What meets a mirror or dielectric triangle (of directional light, where not `only_specular`: any triangle),
// conservatively: a cell that contains such geometry is always marked. The grid is refined until enough cells are
// marked to aim well at small objects.
// Takes what it costs, calls and cells, from `budget`; where that does not suffice, all is marked.
ProjectionMap project_light(const Scene& scene, const EmissionFrame& frame, bool only_specular, std::int64_t& budget);

} // namespace photonloupe
