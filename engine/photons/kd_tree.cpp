// SPDX-License-Identifier: Apache-2.0
// The kd-tree after its photons are in order: what is copied to them, the nodes' boxes, copies, and reading it back.
#include "photons/kd_tree.h"

#include <algorithm>
#include <cstring>

#include "gpu/commands.h"
#include "photons/tree_kernels.h"

namespace photonloupe {
namespace {

// Where a tree has none, something stands in for what a kernel declares.
const gpu::Buffer& choose_buffer(const gpu::Buffer& buffer, const gpu::Buffer& other) {
    return buffer.is_empty() ? other : buffer;
}

} // namespace

void order_columns(gpu::Commands& commands, const TreePhotons& photons, const RangeRows* ranges, const KdTree& tree,
                   const gpu::Buffer& emitters, std::uint64_t first, std::uint64_t count) {
    const struct {
        std::uint32_t first, count;
    } push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)};
    const TreeKernels kernels(ranges ? tree.range_rows : 0, 0);
    commands.dispatch(kernels.order_columns(),
                      {{"normal_index", photons.normals},
                       {"position_emitter", photons.positions},
                       {"range_rows", ranges ? ranges->values : tree.positions},
                       {"tree_positions", tree.positions},
                       {"emitters", emitters},
                       {"tree_normals", tree.normals},
                       {"tree_rows", choose_buffer(tree.rows, tree.normals)}},
                      push, count);
}

KdTree copy_tree(gpu::Device& device, const KdTree& tree) {
    KdTree copy;
    copy.count = tree.count;
    copy.leaf_level = tree.leaf_level;
    copy.range_rows = tree.range_rows;
    gpu::Commands commands(device, "copy tree");
    const auto copy_buffer = [&](const gpu::Buffer& from, gpu::Buffer& to, const char* purpose) {
        if (from.is_empty())
            return;
        to = gpu::Buffer(device, from.size_bytes(), purpose);
        commands.copy(from, 0, to, 0, from.size_bytes());
    };
    copy_buffer(tree.nodes, copy.nodes, "kd-tree nodes");
    copy_buffer(tree.positions, copy.positions, "kd-tree positions");
    copy_buffer(tree.normals, copy.normals, "kd-tree normals");
    copy_buffer(tree.normal_boxes, copy.normal_boxes, "kd-tree boxes of normals");
    copy_buffer(tree.rows, copy.rows, "kd-tree ranges");
    copy_buffer(tree.ranges, copy.ranges, "kd-tree ranges of nodes");
    commands.run();
    return copy;
}

void bound_tree(gpu::Device& device, const KdTree& tree, const std::string& stage, bool with_ranges) {
    if (tree.count == 0)
        return;
    gpu::Commands commands(device, stage);
    const auto photon_count = static_cast<std::uint32_t>(tree.count);
    const TreeKernels kernels(with_ranges ? tree.range_rows : 0, device.limits().subgroup_size);
    const std::uint64_t largest = std::uint64_t{device.limits().max_group_count} * 64;
    const auto bound_level = [&](std::uint32_t level, const gpu::KernelSource& kernel) {
        const std::uint64_t nodes = 1ull << level;
        for (std::uint64_t first = 0; first < nodes; first += largest) {
            const std::uint64_t count = std::min(largest, nodes - first);
            const shared::TreeRefit push{photon_count, level, static_cast<std::uint32_t>(first),
                                         static_cast<std::uint32_t>(count)};
            commands.dispatch(kernel,
                              {{"tree_positions", tree.positions},
                               {"tree_normals", tree.normals},
                               {"tree_rows", choose_buffer(tree.rows, tree.normals)},
                               {"tree_nodes", tree.nodes},
                               {"normal_boxes", tree.normal_boxes},
                               {"ranges", choose_buffer(tree.ranges, tree.normal_boxes)}},
                              push, count);
        }
    };
    bound_level(tree.leaf_level, kernels.refit_leaves());
    for (std::uint32_t level = tree.leaf_level; level > 0; --level)
        bound_level(level - 1, kernels.refit_nodes());
    commands.run();
}

void refit_tree(gpu::Device& device, const KdTree& tree, const std::string& stage) {
    bound_tree(device, tree, stage, false);
}

TreeArrays read_tree(const KdTree& tree) {
    TreeArrays arrays;
    const std::uint64_t node_count = tree.count == 0 ? 0 : (2ull << tree.leaf_level) - 1;
    const std::vector<shared::TreeNode> nodes = tree.nodes.read<shared::TreeNode>(node_count + 1);
    std::uint32_t level = 0;
    for (std::uint64_t heap = 1; heap <= node_count; ++heap) {
        while (heap >= 2ull << level)
            ++level;
        const shared::TreeNode& node = nodes[heap];
        const bool is_leaf = level == tree.leaf_level;
        std::uint32_t axis;
        std::memcpy(&axis, &node.hi_axis.w, sizeof axis);
        const std::uint64_t index = heap - (1ull << level);
        const std::uint32_t first = find_first_position(tree.count, index, level);
        arrays.split_axis.push_back(is_leaf ? std::int8_t{-1} : static_cast<std::int8_t>(axis));
        arrays.split_value.push_back(is_leaf ? 0.0f : node.lo_split.w);
        arrays.first.push_back(static_cast<std::int32_t>(first));
        arrays.count.push_back(static_cast<std::int32_t>(find_first_position(tree.count, index + 1, level) - first));
        arrays.box.push_back(
            {node.lo_split.x, node.lo_split.y, node.lo_split.z, node.hi_axis.x, node.hi_axis.y, node.hi_axis.z});
    }
    for (const glm::vec4& position : tree.positions.read<glm::vec4>(tree.count)) {
        std::int32_t id;
        std::memcpy(&id, &position.w, sizeof id);
        arrays.order.push_back(id);
    }
    return arrays;
}

} // namespace photonloupe
