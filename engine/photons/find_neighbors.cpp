// SPDX-License-Identifier: Apache-2.0
// Drives the neighbour kernel: queries visit the tree in its own order, results stay in the caller's.
#include "photons/find_neighbors.h"

#include <algorithm>
#include <bit>
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

// A query for each id: its position, and in w the id, which is left out.
std::vector<glm::vec4> read_positions_of(const PhotonMap& photons, std::span<const std::uint32_t> ids) {
    const std::vector<glm::vec4> positions = photons.position_emitter.read<glm::vec4>(photons.count);
    std::vector<glm::vec4> queries;
    for (const std::uint32_t id : ids)
        queries.emplace_back(glm::vec3(positions[id]), std::bit_cast<float>(id));
    return queries;
}

// The same, one photon at a time, where memory is shared.
std::vector<glm::vec4> take_positions(const PhotonMap& photons, std::span<const std::uint32_t> ids) {
    std::vector<glm::vec4> queries;
    for (const std::uint32_t id : ids) {
        glm::vec4 position;
        photons.position_emitter.download(&position, sizeof position, std::uint64_t{id} * sizeof position);
        queries.emplace_back(glm::vec3(position), std::bit_cast<float>(id));
    }
    return queries;
}

// Below this share of the map, queries are few.
constexpr std::uint64_t FEW_DIVISOR = 16;

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
    // A few photons of a large map, as under a loupe: neither all positions nor the whole tree order is looked at.
    const bool are_few = photons.position_emitter.mapped() && ids.size() * FEW_DIVISOR < photons.count;
    const std::vector<glm::vec4> queries = are_few ? take_positions(photons, ids) : read_positions_of(photons, ids);
    return answer(device, tree, gpu::make_buffer(device, queries, "queries"),
                  are_few ? order_points(queries) : order_by_tree(tree, ids), k, true, progress);
}

} // namespace photonloupe
