// SPDX-License-Identifier: Apache-2.0
// What the kernels that walk from pixels into the tree share.
#pragma once

#include "inspect/cell_image.h"
#include "inspect/surface_view.h"
#include "photons/kd_tree.h"

namespace photonloupe::inspect {

shared::CellSettings make_cell_settings(const PhotonMap& photons, const KdTree& tree, const SurfaceView& view);

// Size and depth of the view, nobody's anywhere.
CellImage make_cell_image(const SurfaceView& view);

} // namespace photonloupe::inspect
