// SPDX-License-Identifier: Apache-2.0
// An image of cells: what each pixel belongs to, where cells meet, and how they are painted.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "image/image.h"

namespace photonloupe::inspect {

struct CellImage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::int32_t> ids;       // row 0 at the top; -1: no surface, or no cell there
    std::vector<float> depth;            // metres along the view's axis; inf: no surface
    std::vector<std::uint8_t> is_border; // the right or the lower neighbour belongs to another cell
};

// Fills is_border from ids.
void find_borders(CellImage& image);

struct CellPaint {
    bool draws_borders = true;
    std::uint32_t least_bordered = 16; // pixels of a cell; the borders of smaller ones would hide it
    glm::vec3 border{0.0f};            // linear
    glm::vec3 background{0.0f};        // linear, where there is no cell
};

// Linear colors by cell id; ids beyond them are background.
Image paint_cells(const CellImage& image, std::span<const glm::vec3> colors, const CellPaint& paint = {});

// 8-bit sRGB and alpha 255, as screens show it.
std::vector<std::uint8_t> encode_rgba8(const Image& image);

} // namespace photonloupe::inspect
