// SPDX-License-Identifier: Apache-2.0
// The kd-tree as a picture: which node each surface point falls in, and the boxes of the nodes.
#pragma once

#include <optional>

#include "inspect/cell_image.h"
#include "inspect/surface_view.h"
#include "photons/kd_tree.h"

namespace photonloupe::inspect {

// The ids are rows of PhotonMap.tree (heap index - 1), of the nodes at `depth` (0: the root), by default the leaves.
// Deeper than the leaves: the leaves.
CellImage find_kd_cells(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const SurfaceView& view,
                        std::optional<std::uint32_t> depth = {}, const Progress& progress = {});

struct NodeBox {
    std::int32_t node = 0; // row of PhotonMap.tree
    std::int32_t photon_count = 0;
    glm::vec3 low{}, high{}; // metres from the map's origin, tight about the photons
};

std::vector<NodeBox> list_node_boxes(const KdTree& tree, std::optional<std::uint32_t> depth = {});

} // namespace photonloupe::inspect
