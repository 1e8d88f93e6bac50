// SPDX-License-Identifier: Apache-2.0
// Irradiance from the k nearest photons on the same surface (METHODS §2).
#pragma once

#include <span>

#include "photons/gather.h"

namespace photonloupe {

enum class DensityKernel : std::uint32_t {
    epanechnikov = shared::KERNEL_EPANECHNIKOV,
    disc = shared::KERNEL_DISC,
    cone = shared::KERNEL_CONE,
    gaussian = shared::KERNEL_GAUSSIAN,
};

struct EstimateSettings {
    std::uint32_t k = 50;
    DensityKernel kernel = DensityKernel::epanechnikov;
    float flatness = SURFACE_FLATNESS; // 0: no test
};

// W/m² at each point (xyz relative to the map's origin, with unit normals; a zero normal: 0) from photons with the
// flux `power` (rgb, by id); w: what photons that each carry 1 W would give. Point i's goes to row result_rows[i];
// those that follow each other should look at the same photons.
gpu::Buffer estimate_irradiance(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                const gpu::Buffer& points, const gpu::Buffer& normals, const gpu::Buffer& result_rows,
                                std::uint64_t count, const EstimateSettings& settings, const Progress& progress = {});

// The same for points from the host, in any order.
gpu::Buffer estimate_irradiance_at(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                   std::span<const glm::vec4> points, std::span<const glm::vec4> normals,
                                   const EstimateSettings& settings, const Progress& progress = {});

} // namespace photonloupe
