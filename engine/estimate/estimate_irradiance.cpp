// SPDX-License-Identifier: Apache-2.0
// Drives the irradiance kernel.
#include "estimate/estimate_irradiance.h"

#include "photons/query_tree.h"

namespace photonloupe {

gpu::Buffer estimate_irradiance(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                const gpu::Buffer& points, const gpu::Buffer& normals,
                                std::span<const std::uint32_t> order, const EstimateSettings& settings,
                                const Progress& progress) {
    require_k(settings.k);
    gpu::Buffer irradiance(device, order.size() * sizeof(glm::vec4), "irradiance");
    if (tree.count == 0) {
        gpu::Commands commands(device, "estimate irradiance");
        commands.fill(irradiance, 0);
        commands.run();
        return irradiance;
    }
    const QueryKernels kernels{"estimate/estimate_irradiance.comp",
                               "estimate/select_irradiance.comp",
                               {"KERNEL " + std::to_string(static_cast<std::uint32_t>(settings.kernel))},
                               settings.k + 1};
    shared::NeighborQuery push{};
    push.k = settings.k;
    push.flatness = settings.flatness;
    const std::vector<std::uint32_t> left = run_queries(
        device, tree, kernels, order, push, "estimate irradiance",
        [&](gpu::Commands& commands, const gpu::KernelSource& kernel, const QueryBuffers& buffers,
            const shared::NeighborQuery& query, std::uint64_t invocations) {
            commands.dispatch(kernel,
                              {{"tree_nodes", tree.nodes},
                               {"tree_positions", tree.positions},
                               {"candidates", buffers.candidates},
                               {"ranked", buffers.ranked},
                               {"unanswered", buffers.unanswered},
                               {"tree_normals", tree.normals},
                               {"power_object", power},
                               {"query_points", points},
                               {"query_normals", normals},
                               {"query_order", buffers.order},
                               {"irradiance", irradiance}},
                              query, invocations);
        },
        progress);
    require_answers(left, "estimate irradiance");
    return irradiance;
}

} // namespace photonloupe
