// SPDX-License-Identifier: Apache-2.0
// Builds the kd-tree on the device, a level after the other: large nodes by several subgroups each, then a subgroup a
// node, then an invocation a node.
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "gpu/commands.h"
#include "photons/kd_tree.h"
#include "photons/tree_kernels.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "build tree";
// Copying a photon's columns costs as much as so many levels: they stand anywhere.
constexpr double ORDER_WORK = 3;
// Photons, levels counted, of the first batch; later ones follow the device's pace.
constexpr double FIRST_BATCH = 1 << 19, SMALLEST_BATCH = 1 << 16, LARGEST_BATCH = 1 << 28;

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
    TreeBuilder(gpu::Device& device, const TreePhotons& photons, const RangeRows* ranges, TreeAxes axes,
                float parameter_scale, const Progress& progress)
        : m_device(device), m_photons(photons), m_ranges(ranges), m_axes(axes), m_parameter_scale(parameter_scale) {
        m_tree.count = photons.count;
        m_tree.leaf_level = find_leaf_level(photons.count);
        m_tree.range_rows = ranges ? ranges->count_rows() : 0;
        m_batches.emplace(device, progress, static_cast<double>(photons.count) * (m_tree.leaf_level + 1 + ORDER_WORK));
        m_kernels.emplace(m_tree.range_rows, device.limits().subgroup_size);
        allocate();
    }

    KdTree build() {
        if (m_tree.count == 0)
            return std::move(m_tree);
        m_device.compile_ahead(m_kernels->list(m_tree.count));
        if (m_ranges)
            m_device.compile_ahead({m_kernels->scale_axes(m_ranges->axis_count, m_axes)});
        number_photons();
        for (std::uint32_t level = 0; level < m_tree.leaf_level; ++level)
            if (const std::uint64_t largest = find_largest_node(m_tree.count, level);
                m_kernels->splits_in_parts(largest))
                split_large_nodes(level);
            else
                split_nodes(level, m_kernels->split_nodes(largest));
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
    const gpu::Buffer& rows() const { return m_ranges ? m_ranges->values : m_photons.positions; }

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
                .dispatch(m_kernels->number_photons(),
                          {{"position_emitter", m_photons.positions},
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
        m_batches->add(0).dispatch(m_kernels->read_boxes(), {{"tree_nodes", m_tree.nodes}, {"box_keys", m_box_keys}},
                                   make_push(level, 0, 1ull << level), 1ull << level);
    }

    void scale_axes() {
        m_batches->add(0).dispatch(m_kernels->scale_axes(m_ranges->axis_count, m_axes),
                                   {{"source", source(0)},
                                    {"range_rows", rows()},
                                    {"scales", m_scales},
                                    {"axis_scales", m_scales},
                                    {"target", source(1)},
                                    {"candidates", m_tree.normal_boxes},
                                    {"tree_nodes", m_tree.nodes}},
                                   make_push(0, 0, 1), 1);
    }

    void split_nodes(std::uint32_t level, const gpu::KernelSource& kernel) {
        const std::uint64_t invocations = kernel.workgroup_size ? 1 : m_device.limits().subgroup_size; // a node
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
            order_columns(m_batches->add(ORDER_WORK * static_cast<double>(count)), m_photons, m_ranges, m_tree,
                          m_emitters, first, count);
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
        const auto dispatch = [&](const gpu::KernelSource& kernel, std::uint64_t groups) {
            m_batches->add(0).dispatch(kernel,
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
        const std::vector<gpu::KernelSource> kernels = m_kernels->split_in_parts();
        do {
            gpu::Commands& commands = m_batches->add(static_cast<double>(m_tree.count));
            commands.fill(unsettled, 0);
            commands.fill(m_box_keys, ~0u);
            const std::uint64_t parts = nodes * push.parts;
            dispatch(kernels[0], nodes); // brackets
            dispatch(kernels[1], parts);
            dispatch(kernels[2], nodes); // pivots
            dispatch(kernels[3], parts);
            dispatch(kernels[4], parts);
            read_boxes(level + 1);
            m_batches->run();
            ++push.round;
        } while (unsettled.read<std::uint32_t>(1)[0] > 0);
    }

    gpu::Device& m_device;
    TreePhotons m_photons;
    const RangeRows* m_ranges; // may be none
    TreeAxes m_axes;
    float m_parameter_scale;
    std::optional<Batches> m_batches;
    std::optional<TreeKernels> m_kernels;
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

KdTree build_tree(gpu::Device& device, const TreePhotons& photons, const Progress& progress) {
    return TreeBuilder(device, photons, nullptr, TreeAxes::positions, 0, progress).build();
}

KdTree build_tree(gpu::Device& device, const TreePhotons& photons, const RangeRows& ranges, TreeAxes axes,
                  float parameter_scale, const Progress& progress) {
    return TreeBuilder(device, photons, axes == TreeAxes::positions ? nullptr : &ranges, axes, parameter_scale,
                       progress)
        .build();
}

} // namespace photonloupe
