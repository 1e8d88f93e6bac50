// SPDX-License-Identifier: Apache-2.0
// Drives the walks of all pixels until each has found its photon.
#include "inspect/voronoi.h"

#include <algorithm>
#include <bit>
#include <limits>

#include "gpu/commands.h"

namespace photonloupe::inspect {
namespace {

constexpr const char* STAGE = "find cells";
// Of one dispatch: the walks of a subgroup, up to 16 lanes, share the device's limit (shaders/shared/turns.glsl).
constexpr std::uint32_t WALK_TURNS = 2048;
// A walk visits each node and each photon once at most, so that many dispatches always suffice.
std::uint64_t count_dispatches(const KdTree& tree) {
    return (tree.count + (2ull << tree.leaf_level)) / (WALK_TURNS / 2) + 1;
}

gpu::Buffer start_walks(gpu::Device& device, std::uint64_t count) {
    const shared::uvec4 start{1u, std::bit_cast<std::uint32_t>(std::numeric_limits<float>::infinity()), shared::NO_CELL,
                              0u};
    return gpu::make_buffer(device, std::vector<shared::uvec4>(count, start), "walks to photons");
}

void walk_on(gpu::Device& device, const KdTree& tree, const SurfaceView& view, const gpu::Buffer& walks,
             shared::CellSettings settings, const Progress& progress) {
    gpu::dispatch_in_chunks(device, STAGE, {"inspect/find_cells.comp", 64, {}, {}},
                            {{"tree_nodes", tree.nodes},
                             {"tree_positions", tree.positions},
                             {"tree_normals", tree.normals},
                             {"normal_bounds", tree.normal_boxes},
                             {"surface_points", view.points},
                             {"surface_normals", view.normals},
                             {"walks", walks}},
                            settings, view.pixel_count(), 4096, progress);
}

} // namespace

CellImage find_voronoi_cells(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const SurfaceView& view,
                             const VoronoiSettings& settings, const Progress& progress) {
    CellImage image = make_cell_image(view);
    if (tree.count == 0)
        return image;
    shared::CellSettings push = make_cell_settings(photons, tree, view);
    push.flatness = settings.flatness;
    push.turns = WALK_TURNS;
    const gpu::Buffer walks = start_walks(device, view.pixel_count());
    std::vector<shared::uvec4> states;
    for (std::uint64_t left = count_dispatches(tree); left > 0; --left) {
        walk_on(device, tree, view, walks, push, progress);
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
