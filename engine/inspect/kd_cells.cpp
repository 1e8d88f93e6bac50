// SPDX-License-Identifier: Apache-2.0
// Descends from pixels to nodes, and reads boxes.
#include "inspect/kd_cells.h"

#include "gpu/commands.h"

namespace photonloupe::inspect {
namespace {

std::uint32_t choose_level(const KdTree& tree, std::optional<std::uint32_t> depth) {
    return std::min(depth.value_or(tree.leaf_level), tree.leaf_level);
}

} // namespace

CellImage find_kd_cells(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const SurfaceView& view,
                        std::optional<std::uint32_t> depth, const Progress& progress) {
    CellImage image = make_cell_image(view);
    if (tree.count == 0)
        return image;
    shared::CellSettings push = make_cell_settings(photons, tree, view);
    push.level = choose_level(tree, depth);
    const gpu::Buffer nodes(device, view.pixel_count() * sizeof(std::uint32_t), "nodes seen");
    gpu::dispatch_in_chunks(device, "find nodes", {"inspect/find_nodes.comp", 64, {}, {}},
                            {{"tree_nodes", tree.nodes},
                             {"tree_positions", tree.positions},
                             {"surface_points", view.points},
                             {"nodes", nodes}},
                            push, view.pixel_count(), 4096, progress);
    image.ids = nodes.read<std::int32_t>(view.pixel_count());
    find_borders(image);
    return image;
}

std::vector<NodeBox> list_node_boxes(const KdTree& tree, std::optional<std::uint32_t> depth) {
    std::vector<NodeBox> boxes;
    if (tree.count == 0)
        return boxes;
    const std::uint32_t level = choose_level(tree, depth);
    const std::uint64_t first = 1ull << level;
    const std::vector<shared::TreeNode> nodes = tree.nodes.read<shared::TreeNode>(first, first);
    for (std::uint64_t j = 0; j < nodes.size(); ++j) {
        const std::uint32_t begin = find_first_position(tree.count, j, level);
        boxes.push_back({static_cast<std::int32_t>(first + j - 1),
                         static_cast<std::int32_t>(find_first_position(tree.count, j + 1, level) - begin),
                         glm::vec3(nodes[j].lo_split), glm::vec3(nodes[j].hi_axis)});
    }
    return boxes;
}

} // namespace photonloupe::inspect
