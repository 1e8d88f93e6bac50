// SPDX-License-Identifier: Apache-2.0
// Drives the irradiance kernel.
#include "estimate/estimate_irradiance.h"

#include "gpu/commands.h"
#include "photons/find_neighbors.h"

namespace photonloupe {

gpu::Buffer estimate_irradiance(gpu::Device& device, const PhotonMap& photons, const KdTree& tree,
                                const gpu::Buffer& points, const gpu::Buffer& normals, std::uint64_t point_count,
                                const EstimateSettings& settings, const Progress& progress) {
    require_k(settings.k);
    gpu::Buffer irradiance(device, point_count * sizeof(glm::vec4), "irradiance");
    if (tree.count == 0) {
        gpu::Commands commands(device, "estimate irradiance");
        commands.fill(irradiance, 0);
        commands.run();
        return irradiance;
    }
    const gpu::KernelSource kernel{"estimate/estimate_irradiance.comp",
                                   0,
                                   {"KERNEL " + std::to_string(static_cast<std::uint32_t>(settings.kernel))},
                                   {size_list(settings.k + 1)}};
    gpu::run_in_chunks(device, "estimate irradiance", point_count, QUERIES_PER_GROUP * 16, progress,
                       [&](gpu::Commands& commands, std::uint64_t first, std::uint64_t count) {
                           const shared::NeighborQuery push{static_cast<std::uint32_t>(first),
                                                            static_cast<std::uint32_t>(count),
                                                            static_cast<std::uint32_t>(tree.count),
                                                            tree.leaf_level,
                                                            settings.k,
                                                            QUERIES_PER_GROUP,
                                                            0,
                                                            settings.flatness};
                           const std::uint64_t groups = (count + QUERIES_PER_GROUP - 1) / QUERIES_PER_GROUP;
                           commands.dispatch(kernel,
                                             {{"tree_nodes", tree.nodes},
                                              {"tree_positions", tree.positions},
                                              {"tree_normals", tree.normals},
                                              {"power_object", photons.power_object},
                                              {"query_points", points},
                                              {"query_normals", normals},
                                              {"irradiance", irradiance}},
                                             push, groups * device.limits().subgroup_size);
                       });
    return irradiance;
}

} // namespace photonloupe
