// SPDX-License-Identifier: Apache-2.0
// Drives the neighbour kernel: queries visit the tree in its own order, results stay in the caller's.
#include "photons/find_neighbors.h"

#include <algorithm>
#include <cstring>
#include <numeric>

namespace photonloupe {
namespace {

Neighbors answer(gpu::Device& device, const KdTree& tree, const gpu::Buffer& queries,
                 std::span<const std::uint32_t> order, std::uint32_t k, bool exclude_self, const Progress& progress) {
    const std::uint64_t bytes = order.size() * k * sizeof(float);
    Neighbors neighbors{gpu::Buffer(device, bytes, "neighbor ids"), gpu::Buffer(device, bytes, "neighbor distances")};
    const QueryKernels kernels{"photons/find_neighbors.comp", "photons/select_neighbors.comp", {}, k};
    shared::NeighborQuery settings{};
    settings.k = k;
    settings.exclude_self = exclude_self ? 1 : 0;
    run_queries(
        device, tree, kernels, order, settings, "find neighbors",
        [&](gpu::Commands& commands, const gpu::KernelSource& kernel, const QueryBuffers& buffers,
            const shared::NeighborQuery& push, std::uint64_t invocations) {
            commands.dispatch(kernel,
                              {{"tree_nodes", tree.nodes},
                               {"tree_positions", tree.positions},
                               {"candidates", buffers.candidates},
                               {"ranked", buffers.ranked},
                               {"unanswered", buffers.unanswered},
                               {"queries", queries},
                               {"query_order", buffers.order},
                               {"neighbor_ids", neighbors.ids},
                               {"neighbor_distances", neighbors.distances}},
                              push, invocations);
        },
        progress);
    return neighbors;
}

Neighbors make_missing(gpu::Device& device, std::uint64_t query_count, std::uint32_t k) {
    const std::vector<std::int32_t> ids(query_count * k, -1);
    const std::vector<float> distances(query_count * k, std::numeric_limits<float>::infinity());
    return {gpu::make_buffer(device, ids, "neighbor ids"), gpu::make_buffer(device, distances, "neighbor distances")};
}

// Queries in the order their photons stand in the tree (counting sort over tree positions).
std::vector<std::uint32_t> order_by_tree(const KdTree& tree, std::span<const std::uint32_t> ids) {
    std::vector<std::uint32_t> position_of(tree.count);
    const std::vector<glm::vec4> positions = tree.positions.read<glm::vec4>(tree.count);
    for (std::uint32_t position = 0; position < positions.size(); ++position) {
        std::uint32_t id;
        std::memcpy(&id, &positions[position].w, sizeof id);
        position_of[id] = position;
    }
    std::vector<std::uint32_t> starts(tree.count + 1);
    for (std::uint32_t id : ids)
        ++starts[position_of[id] + 1];
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    std::vector<std::uint32_t> order(ids.size());
    for (std::uint32_t query = 0; query < ids.size(); ++query)
        order[starts[position_of[ids[query]]]++] = query;
    return order;
}

} // namespace

Neighbors find_neighbors(gpu::Device& device, const KdTree& tree, std::span<const glm::vec4> queries, std::uint32_t k,
                         bool exclude_self, const Progress& progress) {
    require_k(k);
    if (tree.count == 0 || queries.empty())
        return make_missing(device, queries.size(), k);
    return answer(device, tree, gpu::make_buffer(device, queries, "queries"), order_points(queries), k, exclude_self,
                  progress);
}

Neighbors find_neighbors_of(gpu::Device& device, const PhotonMap& photons, const KdTree& tree,
                            std::span<const std::uint32_t> ids, std::uint32_t k, const Progress& progress) {
    require_k(k);
    for (std::size_t row = 0; row < ids.size(); ++row)
        if (ids[row] >= photons.count)
            throw Error("photon id " + std::to_string(ids[row]) + " at row " + std::to_string(row) +
                        " is out of range; the map has " + std::to_string(photons.count) + " photons");
    if (ids.empty())
        return make_missing(device, 0, k);
    std::vector<glm::vec4> queries(ids.size());
    const std::vector<glm::vec4> positions = photons.position_emitter.read<glm::vec4>(photons.count);
    for (std::size_t row = 0; row < ids.size(); ++row) {
        queries[row] = positions[ids[row]];
        std::memcpy(&queries[row].w, &ids[row], sizeof ids[row]);
    }
    return answer(device, tree, gpu::make_buffer(device, queries, "queries"), order_by_tree(tree, ids), k, true,
                  progress);
}

} // namespace photonloupe
