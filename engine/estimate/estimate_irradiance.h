// SPDX-License-Identifier: Apache-2.0
// Irradiance from the k nearest photons on the same surface (METHODS §2).
#pragma once

#include <span>

#include "estimate/settings.h"
#include "photons/gather.h"

namespace photonloupe {

// Points on the device: xyz relative to the map's origin, with unit normals; a zero normal: no query. Those that follow
// each other should look at the same photons.
struct PointSet {
    const gpu::Buffer& points;
    const gpu::Buffer& normals;
    std::uint64_t count;
    // So many points in a row, as the samples of a pixel, may share the radius of the first: where they lie within a
    // quarter of it, on a surface that faces alike. 1: every point is estimated by itself.
    std::uint32_t group = 1;
};

// What estimates of any points from any map dispatch.
std::vector<gpu::KernelSource> list_estimate_kernels(const EstimateSettings& settings, bool has_one_normal);

// W/m² at each point from photons with the flux `power` (rgb, by id); w: what photons that each carry 1 W would give.
// Point i's goes to row result_rows[i].
gpu::Buffer estimate_irradiance(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                const PointSet& points, const gpu::Buffer& result_rows,
                                const EstimateSettings& settings, const Progress& progress = {});

// The same for points from the host, in any order.
gpu::Buffer estimate_irradiance_at(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                   std::span<const glm::vec4> points, std::span<const glm::vec4> normals,
                                   const EstimateSettings& settings, const Progress& progress = {});

} // namespace photonloupe
