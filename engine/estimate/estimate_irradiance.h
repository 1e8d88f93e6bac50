// SPDX-License-Identifier: Apache-2.0
// Irradiance from the k nearest photons on the same surface (METHODS §2).
#pragma once

#include <span>

#include "photons/kd_tree.h"
#include "photons/same_surface.h"

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
// flux `power` (rgb, by id); w: what photons that each carry 1 W would give.
// `order` lists all points in the order to visit them (see photons/query_tree.h).
gpu::Buffer estimate_irradiance(gpu::Device& device, const gpu::Buffer& power, const KdTree& tree,
                                const gpu::Buffer& points, const gpu::Buffer& normals,
                                std::span<const std::uint32_t> order, const EstimateSettings& settings,
                                const Progress& progress = {});

} // namespace photonloupe
