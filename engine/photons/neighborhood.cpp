// SPDX-License-Identifier: Apache-2.0
// Names of what the searching kernels are specialised to and bind.
#include "photons/neighborhood.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "photons/kernel_macros.h"

namespace photonloupe {
namespace {

constexpr std::array<const char*, 3> PLANES{"yz", "xz", "xy"}; // without axis 0, 1, 2

} // namespace

Queries ask_photons(const KdTree& tree, const gpu::Buffer* reach2) {
    return {tree.count, &tree.positions, &tree.normals, tree.range_rows ? &tree.rows : nullptr, reach2, true};
}

std::string find_flat_axes(const KdTree& tree) {
    if (tree.count == 0)
        return "";
    const shared::TreeNode root = tree.nodes.read<shared::TreeNode>(1, 1)[0];
    const std::vector<glm::vec4> normals = tree.normal_boxes.read<glm::vec4>(2, 2);
    for (int axis = 0; axis < 3; ++axis) {
        glm::vec3 along(0.0f);
        along[axis] = normals[0][axis];
        if (std::abs(along[axis]) == 1.0f && glm::vec3(normals[0]) == along && glm::vec3(normals[1]) == along &&
            root.lo_split[axis] == root.hi_axis[axis])
            return PLANES[static_cast<std::size_t>(axis)];
    }
    return "";
}

bool find_one_normal(const KdTree& tree) {
    if (tree.count == 0)
        return false;
    const std::vector<glm::vec4> normals = tree.normal_boxes.read<glm::vec4>(2, 2);
    // Photons in media share no surface's normal, even where all came from one direction.
    return glm::vec3(normals[0]) == glm::vec3(normals[1]) &&
           glm::length(glm::vec3(normals[0])) > shared::SURFACE_NORMAL_LENGTH;
}

std::vector<std::string> list_defines(const Neighborhood& neighborhood, const Queries& queries) {
    std::vector<std::string> defines;
    const bool is_in_space = neighborhood.measure != Measure::parameters;
    if (queries.are_photons)
        defines.emplace_back("OWN_PHOTONS");
    if (queries.normals)
        defines.emplace_back("HAS_NORMALS");
    if (!is_in_space)
        defines.emplace_back("IN_PARAMETER_SPACE");
    else if (!neighborhood.flat_axes.empty())
        defines.push_back("FLAT_AXES " + neighborhood.flat_axes);
    else if (neighborhood.measure == Measure::surface)
        defines.emplace_back("ON_SURFACE");
    if (neighborhood.has_one_normal)
        defines.emplace_back("ONE_NORMAL");
    if (neighborhood.period != std::array<float, 3>{})
        defines.emplace_back("PERIODIC");
    const bool needs_rows = !is_in_space || neighborhood.is_layered || neighborhood.intervals;
    if (!needs_rows)
        return defines;
    const std::uint32_t rows = neighborhood.tree.range_rows;
    defines.push_back("ROW_COUNT " + std::to_string(rows) + "u");
    defines.push_back(write_each("EACH_ROW", 0, rows));
    defines.push_back(write_each("EACH_PARAMETER", 1, neighborhood.axis_count));
    if (neighborhood.has_periods)
        defines.emplace_back("PERIODIC_PARAMETERS");
    if (neighborhood.is_layered)
        defines.emplace_back("SAME_LAYER");
    if (neighborhood.intervals)
        defines.emplace_back("IN_INTERVALS");
    return defines;
}

std::vector<gpu::Binding> list_bindings(const Neighborhood& neighborhood, const Queries& queries) {
    const KdTree& tree = neighborhood.tree;
    const auto choose = [&](const gpu::Buffer* buffer) -> const gpu::Buffer& { return buffer ? *buffer : tree.nodes; };
    return {{"tree_nodes", tree.nodes},
            {"tree_positions", tree.positions},
            {"tree_normals", tree.normals},
            {"normal_boxes", tree.normal_boxes},
            {"tree_rows", choose(tree.range_rows ? &tree.rows : nullptr)},
            {"tree_ranges", choose(tree.range_rows ? &tree.ranges : nullptr)},
            {"row_periods", choose(neighborhood.row_periods)},
            {"interval_rows", choose(neighborhood.intervals)},
            {"query_points", choose(queries.points)},
            {"query_normals", choose(queries.normals)},
            {"query_rows", choose(queries.rows)},
            {"query_reach", choose(queries.reach2)}};
}

} // namespace photonloupe
