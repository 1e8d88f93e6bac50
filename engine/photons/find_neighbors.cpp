// SPDX-License-Identifier: Apache-2.0
// Finds the radius of every query, then lists who lies within and puts the lists in order.
#include "photons/find_neighbors.h"

#include "photons/kernel_macros.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "find neighbors";
constexpr std::uint32_t SORT_GROUP = 64;
constexpr std::uint32_t SORT_RUN = 32;            // sorted at once in registers
constexpr std::uint32_t LARGEST_WAYS = 8;         // runs merged at a time
constexpr std::uint64_t LIST_BYTES = 64ull << 20; // of the lists under way together
constexpr std::uint64_t PAIR_BYTES = sizeof(glm::uvec2);

std::vector<std::string> list_sort_defines(std::uint32_t k) {
    const std::uint32_t ways = std::clamp((k + SORT_RUN - 1) / SORT_RUN, 2u, LARGEST_WAYS);
    return {"RUN " + std::to_string(SORT_RUN) + "u", write_sort_network(SORT_RUN),
            write_each("EACH_OF_RUN", 0, SORT_RUN, "u"), "WAYS " + std::to_string(ways) + "u",
            write_each("EACH_WAY", 0, ways)};
}

gpu::KernelSource name_sort_kernel(std::uint32_t k) {
    return {"photons/sort_neighbors.comp", SORT_GROUP, list_sort_defines(k), {}};
}

} // namespace

Neighbors find_neighbors(gpu::Device& device, Neighborhood neighborhood, const NeighborQueries& queries,
                         std::uint32_t k, const Progress& progress) {
    require_k(k);
    const std::uint64_t count = queries.points.size();
    if (neighborhood.tree.count == 0 || count == 0) {
        const std::vector<std::int32_t> nobody(count * k, -1);
        const std::vector<float> nowhere(count * k, std::numeric_limits<float>::infinity());
        return {gpu::make_buffer(device, nobody, "neighbor ids"),
                gpu::make_buffer(device, nowhere, "neighbor distances")};
    }
    const OrderedQueries ordered = order_queries(device, queries);
    neighborhood.is_layered = !queries.reach2.empty();
    neighborhood.intervals = queries.intervals.empty() ? nullptr : &ordered.intervals;
    const Queries asked = ordered.view();
    const gpu::Buffer radii(device, count * RADIUS_BYTES, "radii of queries");
    RadiusSettings radius{k + 1}; // those before the next one
    radius.cuts_ties = radius.leaves_self_out = true;
    GatherKernel list{"photons/list_neighbors.comp", {"CUT_TIES", "BY_ID", "WITHOUT_SELF"}, {}};
    device.compile_ahead({name_radius_kernel(neighborhood, asked, radius),
                          name_gather_kernel(neighborhood, asked, list), name_sort_kernel(k)});
    find_radii(device, neighborhood, asked, radius, radii, STAGE, progress);

    Neighbors neighbors{gpu::Buffer(device, count * k * sizeof(float), "neighbor ids"),
                        gpu::Buffer(device, count * k * sizeof(float), "neighbor distances")};
    const std::uint64_t part = std::min(count, std::max<std::uint64_t>(LIST_BYTES / (2 * k * PAIR_BYTES), 1));
    const gpu::Buffer found(device, 2 * part * k * PAIR_BYTES, "neighbor lists");
    const gpu::Buffer found_counts(device, part * sizeof(std::uint32_t), "neighbor lists");
    for (const gpu::Binding& binding :
         {gpu::Binding{"radii", radii}, {"found_neighbors", found}, {"found_counts", found_counts}})
        list.bindings.push_back(binding);
    const gpu::KernelSource sorting = name_sort_kernel(k);
    for (std::uint64_t first = 0; first < count; first += part) {
        const std::uint64_t rows = std::min(part, count - first);
        const auto row_first = static_cast<std::uint32_t>(first);
        const shared::ListSettings push{make_gather_settings(neighborhood, k + 1), row_first, k, 0, 0};
        run_gather(device, neighborhood, asked, list, std::as_bytes(std::span(&push, 1)), first, rows, STAGE, progress);
        gpu::run_in_chunks(device, STAGE, rows, SORT_GROUP * 16, progress,
                           [&](gpu::Commands& commands, std::uint64_t begin, std::uint64_t size) {
                               const shared::SortSettings sort{static_cast<std::uint32_t>(first + begin),
                                                               static_cast<std::uint32_t>(size),
                                                               row_first,
                                                               k,
                                                               static_cast<std::uint32_t>(part * k),
                                                               0,
                                                               0,
                                                               0};
                               commands.dispatch(sorting,
                                                 {{"found_neighbors", found},
                                                  {"found_counts", found_counts},
                                                  {"result_rows", ordered.result_rows},
                                                  {"neighbor_ids", neighbors.ids},
                                                  {"neighbor_distances", neighbors.distances}},
                                                 sort, size);
                           });
    }
    return neighbors;
}

} // namespace photonloupe
