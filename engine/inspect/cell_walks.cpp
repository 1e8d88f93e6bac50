// SPDX-License-Identifier: Apache-2.0
// Settings and empty images of cells.
#include "inspect/cell_walks.h"

#include "photons/photon_map.h"

namespace photonloupe::inspect {

shared::CellSettings make_cell_settings(const PhotonMap& photons, const KdTree& tree, const SurfaceView& view) {
    shared::CellSettings settings{};
    for (int axis = 0; axis < 3; ++axis)
        settings.shift[axis] = static_cast<float>(view.origin[axis] - photons.origin[axis]);
    settings.photon_count = static_cast<std::uint32_t>(tree.count);
    settings.leaf_level = tree.leaf_level;
    return settings;
}

CellImage make_cell_image(const SurfaceView& view) {
    CellImage image{view.width, view.height, {}, {}, {}};
    image.ids.assign(view.pixel_count(), -1);
    image.depth.reserve(view.pixel_count());
    for (const glm::vec4& point : view.points.read<glm::vec4>(view.pixel_count()))
        image.depth.push_back(point.w);
    return image;
}

} // namespace photonloupe::inspect
