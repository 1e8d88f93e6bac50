// SPDX-License-Identifier: Apache-2.0
// Drives the diffusion kernel and restores the total.
#include "relax/flux_diffusion.h"

#include <array>
#include <cmath>

namespace photonloupe {
namespace {

std::array<double, 3> sum_power(const std::vector<glm::vec4>& power) {
    std::array<double, 3> total{};
    for (const glm::vec4& flux : power)
        for (std::size_t channel = 0; channel < 3; ++channel)
            total[channel] += flux[channel];
    return total;
}

} // namespace

double diffuse_flux(gpu::Device& device, const KdTree& tree, const GatherShape& shape, const Layers& layers,
                    const gpu::Buffer& radii, gpu::Buffer& power, const Progress& progress) {
    const gpu::Buffer diffused(device, tree.count * sizeof(glm::vec4), "diffused fluxes");
    run_gather(
        device, tree, "relax/diffuse_flux.comp", list_gather_defines(shape, 1), make_gather_settings(tree, shape, 1),
        "diffuse flux",
        [&](gpu::Commands& commands, const gpu::KernelSource& kernel, const shared::GatherSettings& push,
            const GatherBuffers& buffers, std::uint64_t invocations) {
            commands.dispatch(kernel,
                              {{"tree_nodes", tree.nodes},
                               {"tree_positions", tree.positions},
                               {"tree_normals", tree.normals},
                               {"tree_parameters", layers.parameters.is_empty() ? tree.positions : layers.parameters},
                               {"tree_ranges", layers.ranges ? *layers.ranges : tree.positions},
                               {"parameter_reach", layers.reach2.is_empty() ? radii : layers.reach2},
                               {"parameter_periods", layers.periods.is_empty() ? radii : layers.periods},
                               {"tree_power", power},
                               {"radii", radii},
                               {"diffused_power", diffused},
                               {"singles", buffers.singles},
                               {"unanswered", buffers.unanswered}},
                              push, invocations);
        },
        progress);
    const std::array<double, 3> before = sum_power(power.read<glm::vec4>(tree.count));
    std::vector<glm::vec4> fluxes = diffused.read<glm::vec4>(tree.count);
    const std::array<double, 3> after = sum_power(fluxes);
    double drift = 0;
    std::array<double, 3> scale{1, 1, 1};
    for (std::size_t channel = 0; channel < 3; ++channel)
        if (after[channel] > 0) {
            scale[channel] = before[channel] / after[channel];
            drift = std::max(drift, std::abs(after[channel] / before[channel] - 1.0));
        }
    for (glm::vec4& flux : fluxes)
        for (std::size_t channel = 0; channel < 3; ++channel)
            flux[channel] = static_cast<float>(flux[channel] * scale[channel]);
    power.upload(fluxes.data(), fluxes.size() * sizeof(glm::vec4));
    return drift;
}

} // namespace photonloupe
