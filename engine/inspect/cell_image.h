// SPDX-License-Identifier: Apache-2.0
// An image of cells: what each pixel belongs to, where cells meet, and how they are painted.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "image/image.h"
#include "inspect/surface_view.h"
#include "photons/kd_tree.h"

namespace photonloupe::inspect {

struct CellImage {
    std::uint32_t width = 0, height = 0;
    std::vector<std::int32_t> ids;       // row 0 at the top; -1: no surface, or no cell there
    std::vector<float> depth;            // metres along the view's axis; inf: no surface
    std::vector<std::uint8_t> is_border; // the right or the lower neighbour belongs to another cell
};

// Size and depth of the view, nobody's anywhere and no borders.
CellImage make_cell_image(const SurfaceView& view);

// What the kernels that walk from pixels into the tree share.
shared::CellSettings make_cell_settings(const PhotonMap& photons, const KdTree& tree, const SurfaceView& view);

// Fills is_border from ids.
void find_borders(CellImage& image);

// Pixels of a cell; the borders of smaller ones would hide it.
constexpr std::uint32_t LEAST_BORDERED = 16;

// Linear colors by cell id; borders, and ids beyond the colors, are black.
Image paint_cells(const CellImage& image, std::span<const glm::vec3> colors);

} // namespace photonloupe::inspect
