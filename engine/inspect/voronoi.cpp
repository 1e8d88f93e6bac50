// SPDX-License-Identifier: Apache-2.0
// Drives the walks of all pixels until each has found its photon.
#include "inspect/voronoi.h"

#include <algorithm>
#include <bit>
#include <limits>

#include <glm/common.hpp>

#include "gpu/commands.h"
#include "inspect/cell_walks.h"

namespace photonloupe::inspect {
namespace {

constexpr const char* STAGE = "find cells";
// Of one dispatch: the walks of a subgroup, up to 16 lanes, share the device's limit (shaders/shared/turns.glsl).
constexpr std::uint32_t WALK_TURNS = 2048;
// A walk visits each node and each photon once at most, so that many dispatches always suffice.
std::uint64_t count_dispatches(const KdTree& tree) {
    return (tree.count + (2ull << tree.leaf_level)) / (WALK_TURNS / 2) + 1;
}

// Two vec4s a node, by heap index: least and greatest components of its photons' normals. Without them a pixel that
// faces as no photon does would walk through the whole map.
gpu::Buffer bound_normals(gpu::Device& device, const KdTree& tree) {
    const std::vector<glm::vec4> normals = tree.normals.read<glm::vec4>(tree.count);
    const std::size_t leaves = std::size_t{1} << tree.leaf_level;
    std::vector<glm::vec4> bounds(4 * leaves);
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
        glm::vec4 low(std::numeric_limits<float>::max()), high(std::numeric_limits<float>::lowest());
        const std::uint32_t end = find_first_position(tree.count, leaf + 1, tree.leaf_level);
        for (std::uint32_t at = find_first_position(tree.count, leaf, tree.leaf_level); at < end; ++at) {
            low = glm::min(low, glm::vec4(glm::vec3(normals[at]), 0.0f));
            high = glm::max(high, glm::vec4(glm::vec3(normals[at]), 0.0f));
        }
        bounds[2 * (leaves + leaf)] = low;
        bounds[2 * (leaves + leaf) + 1] = high;
    }
    for (std::size_t node = leaves - 1; node > 0; --node) {
        bounds[2 * node] = glm::min(bounds[4 * node], bounds[4 * node + 2]);
        bounds[2 * node + 1] = glm::max(bounds[4 * node + 1], bounds[4 * node + 3]);
    }
    return gpu::make_buffer(device, bounds, "bounds of normals");
}

gpu::Buffer start_walks(gpu::Device& device, std::uint64_t count) {
    const shared::uvec4 start{1u, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()), shared::NO_CELL,
                              0u};
    return gpu::make_buffer(device, std::vector<shared::uvec4>(count, start), "walks to photons");
}

void walk_on(gpu::Device& device, const KdTree& tree, const SurfaceView& view, const gpu::Buffer& bounds,
             const gpu::Buffer& walks, shared::CellSettings settings, const Progress& progress) {
    gpu::run_in_chunks(device, STAGE, view.pixel_count(), 4096, progress,
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           settings.first = static_cast<std::uint32_t>(first);
                           settings.count = static_cast<std::uint32_t>(count);
                           commands.dispatch({"inspect/find_cells.comp", 64, {}, {}},
                                             {{"tree_nodes", tree.nodes},
                                              {"tree_positions", tree.positions},
                                              {"tree_normals", tree.normals},
                                              {"normal_bounds", bounds},
                                              {"surface_points", view.points},
                                              {"surface_normals", view.normals},
                                              {"walks", walks}},
                                             settings, count);
                       });
}

} // namespace

CellImage find_voronoi_cells(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const SurfaceView& view,
                             const VoronoiSettings& settings, const Progress& progress) {
    CellImage image = make_cell_image(view);
    image.is_border.assign(image.ids.size(), 0);
    if (tree.count == 0)
        return image;
    shared::CellSettings push = make_cell_settings(photons, tree, view);
    push.flatness = settings.flatness;
    push.turns = WALK_TURNS;
    const gpu::Buffer bounds = bound_normals(device, tree);
    const gpu::Buffer walks = start_walks(device, view.pixel_count());
    std::vector<shared::uvec4> states;
    for (std::uint64_t left = count_dispatches(tree); left > 0; --left) {
        walk_on(device, tree, view, bounds, walks, push, progress);
        states = walks.read<shared::uvec4>(view.pixel_count());
        if (std::all_of(states.begin(), states.end(), [](const shared::uvec4& state) { return state.x == 0; }))
            break;
    }
    for (std::size_t at = 0; at < states.size(); ++at)
        image.ids[at] = std::bit_cast<std::int32_t>(states[at].z);
    find_borders(image);
    return image;
}

} // namespace photonloupe::inspect
