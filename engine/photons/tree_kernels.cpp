// SPDX-License-Identifier: Apache-2.0
// Names the kernels that build a kd-tree.
#include "photons/tree_kernels.h"

#include <algorithm>
#include <bit>

#include "photons/kernel_macros.h"

namespace photonloupe {
namespace {

// Nodes of more photons are split by several subgroups. One subgroup may pass over a node 26 times (split_nodes.comp)
// and then has loop turns left (shaders/shared/turns.glsl).
constexpr std::uint64_t LARGE_NODE_PHOTONS = 16384, LARGE_NODE_BLOCKS = 2048;
// The largest nodes that an invocation sorts alone. Twice as many would be no faster, and the longer kernel takes the
// driver seconds to compile.
constexpr std::uint32_t SMALL_NODE_PHOTONS = 64;
constexpr std::uint32_t SMALLEST_SORT = 32;

} // namespace

std::uint64_t count_tiles(std::uint64_t photon_count) {
    return (photon_count + shared::TREE_TILE - 1) / shared::TREE_TILE;
}

std::uint64_t find_largest_node(std::uint64_t photon_count, std::uint32_t level) {
    return shared::TREE_TILE * ((count_tiles(photon_count) + (1ull << level) - 1) >> level);
}

TreeKernels::TreeKernels(std::uint32_t range_rows, std::uint32_t subgroup_size) : m_subgroup_size(subgroup_size) {
    if (range_rows > 0)
        m_defines.push_back("RANGE_ROWS " + std::to_string(range_rows) + "u");
}

gpu::KernelSource TreeKernels::number_photons() const {
    return {"photons/number_photons.comp", 0, {}, {}};
}

gpu::KernelSource TreeKernels::read_boxes() const {
    return {"photons/read_boxes.comp", 64, {}, {}};
}

gpu::KernelSource TreeKernels::scale_axes(std::uint32_t axis_count, TreeAxes axes) const {
    gpu::KernelSource kernel{"photons/scale_axes.comp", 0, m_defines, {}};
    kernel.defines.push_back("RANGE_AXES " + std::to_string(axis_count) + "u");
    if (axes == TreeAxes::both)
        kernel.defines.emplace_back("SPLIT_POSITIONS");
    return kernel;
}

bool TreeKernels::splits_in_parts(std::uint64_t largest_node) const {
    return largest_node > std::min(LARGE_NODE_PHOTONS, LARGE_NODE_BLOCKS * m_subgroup_size);
}

std::vector<gpu::KernelSource> TreeKernels::split_in_parts() const {
    std::vector<gpu::KernelSource> kernels;
    for (const char* path : {"photons/choose_brackets.comp", "photons/keep_between.comp", "photons/find_pivots.comp",
                             "photons/count_lefts.comp", "photons/move_parts.comp"})
        kernels.push_back({path, 0, m_defines, {}});
    return kernels;
}

gpu::KernelSource TreeKernels::split_nodes(std::uint64_t largest_node) const {
    if (largest_node > SMALL_NODE_PHOTONS)
        return {"photons/split_nodes.comp", 0, m_defines, {}};
    const std::uint32_t size = std::max(SMALLEST_SORT, std::bit_ceil(static_cast<std::uint32_t>(largest_node)));
    gpu::KernelSource kernel{"photons/split_small_nodes.comp", 64, m_defines, {}};
    kernel.defines.push_back("SORT_SIZE " + std::to_string(size));
    kernel.defines.push_back(write_each("EACH_KEY", 0, size));
    kernel.defines.push_back(write_sort_network(size));
    return kernel;
}

gpu::KernelSource TreeKernels::order_columns() const {
    return {"photons/order_columns.comp", ORDER_GROUP, m_defines, {}};
}

gpu::KernelSource TreeKernels::refit_leaves() const {
    return {"photons/refit_leaves.comp", 64, m_defines, {}};
}

gpu::KernelSource TreeKernels::refit_nodes() const {
    return {"photons/refit_nodes.comp", 64, m_defines, {}};
}

std::vector<gpu::KernelSource> TreeKernels::list(std::uint64_t photon_count) const {
    std::vector<gpu::KernelSource> kernels{number_photons(), read_boxes()};
    if (splits_in_parts(find_largest_node(photon_count, 0)))
        for (gpu::KernelSource& kernel : split_in_parts())
            kernels.push_back(std::move(kernel));
    for (std::uint32_t level = 0; level < find_leaf_level(photon_count); ++level)
        if (const std::uint64_t largest = find_largest_node(photon_count, level); !splits_in_parts(largest)) {
            gpu::KernelSource kernel = split_nodes(largest);
            if (gpu::make_key(kernel) != gpu::make_key(kernels.back()))
                kernels.push_back(std::move(kernel));
        }
    kernels.insert(kernels.end(), {order_columns(), refit_leaves(), refit_nodes()});
    return kernels;
}

} // namespace photonloupe
