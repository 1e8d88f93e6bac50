// SPDX-License-Identifier: Apache-2.0
// Exact Voronoi cells of the photons on the surfaces seen.
#pragma once

#include "inspect/cell_image.h"
#include "inspect/surface_view.h"
#include "photons/kd_tree.h"
#include "photons/neighborhood.h"

namespace photonloupe::inspect {

struct VoronoiSettings {
    // As in density estimation (METHODS §2) photons count where the smallest ball takes them in whose height above the
    // tangent plane is this share of its radius, and whose normals agree. 0: by distance alone.
    float flatness = SURFACE_FLATNESS;
};

// The ids are those of the nearest photons, ties by id.
CellImage find_voronoi_cells(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const SurfaceView& view,
                             const VoronoiSettings& settings = {}, const Progress& progress = {});

} // namespace photonloupe::inspect
