// SPDX-License-Identifier: Apache-2.0
// Builds the layered tree on the host, level by level on two threads: it is rebuilt rarely, and most of its time goes
// to the queries it then saves.
#include "photons/layered_tree.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <thread>

namespace photonloupe {
namespace {

constexpr const char* STAGE = "build layered tree";
constexpr std::size_t WORLD_AXES = 3;
constexpr std::size_t RANGE_AXES = 4; // layer number, then the widest parameters
constexpr std::size_t AXES = WORLD_AXES + RANGE_AXES;

struct Item {
    std::array<float, AXES> at; // x, y, z, layer number, parameters
    std::uint32_t id;
};

struct Box {
    std::array<float, AXES> lo, hi;
};

Box bound(std::span<const Item> items) {
    Box box{items[0].at, items[0].at};
    for (const Item& item : items)
        for (std::size_t axis = 0; axis < AXES; ++axis) {
            box.lo[axis] = std::min(box.lo[axis], item.at[axis]);
            box.hi[axis] = std::max(box.hi[axis], item.at[axis]);
        }
    return box;
}

std::vector<Item> list_items(const PhotonMap& photons, const ParameterTree& parameter_tree) {
    const ParameterColumns& columns = require_parameters(photons);
    const std::size_t stride = 4 * columns.count_rows();
    const std::vector<glm::vec4> positions = photons.position_emitter.read<glm::vec4>(photons.count);
    const std::vector<float> values = columns.values.read<float>(photons.count * stride);
    std::vector<Item> items(photons.count);
    for (std::uint32_t id = 0; id < items.size(); ++id) {
        const float* row = &values[id * stride];
        const bool is_unset = std::isnan(row[0]);
        Item item{{positions[id].x, positions[id].y, positions[id].z,
                   2.0f * static_cast<float>(std::bit_cast<std::uint32_t>(positions[id].w)) + (is_unset ? 1.0f : 0.0f)},
                  id};
        for (std::size_t i = 0; i < parameter_tree.axes.size() && !is_unset; ++i)
            item.at[WORLD_AXES + 1 + i] = row[parameter_tree.axes[i]];
        items[id] = item;
    }
    return items;
}

// How much each axis counts when the widest is chosen: all extents are brought to that of the world.
std::array<float, AXES> find_scales(const Box& root) {
    float world = 0;
    for (std::size_t axis = 0; axis < WORLD_AXES; ++axis)
        world = std::max(world, root.hi[axis] - root.lo[axis]);
    std::array<float, AXES> scales;
    scales.fill(1.0f);
    for (std::size_t axis = WORLD_AXES; axis < AXES; ++axis) {
        const float extent = root.hi[axis] - root.lo[axis];
        scales[axis] = extent > 0 ? world / extent : 0.0f;
    }
    return scales;
}

std::size_t choose_axis(const Box& box, const std::array<float, AXES>& scales) {
    std::size_t widest = 0;
    for (std::size_t axis = 1; axis < AXES; ++axis)
        if ((box.hi[axis] - box.lo[axis]) * scales[axis] > (box.hi[widest] - box.lo[widest]) * scales[widest])
            widest = axis;
    return widest;
}

struct Nodes {
    std::vector<shared::TreeNode> boxes;
    std::vector<glm::vec4> ranges;
};

void write_node(Nodes& nodes, std::uint64_t heap, const Box& box, float split, std::uint32_t axis) {
    nodes.boxes[heap] = {glm::vec4(box.lo[0], box.lo[1], box.lo[2], split),
                         glm::vec4(box.hi[0], box.hi[1], box.hi[2], std::bit_cast<float>(axis))};
    nodes.ranges[2 * heap] = {box.lo[3], box.lo[4], box.lo[5], box.lo[6]};
    nodes.ranges[2 * heap + 1] = {box.hi[3], box.hi[4], box.hi[5], box.hi[6]};
}

} // namespace

std::vector<std::uint32_t> list_range_axes(const PhotonMap& photons, const ParameterTree& parameter_tree) {
    const ParameterColumns& columns = require_parameters(photons);
    std::vector<std::uint32_t> axes;
    for (const std::uint32_t axis : parameter_tree.axes)
        axes.push_back(columns.periods[axis] > 0 ? columns.count : axis); // beyond the last: none
    return axes;
}

LayeredTree build_layered_tree(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                               const Progress& progress) {
    LayeredTree layered;
    KdTree& tree = layered.tree;
    tree.count = photons.count;
    tree.leaf_level = find_leaf_level(photons.count);
    std::vector<Item> items = list_items(photons, parameter_tree);
    Nodes nodes{std::vector<shared::TreeNode>(2ull << tree.leaf_level),
                std::vector<glm::vec4>(4ull << tree.leaf_level)};
    const std::array<float, AXES> scales = items.empty() ? std::array<float, AXES>{} : find_scales(bound(items));
    const auto build_node = [&](std::uint32_t level, std::uint64_t node) {
        const std::uint32_t first = find_first_position(tree.count, node, level);
        const std::uint32_t end = find_first_position(tree.count, node + 1, level);
        const std::span<Item> own(&items[first], end - first);
        const Box box = bound(own);
        if (level == tree.leaf_level) {
            write_node(nodes, (1ull << level) + node, box, 0.0f, 3);
            return;
        }
        const std::size_t axis = choose_axis(box, scales);
        const std::uint32_t split = find_first_position(tree.count, 2 * node + 1, level + 1) - first;
        std::nth_element(own.begin(), own.begin() + split, own.end(), [axis](const Item& a, const Item& b) {
            return a.at[axis] != b.at[axis] ? a.at[axis] < b.at[axis] : a.id < b.id;
        });
        write_node(nodes, (1ull << level) + node, box, own[split].at[axis], static_cast<std::uint32_t>(axis));
    };
    for (std::uint32_t level = 0; level <= tree.leaf_level && !items.empty(); ++level) {
        progress.report(STAGE, static_cast<double>(level) / (tree.leaf_level + 1));
        const auto build_from = [&](std::uint64_t start) { // two threads take every other node
            for (std::uint64_t node = start; node < 1ull << level; node += 2)
                build_node(level, node);
        };
        std::thread other(build_from, 1);
        build_from(0);
        other.join();
    }
    std::vector<glm::vec4> positions;
    positions.reserve(items.size());
    for (const Item& item : items)
        positions.emplace_back(item.at[0], item.at[1], item.at[2], std::bit_cast<float>(item.id));
    tree.nodes = gpu::make_buffer(device, nodes.boxes, "kd-tree nodes");
    layered.ranges = gpu::make_buffer(device, nodes.ranges, "kd-tree ranges");
    tree.positions = gpu::make_buffer(device, positions, "kd-tree positions");
    tree.normals = gpu::Buffer(device, photons.count * sizeof(glm::vec4), "kd-tree normals");
    tree.normal_boxes = gpu::Buffer(device, nodes.boxes.size() * 2 * sizeof(glm::vec4), "kd-tree boxes of normals");
    const gpu::Buffer emitters = gpu::make_buffer(device, std::vector<std::uint32_t>{0, 0}, "emitters"); // any
    gpu::run_in_chunks(device, STAGE, tree.count, 1 << 18, progress,
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           order_columns(commands, photons, nullptr, tree, emitters, first, count);
                       });
    bound_tree(device, tree, STAGE, false);
    return layered;
}

} // namespace photonloupe
