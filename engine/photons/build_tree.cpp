// SPDX-License-Identifier: Apache-2.0
// Builds the kd-tree on the device, a level after the other: large nodes by several subgroups each, then a subgroup a
// node, then an invocation a node.
#include <algorithm>
#include <bit>
#include <functional>
#include <memory>
#include <optional>
#include <utility>

#include "gpu/commands.h"
#include "photons/kernel_macros.h"
#include "photons/kd_tree.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "build tree";
// Nodes of more photons are split by several subgroups. One subgroup may pass over a node 26 times (split_nodes.comp)
// and then has loop turns left (shaders/shared/turns.glsl).
constexpr std::uint64_t LARGE_NODE_PHOTONS = 16384, LARGE_NODE_BLOCKS = 2048;
// The largest nodes that an invocation sorts alone; with ranges fewer, as its long kernel takes the driver seconds to
// compile, and there is one for each number of rows.
constexpr std::uint32_t SMALL_NODE_PHOTONS = 128, SMALL_NODE_PHOTONS_WITH_RANGES = 64;
// Copying a photon's columns costs as much as so many levels: they stand anywhere.
constexpr double ORDER_WORK = 3;
// Photons, levels counted, of the first batch; later ones follow the device's pace.
constexpr double FIRST_BATCH = 1 << 19, SMALLEST_BATCH = 1 << 16, LARGEST_BATCH = 1 << 28;

std::uint64_t count_tiles(std::uint64_t photon_count) {
    return (photon_count + shared::TREE_TILE - 1) / shared::TREE_TILE;
}

// The most photons that a node of a level has.
std::uint64_t find_largest_node(std::uint64_t photon_count, std::uint32_t level) {
    return shared::TREE_TILE * ((count_tiles(photon_count) + (1ull << level) - 1) >> level);
}

// Collects dispatches and submits them in batches of about the device's chunk each.
class Batches {
public:
    Batches(gpu::Device& device, const Progress& progress, double total)
        : m_device(device), m_progress(progress), m_total(total) {}

    // How much of the work of `total` in `count` items the current batch still takes, in items.
    std::uint64_t fit(std::uint64_t count, double total) const {
        const double items = (m_batch - m_work) / total * static_cast<double>(count);
        return static_cast<std::uint64_t>(std::clamp(items, 1.0, static_cast<double>(count)));
    }

    gpu::Commands& add(double work) {
        if (!m_commands) {
            m_progress.report(STAGE, std::min(1.0, m_done / m_total));
            m_commands = std::make_unique<gpu::Commands>(m_device, STAGE);
        }
        m_work += work;
        return *m_commands;
    }

    void finish() {
        run();
        m_progress.report(STAGE, 1.0);
    }

    void run_if_full() {
        if (m_work >= m_batch)
            run();
    }

    void run() {
        if (!m_commands)
            return;
        const double milliseconds = m_commands->run();
        if (milliseconds > 0)
            m_batch = std::clamp(m_device.chunk_milliseconds() / milliseconds * m_work, SMALLEST_BATCH, LARGEST_BATCH);
        m_done += m_work;
        m_work = 0;
        m_commands.reset();
    }

private:
    gpu::Device& m_device;
    const Progress& m_progress;
    double m_total, m_done = 0, m_work = 0, m_batch = FIRST_BATCH;
    std::unique_ptr<gpu::Commands> m_commands;
};

class TreeBuilder {
public:
    TreeBuilder(gpu::Device& device, const PhotonMap& photons, const RangeRows* ranges, TreeAxes axes,
                float parameter_scale, const Progress& progress)
        : m_device(device), m_photons(photons), m_ranges(ranges), m_axes(axes), m_parameter_scale(parameter_scale) {
        m_tree.count = photons.count;
        m_tree.leaf_level = find_leaf_level(photons.count);
        m_tree.range_rows = ranges ? ranges->count_rows() : 0;
        m_batches.emplace(device, progress, static_cast<double>(photons.count) * (m_tree.leaf_level + 1 + ORDER_WORK));
        if (ranges)
            m_defines.push_back("RANGE_ROWS " + std::to_string(m_tree.range_rows) + "u");
        allocate();
    }

    KdTree build() {
        if (m_tree.count == 0)
            return std::move(m_tree);
        number_photons();
        for (std::uint32_t level = 0; level < m_tree.leaf_level; ++level) {
            const std::uint64_t largest = find_largest_node(m_tree.count, level);
            if (largest > std::min(LARGE_NODE_PHOTONS, LARGE_NODE_BLOCKS * m_device.limits().subgroup_size))
                split_large_nodes(level);
            else if (largest > (m_ranges ? SMALL_NODE_PHOTONS_WITH_RANGES : SMALL_NODE_PHOTONS))
                split_nodes(level, {"photons/split_nodes.comp", 0, m_defines, {}}, m_device.limits().subgroup_size);
            else
                split_nodes(level, name_small_kernel(static_cast<std::uint32_t>(largest)), 1);
        }
        copy_columns();
        m_batches->finish();
        bound_tree(m_device, m_tree, STAGE, true);
        return std::move(m_tree);
    }

private:
    void allocate() {
        const std::uint64_t bytes = m_tree.count * sizeof(glm::vec4);
        const std::uint64_t nodes = 2ull << m_tree.leaf_level;
        m_tree.nodes = gpu::Buffer(m_device, nodes * sizeof(shared::TreeNode), "kd-tree nodes");
        m_tree.positions = gpu::Buffer(m_device, bytes, "kd-tree positions");
        m_tree.normals = gpu::Buffer(m_device, bytes, "kd-tree normals");
        m_tree.normal_boxes = gpu::Buffer(m_device, nodes * 2 * sizeof(glm::vec4), "kd-tree boxes of normals");
        if (m_ranges) {
            m_tree.rows = gpu::Buffer(m_device, bytes * m_tree.range_rows, "kd-tree ranges");
            m_tree.ranges =
                gpu::Buffer(m_device, nodes * 2 * m_tree.range_rows * sizeof(glm::vec4), "kd-tree ranges of nodes");
        }
        if (m_tree.count == 0)
            return;
        m_scales = gpu::Buffer(m_device, (1 + m_tree.range_rows) * sizeof(glm::vec4), "kd-tree scales");
        m_box_keys = gpu::Buffer(m_device, 6 * sizeof(std::uint32_t), "kd-tree boxes");
        m_emitters = gpu::Buffer(m_device, 2 * sizeof(std::uint32_t), "emitters");
    }

    // Photons of a level are read here; those of the last end in tree.positions. What is filled last serves before:
    // the normals for photons, their boxes, which are no smaller than an integer a photon, for candidates.
    const gpu::Buffer& source(std::uint32_t level) const {
        return (m_tree.leaf_level - level) % 2 == 0 ? m_tree.positions : m_tree.normals;
    }
    const gpu::Buffer& rows() const { return m_ranges ? m_ranges->values : m_photons.position_emitter; }

    shared::TreeBuild make_push(std::uint32_t level, std::uint64_t first, std::uint64_t count) const {
        return {static_cast<std::uint32_t>(m_tree.count),
                m_tree.leaf_level,
                level,
                static_cast<std::uint32_t>(first),
                static_cast<std::uint32_t>(count),
                0,
                0,
                m_parameter_scale};
    }

    gpu::KernelSource name_small_kernel(std::uint32_t largest_node) const {
        const std::uint32_t size = std::max(32u, std::bit_ceil(largest_node));
        gpu::KernelSource kernel{"photons/split_small_nodes.comp", 64, m_defines, {}};
        kernel.defines.push_back("SORT_SIZE " + std::to_string(size));
        kernel.defines.push_back(write_each("EACH_KEY", 0, size));
        kernel.defines.push_back(write_sort_network(size));
        return kernel;
    }

    void number_photons() {
        m_batches->add(0).fill(m_box_keys, ~0u);
        m_batches->add(0).fill(m_emitters, ~0u);
        const std::uint64_t largest = std::uint64_t{m_device.limits().max_group_count} * shared::TREE_PART;
        for (std::uint64_t first = 0; first < m_tree.count; first += largest) {
            const struct {
                std::uint32_t first, count;
            } push{static_cast<std::uint32_t>(first),
                   static_cast<std::uint32_t>(std::min(largest, m_tree.count - first))};
            m_batches->add(push.count)
                .dispatch({"photons/number_photons.comp", 0, {}, {}},
                          {{"position_emitter", m_photons.position_emitter},
                           {"tree_positions", source(0)},
                           {"box_keys", m_box_keys},
                           {"emitters", m_emitters}},
                          push, count_parts(push.count) * m_device.limits().subgroup_size);
        }
        read_boxes(0);
        if (m_ranges)
            scale_axes();
    }

    void read_boxes(std::uint32_t level) {
        m_batches->add(0).dispatch({"photons/read_boxes.comp", 64, {}, {}},
                                   {{"tree_nodes", m_tree.nodes}, {"box_keys", m_box_keys}},
                                   make_push(level, 0, 1ull << level), 1ull << level);
    }

    void scale_axes() {
        gpu::KernelSource kernel{"photons/scale_axes.comp", 0, m_defines, {}};
        kernel.defines.push_back("RANGE_AXES " + std::to_string(m_ranges->axis_count) + "u");
        if (m_axes == TreeAxes::both)
            kernel.defines.emplace_back("SPLIT_POSITIONS");
        m_batches->add(0).dispatch(kernel,
                                   {{"source", source(0)},
                                    {"range_rows", rows()},
                                    {"scales", m_scales},
                                    {"axis_scales", m_scales},
                                    {"target", source(1)},
                                    {"candidates", m_tree.normal_boxes},
                                    {"tree_nodes", m_tree.nodes}},
                                   make_push(0, 0, 1), 1);
    }

    void split_nodes(std::uint32_t level, const gpu::KernelSource& kernel, std::uint64_t invocations) {
        const std::uint64_t nodes = 1ull << level;
        for (std::uint64_t first = 0; first < nodes;) {
            const std::uint64_t fitting = m_batches->fit(nodes, static_cast<double>(m_tree.count));
            const std::uint64_t count =
                std::min({fitting, nodes - first, std::uint64_t{m_device.limits().max_group_count}});
            m_batches->add(static_cast<double>(m_tree.count) * static_cast<double>(count) / static_cast<double>(nodes))
                .dispatch(kernel,
                          {{"source", source(level)},
                           {"range_rows", rows()},
                           {"scales", m_scales},
                           {"target", source(level + 1)},
                           {"candidates", m_tree.normal_boxes},
                           {"tree_nodes", m_tree.nodes}},
                          make_push(level, first, count), count * invocations);
            m_batches->run_if_full();
            first += count;
        }
    }

    void copy_columns() {
        for (std::uint64_t first = 0; first < m_tree.count;) {
            const std::uint64_t fitting = m_batches->fit(m_tree.count, ORDER_WORK * static_cast<double>(m_tree.count));
            const std::uint64_t count = std::min(
                {fitting, m_tree.count - first, std::uint64_t{m_device.limits().max_group_count} * ORDER_GROUP});
            order_columns(m_batches->add(ORDER_WORK * static_cast<double>(count)), m_photons, m_ranges, m_tree, m_emitters,
                          first, count);
            m_batches->run_if_full();
            first += count;
        }
    }

    static std::uint64_t count_parts(std::uint64_t photons) {
        return (photons + shared::TREE_PART - 1) / shared::TREE_PART;
    }

    // Tries again until the median of every node was among the keys that were set aside.
    void split_large_nodes(std::uint32_t level) {
        m_batches->run(); // it may still use the buffers that are made anew
        const std::uint64_t nodes = 1ull << level;
        shared::TreeBuild push = make_push(level, 0, nodes);
        push.parts = static_cast<std::uint32_t>(count_parts(find_largest_node(m_tree.count, level)));
        const gpu::Buffer brackets(m_device, nodes * sizeof(shared::TreeBracket), "kd-tree brackets");
        const gpu::Buffer left_counts(m_device, nodes * push.parts * sizeof(std::uint32_t), "kd-tree counts");
        const gpu::Buffer unsettled(m_device, sizeof(std::uint32_t), "kd-tree counts");
        m_box_keys = gpu::Buffer(m_device, 2 * nodes * 6 * sizeof(std::uint32_t), "kd-tree boxes");
        const auto dispatch = [&](const char* kernel, std::uint64_t groups) {
            m_batches->add(0).dispatch({kernel, 0, m_defines, {}},
                                       {{"source", source(level)},
                                        {"range_rows", rows()},
                                        {"scales", m_scales},
                                        {"target", source(level + 1)},
                                        {"candidates", m_tree.normal_boxes},
                                        {"tree_nodes", m_tree.nodes},
                                        {"brackets", brackets},
                                        {"left_counts", left_counts},
                                        {"unsettled", unsettled},
                                        {"box_keys", m_box_keys}},
                                       push, groups * m_device.limits().subgroup_size);
        };
        do {
            gpu::Commands& commands = m_batches->add(static_cast<double>(m_tree.count));
            commands.fill(unsettled, 0);
            commands.fill(m_box_keys, ~0u);
            dispatch("photons/choose_brackets.comp", nodes);
            dispatch("photons/keep_between.comp", nodes * push.parts);
            dispatch("photons/find_pivots.comp", nodes);
            dispatch("photons/count_lefts.comp", nodes * push.parts);
            dispatch("photons/move_parts.comp", nodes * push.parts);
            read_boxes(level + 1);
            m_batches->run();
            ++push.round;
        } while (unsettled.read<std::uint32_t>(1)[0] > 0);
    }

    gpu::Device& m_device;
    const PhotonMap& m_photons;
    const RangeRows* m_ranges; // may be none
    TreeAxes m_axes;
    float m_parameter_scale;
    std::optional<Batches> m_batches;
    std::vector<std::string> m_defines;
    KdTree m_tree;
    gpu::Buffer m_scales, m_box_keys, m_emitters;
};

} // namespace

std::uint32_t find_leaf_level(std::uint64_t photon_count) {
    std::uint32_t level = 0;
    while (find_largest_node(photon_count, level) > shared::TREE_LEAF_PHOTONS)
        ++level;
    return level;
}

std::uint32_t find_first_position(std::uint64_t count, std::uint64_t node, std::uint32_t level) {
    return static_cast<std::uint32_t>(std::min(shared::TREE_TILE * (count_tiles(count) * node >> level), count));
}

KdTree build_tree(gpu::Device& device, const PhotonMap& photons, const Progress& progress) {
    return TreeBuilder(device, photons, nullptr, TreeAxes::positions, 0, progress).build();
}

KdTree build_tree(gpu::Device& device, const PhotonMap& photons, const RangeRows& ranges, TreeAxes axes,
                  float parameter_scale, const Progress& progress) {
    return TreeBuilder(device, photons, axes == TreeAxes::positions ? nullptr : &ranges, axes, parameter_scale, progress)
        .build();
}

} // namespace photonloupe
