// SPDX-License-Identifier: Apache-2.0
// Finds the radius of every point, then sums the flux within.
#include "estimate/estimate_irradiance.h"

#include "photons/neighbor_queries.h"

namespace photonloupe {
namespace {

constexpr const char* STAGE = "estimate irradiance";

Neighborhood look_at_surfaces(const KdTree& tree, bool has_one_normal) {
    Neighborhood neighborhood{tree, Measure::surface};
    neighborhood.has_one_normal = has_one_normal;
    return neighborhood;
}

// The photon behind the k-th gives the radius; of the disc the k-th itself.
RadiusSettings choose_radius(const EstimateSettings& settings) {
    const bool is_disc = settings.kernel == DensityKernel::disc;
    RadiusSettings radius{choose_k(settings) + (is_disc ? 0 : 1)};
    radius.cuts_ties = true;
    radius.includes_last = is_disc;
    return radius;
}

GatherKernel name_estimate(const EstimateSettings& settings) {
    return {"estimate/estimate_irradiance.comp",
            {"CUT_TIES", "BY_ID", "KERNEL " + std::to_string(static_cast<std::uint32_t>(settings.kernel))},
            {}};
}

// What both ways of asking share.
struct Estimate {
    gpu::Device& device;
    const gpu::Buffer& power;
    const KdTree& tree;
    const EstimateSettings& settings;
    const gpu::Buffer& irradiance;
    const Progress& progress;
    Neighborhood neighborhood = look_at_surfaces(tree, find_one_normal(tree));

    GatherKernel bind_kernel(const gpu::Buffer& radii, const gpu::Buffer& result_rows) const {
        GatherKernel kernel = name_estimate(settings);
        for (const gpu::Binding& binding : {gpu::Binding{"radii", radii},
                                            {"power_object", power},
                                            {"result_rows", result_rows},
                                            {"irradiance", irradiance}})
            kernel.bindings.push_back(binding);
        return kernel;
    }

    // Every point by itself.
    void run(const PointSet& points, const gpu::Buffer& result_rows) const {
        const Queries queries{points.count, &points.points, &points.normals};
        const gpu::Buffer radii(device, points.count * RADIUS_BYTES, "radii of estimates");
        const RadiusSettings radius = choose_radius(settings);
        find_radii(device, neighborhood, queries, radius, radii, STAGE, progress);
        gather(device, neighborhood, queries, bind_kernel(radii, result_rows),
               make_gather_settings(neighborhood, radius.rank), STAGE, progress);
    }

    // Points that stand together share a radius where they may; returns those that may not.
    std::vector<std::uint32_t> run_shared(const PointSet& points, const gpu::Buffer& result_rows) const {
        const std::uint64_t leaders = points.count / points.group;
        const gpu::Buffer radii(device, leaders * RADIUS_BYTES, "radii of estimates");
        RadiusSettings radius = choose_radius(settings);
        radius.stride = points.group;
        find_radii(device, neighborhood, {leaders, &points.points, &points.normals}, radius, radii, STAGE, progress);
        shared::GatherSettings push = make_gather_settings(neighborhood, radius.rank);
        push.stride = points.group;
        return gather_once(device, neighborhood, {points.count, &points.points, &points.normals},
                           bind_kernel(radii, result_rows), std::as_bytes(std::span(&push, 1)), STAGE, progress);
    }
};

gpu::Buffer take_rows(gpu::Device& device, const gpu::Buffer& buffer, std::uint64_t count,
                      std::span<const std::uint32_t> rows) {
    const std::vector<glm::vec4> all = buffer.read<glm::vec4>(count);
    std::vector<glm::vec4> taken;
    for (const std::uint32_t row : rows)
        taken.push_back(all[row]);
    return gpu::make_buffer(device, taken, "points");
}

} // namespace

std::vector<gpu::KernelSource> list_estimate_kernels(const EstimateSettings& settings, bool has_one_normal) {
    const KdTree tree;
    const gpu::Buffer points;
    const Neighborhood neighborhood = look_at_surfaces(tree, has_one_normal);
    const Queries queries{0, &points, &points};
    return {name_radius_kernel(neighborhood, queries, choose_radius(settings)),
            name_gather_kernel(neighborhood, queries, name_estimate(settings))};
}

gpu::Buffer estimate_irradiance(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                const PointSet& points, const gpu::Buffer& result_rows,
                                const EstimateSettings& settings, const Progress& progress) {
    require_k(choose_k(settings));
    gpu::Buffer irradiance(device, points.count * sizeof(glm::vec4), "irradiance");
    if (tree.count == 0) {
        gpu::fill(device, STAGE, irradiance, 0);
        return irradiance;
    }
    const Estimate estimate{device, power, tree, settings, irradiance, progress};
    device.compile_ahead(list_estimate_kernels(settings, estimate.neighborhood.has_one_normal));
    if (points.group == 1) {
        estimate.run(points, result_rows);
        return irradiance;
    }
    const std::vector<std::uint32_t> left = estimate.run_shared(points, result_rows);
    if (left.empty())
        return irradiance;
    const gpu::Buffer places = take_rows(device, points.points, points.count, left);
    const gpu::Buffer normals = take_rows(device, points.normals, points.count, left);
    const std::vector<std::uint32_t> rows = result_rows.read<std::uint32_t>(points.count);
    std::vector<std::uint32_t> left_rows;
    for (const std::uint32_t point : left)
        left_rows.push_back(rows[point]);
    estimate.run({places, normals, left.size()}, gpu::make_buffer(device, left_rows, "points"));
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
    const gpu::Buffer places = upload(points), directions = upload(normals);
    return estimate_irradiance(device, power, tree, {places, directions, order.size()},
                               gpu::make_buffer(device, order, "points"), settings, progress);
}

} // namespace photonloupe
