// SPDX-License-Identifier: Apache-2.0
// Drives the kd-tree kernels: copy the photons, split level by level, then whole subtrees at once.
#include "photons/kd_tree.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <thread>

#include <glm/common.hpp>

#include <span>

#include "gpu/commands.h"

namespace photonloupe {
namespace {

// Nodes with more photons are split by the host: one workgroup would need too many loop turns
// (shaders/shared/turns.glsl).
constexpr std::uint64_t HOST_NODE_PHOTONS = 16384;
// From nodes of this size on a workgroup finishes a whole subtree, whose photons then stay in the processor's cache.
constexpr std::uint64_t SUBTREE_PHOTONS = 1024;

std::uint64_t count_tiles(std::uint64_t photon_count) {
    return (photon_count + shared::TREE_TILE - 1) / shared::TREE_TILE;
}

struct CopyPush {
    std::uint32_t first;
    std::uint32_t count;
};

void copy_positions(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const Progress& progress) {
    gpu::run_in_chunks(device, "build tree", photons.count, 1 << 16, progress,
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           const CopyPush push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)};
                           commands.dispatch(
                               {"photons/number_photons.comp", 64, {}, {}},
                               {{"position_emitter", photons.position_emitter}, {"tree_positions", tree.positions}},
                               push, count);
                       });
}

void split_levels(gpu::Device& device, const KdTree& tree, std::uint32_t root_level, std::uint32_t last_level,
                  const Progress& progress) {
    gpu::run_in_chunks(
        device, "build tree", 1ull << root_level, 1, progress,
        [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
            const shared::TreeBuild push{static_cast<std::uint32_t>(tree.count), tree.leaf_level, root_level,
                                         static_cast<std::uint32_t>(first), last_level};
            commands.dispatch({"photons/build_tree.comp", 0, {}, {}},
                              {{"tree_positions", tree.positions}, {"tree_nodes", tree.nodes}}, push,
                              count * device.limits().subgroup_size);
        },
        device.limits().max_group_count);
}

float pick(const glm::vec4& position, int axis) {
    return position[axis];
}

// The box and widest axis of photons, as the kernel finds them.
shared::TreeNode bound_photons(std::span<const glm::vec4> photons, std::uint32_t& axis) {
    glm::vec3 lo(photons[0]), hi(photons[0]);
    for (const glm::vec4& photon : photons) {
        lo = glm::min(lo, glm::vec3(photon));
        hi = glm::max(hi, glm::vec3(photon));
    }
    const glm::vec3 extent = hi - lo;
    axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    return {glm::vec4(lo, 0.0f), glm::vec4(hi, std::bit_cast<float>(axis))};
}

// Splits one node about the median of (coordinate, photon id), like build_tree.comp.
shared::TreeNode split_node(std::span<glm::vec4> photons, std::size_t split) {
    std::uint32_t axis = 0;
    shared::TreeNode node = bound_photons(photons, axis);
    const int coordinate = static_cast<int>(axis);
    const auto before = [coordinate](const glm::vec4& a, const glm::vec4& b) {
        const float x = pick(a, coordinate), y = pick(b, coordinate);
        return x < y || (x == y && std::bit_cast<std::uint32_t>(a.w) < std::bit_cast<std::uint32_t>(b.w));
    };
    std::nth_element(photons.begin(), photons.begin() + static_cast<std::ptrdiff_t>(split), photons.end(), before);
    node.lo_split.w = pick(photons[split], coordinate); // the smallest of the right half
    return node;
}

// Splits the large nodes at the top; returns the first level left to the device.
std::uint32_t split_top(KdTree& tree, const Progress& progress) {
    std::uint32_t level = 0;
    if (tree.count <= HOST_NODE_PHOTONS)
        return level;
    std::vector<glm::vec4> photons = tree.positions.read<glm::vec4>(tree.count);
    for (; level < tree.leaf_level && (tree.count >> level) >= HOST_NODE_PHOTONS; ++level) {
        progress.report("build tree", static_cast<double>(level) / tree.leaf_level);
        std::vector<shared::TreeNode> nodes(std::size_t{1} << level);
        const auto split_from = [&](std::size_t first) { // two threads take every other node
            for (std::size_t node = first; node < nodes.size(); node += 2) {
                const std::uint32_t begin = find_first_position(tree.count, node, level);
                const std::uint32_t end = find_first_position(tree.count, node + 1, level);
                const std::uint32_t split = find_first_position(tree.count, 2 * node + 1, level + 1);
                nodes[node] = split_node({&photons[begin], end - begin}, split - begin);
            }
        };
        std::thread other(split_from, 1);
        split_from(0);
        other.join();
        tree.nodes.upload(nodes.data(), nodes.size() * sizeof(shared::TreeNode),
                          nodes.size() * sizeof(shared::TreeNode));
    }
    tree.positions.upload(photons.data(), photons.size() * sizeof(glm::vec4));
    return level;
}

} // namespace

std::uint32_t find_first_position(std::uint64_t count, std::uint64_t node, std::uint32_t level) {
    return static_cast<std::uint32_t>(std::min(shared::TREE_TILE * (count_tiles(count) * node >> level), count));
}

void order_normals(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const Progress& progress) {
    gpu::run_in_chunks(device, "build tree", photons.count, 1 << 16, progress,
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           const CopyPush push{static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count)};
                           commands.dispatch({"photons/gather_normals.comp", 64, {}, {}},
                                             {{"normal_index", photons.normal_index},
                                              {"position_emitter", photons.position_emitter},
                                              {"tree_positions", tree.positions},
                                              {"tree_normals", tree.normals}},
                                             push, count);
                       });
}

std::uint32_t find_leaf_level(std::uint64_t photon_count) {
    std::uint32_t level = 0;
    while (shared::TREE_TILE * ((count_tiles(photon_count) + (1ull << level) - 1) >> level) > shared::TREE_LEAF_PHOTONS)
        ++level;
    return level;
}

KdTree build_tree(gpu::Device& device, const PhotonMap& photons, const Progress& progress) {
    KdTree tree;
    tree.count = photons.count;
    tree.leaf_level = find_leaf_level(photons.count);
    const std::uint64_t bytes = photons.count * sizeof(glm::vec4);
    tree.nodes = gpu::Buffer(device, (2ull << tree.leaf_level) * sizeof(shared::TreeNode), "kd-tree nodes");
    tree.positions = gpu::Buffer(device, bytes, "kd-tree positions");
    tree.normals = gpu::Buffer(device, bytes, "kd-tree normals");
    if (photons.count == 0)
        return tree;
    copy_positions(device, photons, tree, progress);
    std::uint32_t level = split_top(tree, progress);
    for (; level < tree.leaf_level && (tree.count >> level) > SUBTREE_PHOTONS; ++level)
        split_levels(device, tree, level, level, progress);
    split_levels(device, tree, level, tree.leaf_level, progress);
    order_normals(device, photons, tree, progress);
    return tree;
}

KdTree copy_tree(gpu::Device& device, const KdTree& tree) {
    KdTree copy;
    copy.count = tree.count;
    copy.leaf_level = tree.leaf_level;
    copy.nodes = gpu::Buffer(device, tree.nodes.size_bytes(), "kd-tree nodes");
    copy.positions = gpu::Buffer(device, tree.positions.size_bytes(), "kd-tree positions");
    copy.normals = gpu::Buffer(device, tree.normals.size_bytes(), "kd-tree normals");
    gpu::Commands commands(device, "copy tree");
    commands.copy(tree.nodes, 0, copy.nodes, 0, tree.nodes.size_bytes());
    commands.copy(tree.positions, 0, copy.positions, 0, tree.positions.size_bytes());
    commands.copy(tree.normals, 0, copy.normals, 0, tree.normals.size_bytes());
    commands.run();
    return copy;
}

void refit_tree(gpu::Device& device, const KdTree& tree, const std::string& stage) {
    if (tree.count == 0)
        return;
    gpu::Commands commands(device, stage);
    const auto photon_count = static_cast<std::uint32_t>(tree.count);
    const std::uint64_t largest = std::uint64_t{device.limits().max_group_count} * 64;
    const auto refit_level = [&](std::uint32_t level, const char* kernel) {
        const std::uint64_t nodes = 1ull << level;
        for (std::uint64_t first = 0; first < nodes; first += largest) {
            const std::uint64_t count = std::min(largest, nodes - first);
            const shared::TreeRefit push{photon_count, level, static_cast<std::uint32_t>(first),
                                         static_cast<std::uint32_t>(count)};
            commands.dispatch({kernel, 64, {}, {}}, {{"tree_positions", tree.positions}, {"tree_nodes", tree.nodes}},
                              push, count);
        }
    };
    refit_level(tree.leaf_level, "photons/refit_leaves.comp");
    for (std::uint32_t level = tree.leaf_level; level > 0; --level)
        refit_level(level - 1, "photons/refit_nodes.comp");
    commands.run();
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
