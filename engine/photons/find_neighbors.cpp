// SPDX-License-Identifier: Apache-2.0
// Finds the radius of every query, then lists who lies within and puts the lists in order.
#include "photons/find_neighbors.h"

#include "photons/kernel_macros.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "find neighbors";
constexpr std::uint32_t SORT_GROUP = 64;
// Sorted at once in registers. The kernel is the same for every k: somebody who tries one does not wait for a compiler.
constexpr std::uint32_t RUN = 64;
constexpr std::uint64_t LIST_BYTES = 64ull << 20; // of the lists under way together
constexpr std::uint64_t PAIR_BYTES = sizeof(glm::uvec2);

std::uint32_t count_runs(std::uint32_t k) {
    return (k + RUN - 1) / RUN;
}

// What puts lists of k in order: sorted runs, merged where there are several.
std::vector<gpu::KernelSource> list_sort_kernels(std::uint32_t k) {
    const std::uint32_t runs = count_runs(k);
    const std::string size = "RUN " + std::to_string(RUN) + "u";
    std::vector<gpu::KernelSource> kernels{{"photons/sort_neighbors.comp",
                                            SORT_GROUP,
                                            {size, write_sort_network(RUN), write_each("EACH_OF_RUN", 0, RUN, "u"),
                                             write_each("EACH_PAIR_OF_RUN", 0, RUN / 2, "u")},
                                            {}}};
    if (runs == 1)
        kernels[0].defines.emplace_back("IS_WHOLE");
    else
        kernels.push_back({"photons/merge_neighbors.comp",
                           SORT_GROUP,
                           {size, "RUNS " + std::to_string(runs), write_each("EACH_RUN", 0, runs)},
                           {}});
    return kernels;
}

// Lists of members, a part of the queries at a time, and where their answers go.
struct Lists {
    gpu::Device& device;
    std::uint32_t k;
    const gpu::Buffer& found;
    const gpu::Buffer& found_counts;
    const gpu::Buffer& result_rows;
    const Neighbors& neighbors;

    // Puts those of queries first … first + rows - 1 in order.
    void sort(std::uint64_t first, std::uint64_t rows, const Progress& progress) const {
        const std::vector<gpu::KernelSource> kernels = list_sort_kernels(k);
        const std::vector<gpu::Binding> bindings{
            {"found_lists", found},       {"found_neighbors", found},      {"found_counts", found_counts},
            {"result_rows", result_rows}, {"neighbor_ids", neighbors.ids}, {"neighbor_distances", neighbors.distances}};
        gpu::run_in_chunks(device, STAGE, rows, SORT_GROUP * 16, progress,
                           [&](gpu::Commands& commands, std::uint64_t begin, std::uint64_t size) {
                               const shared::SortSettings settings{static_cast<std::uint32_t>(first + begin),
                                                                   static_cast<std::uint32_t>(size),
                                                                   static_cast<std::uint32_t>(first), k};
                               const auto push = std::as_bytes(std::span(&settings, 1));
                               commands.dispatch_bytes(kernels[0], bindings, push, size * count_runs(k));
                               if (kernels.size() > 1)
                                   commands.dispatch_bytes(kernels[1], bindings, push, size);
                           });
    }
};

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
    std::vector<gpu::KernelSource> kernels = list_sort_kernels(k);
    kernels.insert(kernels.begin(),
                   {name_radius_kernel(neighborhood, asked, radius), name_gather_kernel(neighborhood, asked, list)});
    device.compile_ahead(kernels);
    find_radii(device, neighborhood, asked, radius, radii, STAGE, progress);

    Neighbors neighbors{gpu::Buffer(device, count * k * sizeof(float), "neighbor ids"),
                        gpu::Buffer(device, count * k * sizeof(float), "neighbor distances")};
    const std::uint64_t stride = ROW_STRIDE(std::uint64_t{k});
    const std::uint64_t part = std::min(count, std::max<std::uint64_t>(LIST_BYTES / (stride * PAIR_BYTES), 1));
    const gpu::Buffer found(device, part * stride * PAIR_BYTES, "neighbor lists");
    const gpu::Buffer found_counts(device, part * sizeof(std::uint32_t), "neighbor lists");
    const Lists lists{device, k, found, found_counts, ordered.result_rows, neighbors};
    for (const gpu::Binding& binding :
         {gpu::Binding{"radii", radii}, {"found_neighbors", found}, {"found_counts", found_counts}})
        list.bindings.push_back(binding);
    for (std::uint64_t first = 0; first < count; first += part) {
        const std::uint64_t rows = std::min(part, count - first);
        const shared::ListSettings push{make_gather_settings(neighborhood, k + 1), static_cast<std::uint32_t>(first), k,
                                        0, 0};
        run_gather(device, neighborhood, asked, list, std::as_bytes(std::span(&push, 1)), first, rows, STAGE, progress);
        lists.sort(first, rows, progress);
    }
    return neighbors;
}

} // namespace photonloupe
