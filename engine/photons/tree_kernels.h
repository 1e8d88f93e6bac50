// SPDX-License-Identifier: Apache-2.0
// The kernels that build a kd-tree: which node is split by which, and all of them before there are any photons.
#pragma once

#include "photons/kd_tree.h"

namespace photonloupe {

std::uint64_t count_tiles(std::uint64_t photon_count);
// The most photons that a node of a level has.
std::uint64_t find_largest_node(std::uint64_t photon_count, std::uint32_t level);

// Specialised to how many vec4s of ranges a photon has; 0: to positions alone.
class TreeKernels {
public:
    TreeKernels(std::uint32_t range_rows, std::uint32_t subgroup_size);

    gpu::KernelSource number_photons() const;
    gpu::KernelSource read_boxes() const;
    gpu::KernelSource scale_axes(std::uint32_t axis_count, TreeAxes axes) const;
    // Nodes of so many photons are split by several subgroups each: in the order in which these kernels run.
    bool splits_in_parts(std::uint64_t largest_node) const;
    std::vector<gpu::KernelSource> split_in_parts() const;
    // Other nodes: by a subgroup each (workgroup_size 0), or by an invocation.
    gpu::KernelSource split_nodes(std::uint64_t largest_node) const;
    gpu::KernelSource order_columns() const;
    gpu::KernelSource refit_leaves() const;
    gpu::KernelSource refit_nodes() const;

    // All that a tree of so many photons needs, each once, as they are first used; without scale_axes().
    std::vector<gpu::KernelSource> list(std::uint64_t photon_count) const;

private:
    std::uint32_t m_subgroup_size;
    std::vector<std::string> m_defines;
};

} // namespace photonloupe
