// SPDX-License-Identifier: Apache-2.0
// Finds the radius of every point, then sums the flux within.
#include "estimate/estimate_irradiance.h"

#include "photons/neighbor_queries.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "estimate irradiance";

} // namespace

gpu::Buffer estimate_irradiance(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                const gpu::Buffer& points, const gpu::Buffer& normals, const gpu::Buffer& result_rows,
                                std::uint64_t count, const EstimateSettings& settings, const Progress& progress) {
    require_k(settings.k);
    gpu::Buffer irradiance(device, count * sizeof(glm::vec4), "irradiance");
    if (tree.count == 0) {
        gpu::Commands commands(device, STAGE);
        commands.fill(irradiance, 0);
        commands.run();
        return irradiance;
    }
    Neighborhood neighborhood{tree, Measure::surface};
    neighborhood.flatness = settings.flatness;
    const Queries queries{count, &points, &normals};
    const gpu::Buffer radii(device, count * RADIUS_BYTES, "radii of estimates");
    // The photon behind the k-th gives the radius; of the disc the k-th itself.
    const bool is_disc = settings.kernel == DensityKernel::disc;
    RadiusSettings radius{is_disc ? settings.k : settings.k + 1};
    radius.cuts_ties = true;
    radius.includes_last = is_disc;
    find_radii(device, neighborhood, queries, radius, radii, STAGE, progress);
    const GatherKernel kernel{
        "estimate/estimate_irradiance.comp",
        {"CUT_TIES", "BY_ID", "KERNEL " + std::to_string(static_cast<std::uint32_t>(settings.kernel))},
        {{"radii", radii}, {"power_object", power}, {"result_rows", result_rows}, {"irradiance", irradiance}}};
    gather(device, neighborhood, queries, kernel, make_gather_settings(neighborhood, radius.rank), STAGE, progress);
    return irradiance;
}

gpu::Buffer estimate_irradiance_at(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                   std::span<const glm::vec4> points, std::span<const glm::vec4> normals,
                                   const EstimateSettings& settings, const Progress& progress) {
    const std::vector<std::uint32_t> order = order_points(points);
    const auto upload = [&](std::span<const glm::vec4> values) {
        std::vector<glm::vec4> ordered(order.size());
        std::transform(order.begin(), order.end(), ordered.begin(), [&](std::uint32_t i) { return values[i]; });
        return gpu::make_buffer(device, ordered, "points");
    };
    return estimate_irradiance(device, power, tree, upload(points), upload(normals),
                               gpu::make_buffer(device, order, "points"), order.size(), settings, progress);
}

} // namespace photonloupe
