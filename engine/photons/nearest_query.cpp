// SPDX-License-Identifier: Apache-2.0
// Picks tree, measure and what queries bring along for each space.
#include "photons/nearest_query.h"

#include <limits>

namespace photonloupe {
namespace {

// Squared r_q of queries with rows; inf where fewer than k have parameters.
std::vector<float> find_radii2_of(gpu::Device& device, IndexedMap& photons, const NeighborQueries& queries,
                                  std::uint32_t k, const Progress& progress) {
    const OrderedQueries ordered = order_queries(device, queries);
    const gpu::Buffer radii =
        find_parameter_radii(device, *find_parameter_tree(device, photons, progress), ordered.view(), k, progress);
    const std::vector<glm::vec4> found = radii.read<glm::vec4>(ordered.count);
    const std::vector<std::uint32_t> rows = ordered.result_rows.read<std::uint32_t>(ordered.count);
    std::vector<float> radii2(ordered.count);
    for (std::size_t i = 0; i < found.size(); ++i)
        radii2[rows[i]] = found[i].w >= static_cast<float>(k) ? found[i].x : std::numeric_limits<float>::infinity();
    return radii2;
}

} // namespace

Neighbors find_neighbors(gpu::Device& device, IndexedMap& photons, const NearestQuery& query,
                         const Progress& progress) {
    require_k(query.k);
    const auto find = [&](const Neighborhood& among, const NeighborQueries& queries) {
        return find_neighbors(device, among, queries, query.k, progress);
    };
    if (query.space == SearchSpace::world) {
        const std::shared_ptr<const KdTree> tree = find_tree(device, photons, progress);
        return find({*tree}, query.ids ? ask_about(photons.map, *query.ids) : ask_at(query.places));
    }
    if (query.space == SearchSpace::parameter) {
        const std::shared_ptr<const ParameterTree> tree = find_parameter_tree(device, photons, progress);
        return find(look_in(*tree, Measure::parameters), query.ids
                                                             ? ask_with_rows(photons.map, *tree->parameters, *query.ids)
                                                             : ask_parameters_at(*tree->parameters, query.values));
    }
    const std::shared_ptr<const ParameterTree> tree = find_layered_tree(device, photons, progress);
    const auto ask_with_radii = [&](std::span<const std::uint32_t> ids) {
        NeighborQueries queries = ask_with_rows(photons.map, *tree->parameters, ids);
        for (const float radius2 : find_radii2_of(device, photons, queries, query.k, progress))
            queries.reach2.push_back(scale_reach2(radius2, query.beta));
        return queries;
    };
    if (query.ids)
        return find(look_in(*tree, Measure::world), ask_with_radii(*query.ids));
    NeighborQueries queries = ask_at(query.places);
    if (query.center) {
        const NeighborQueries center = ask_with_radii(std::span(&*query.center, 1));
        seek_in_layer(queries, center.rows, center.reach2[0]);
    } else {
        seek_in_intervals(queries, query.low, query.high);
    }
    return find(look_in(*tree, Measure::world), queries);
}

} // namespace photonloupe
