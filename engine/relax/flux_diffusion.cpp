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

double diffuse_flux(gpu::Device& device, const Neighborhood& neighborhood, const Queries& queries,
                    const gpu::Buffer& radii, gpu::Buffer& power, const Progress& progress) {
    const gpu::Buffer diffused(device, queries.count * sizeof(glm::vec4), "diffused fluxes");
    const GatherKernel kernel{
        "relax/diffuse_flux.comp", {}, {{"tree_power", power}, {"radii", radii}, {"diffused_power", diffused}}};
    gather(device, neighborhood, queries, kernel, make_gather_settings(neighborhood, 1), "diffuse flux", progress);
    const std::array<double, 3> before = sum_power(power.read<glm::vec4>(queries.count));
    std::vector<glm::vec4> fluxes = diffused.read<glm::vec4>(queries.count);
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
