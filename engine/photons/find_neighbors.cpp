// SPDX-License-Identifier: Apache-2.0
// Drives the neighbour kernel: queries visit the tree in its own order, results stay in the caller's.
#include "photons/find_neighbors.h"

#include "photons/scan_photons.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <numeric>

namespace photonloupe {
namespace {

constexpr const char* STAGE = "find neighbors";

// What a query looks at beside the tree; empty buffers stand for what its space does not read.
struct Sought {
    const KdTree& tree;
    std::uint32_t space = shared::SPACE_WORLD;
    std::vector<std::string> defines;
    const gpu::Buffer* tree_parameters = nullptr;
    const gpu::Buffer* periods = nullptr;
    std::array<float, 3> tree_period{};
    float limit2 = 0;
    ScanShape scan;
};

Neighbors answer(gpu::Device& device, const Sought& sought, const NeighborQueries& queries,
                 std::span<const std::uint32_t> order, std::uint32_t k, bool exclude_self, const Progress& progress) {
    const KdTree& tree = sought.tree;
    const std::uint64_t bytes = order.size() * k * sizeof(float);
    Neighbors neighbors{gpu::Buffer(device, bytes, "neighbor ids"), gpu::Buffer(device, bytes, "neighbor distances")};
    QueryKernels kernels{"photons/find_neighbors.comp", "photons/select_neighbors.comp", sought.defines, k};
    kernels.defines.push_back("SPACE " + std::to_string(sought.space));
    shared::NeighborQuery settings{};
    settings.k = k;
    settings.exclude_self = exclude_self ? 1 : 0;
    settings.limit2 = sought.limit2;
    settings.period = {sought.tree_period[0], sought.tree_period[1], sought.tree_period[2], 0.0f};
    const gpu::Buffer points = gpu::make_buffer(device, queries.points, "queries");
    const auto upload_rows = [&](const std::vector<glm::vec4>& rows) {
        return gpu::make_buffer(device, rows.empty() ? std::vector<glm::vec4>(1) : rows, "queries");
    };
    const gpu::Buffer parameters = upload_rows(queries.parameters);
    const gpu::Buffer layers = upload_rows(queries.layers);
    const gpu::Buffer range_ends = upload_rows(queries.range_ends);
    const std::vector<std::uint32_t> left = run_queries(
        device, tree, kernels, order, settings, STAGE,
        [&](gpu::Commands& commands, const gpu::KernelSource& kernel, const QueryBuffers& buffers,
            const shared::NeighborQuery& push, std::uint64_t invocations) {
            commands.dispatch(kernel,
                              {{"tree_nodes", tree.nodes},
                               {"tree_positions", tree.positions},
                               {"tree_normals", tree.normals},
                               {"tree_parameters", sought.tree_parameters ? *sought.tree_parameters : tree.positions},
                               {"parameter_periods", sought.periods ? *sought.periods : parameters},
                               {"query_parameters", parameters},
                               {"query_layers", layers},
                               {"range_ends", range_ends},
                               {"candidates", buffers.candidates},
                               {"ranked", buffers.ranked},
                               {"unanswered", buffers.unanswered},
                               {"queries", points},
                               {"query_order", buffers.order},
                               {"neighbor_ids", neighbors.ids},
                               {"neighbor_distances", neighbors.distances}},
                              push, invocations);
        },
        progress);
    // A query that reaches more photons than a workgroup may look through is answered one by one.
    if (!left.empty())
        scan_photons(tree, sought.scan, queries, left, k, exclude_self, neighbors, progress);
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
    NeighborQueries asked;
    asked.points.assign(queries.begin(), queries.end());
    return answer(device, {tree}, asked, order_points(queries), k, exclude_self, progress);
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
    NeighborQueries queries;
    queries.points = are_few ? take_positions(photons, ids) : read_positions_of(photons, ids);
    return answer(device, {tree}, queries, are_few ? order_points(queries.points) : order_by_tree(tree, ids), k, true,
                  progress);
}

Neighbors find_in_parameter_space(gpu::Device& device, const ParameterTree& parameter_tree,
                                  const NeighborQueries& queries, std::uint32_t k, bool exclude_self,
                                  const Progress& progress) {
    require_k(k);
    const KdTree& tree = parameter_tree.tree;
    if (tree.count == 0 || queries.points.empty())
        return make_missing(device, queries.points.size(), k);
    Sought sought{tree, shared::SPACE_PARAMETER};
    sought.defines = list_parameter_defines(parameter_tree.shape);
    if (parameter_tree.shape.period != std::array<float, 3>{})
        sought.defines.emplace_back("PERIODIC");
    sought.tree_parameters = &parameter_tree.parameters;
    sought.periods = &parameter_tree.periods;
    sought.tree_period = parameter_tree.shape.period;
    sought.limit2 = parameter_tree.limit2;
    sought.scan = {shared::SPACE_PARAMETER, parameter_tree.shape.parameter_count, &parameter_tree.parameters,
                   &parameter_tree.periods};
    return answer(device, sought, queries, order_points(queries.points), k, exclude_self, progress);
}

Neighbors find_in_layers(gpu::Device& device, const PhotonMap& photons, const KdTree& tree, const Layers& tree_layers,
                         const NeighborQueries& queries, std::uint32_t k, bool exclude_self, const Progress& progress) {
    require_k(k);
    if (tree.count == 0 || queries.points.empty())
        return make_missing(device, queries.points.size(), k);
    GatherShape shape;
    add_parameters(shape, photons);
    Sought sought{tree, shared::SPACE_CONSTRAINED};
    sought.defines = list_parameter_defines(shape);
    if (!queries.range_ends.empty())
        sought.defines.emplace_back("LAYER_RANGES");
    sought.tree_parameters = &tree_layers.parameters;
    sought.periods = &tree_layers.periods;
    sought.scan = {shared::SPACE_CONSTRAINED, shape.parameter_count, &tree_layers.parameters, &tree_layers.periods};
    return answer(device, sought, queries, order_points(queries.points), k, exclude_self, progress);
}

} // namespace photonloupe
