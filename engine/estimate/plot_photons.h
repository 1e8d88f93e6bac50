// SPDX-License-Identifier: Apache-2.0
// Stored photons as points in the image.
#pragma once

#include "estimate/render_image.h"
#include "shared/render.h"

namespace photonloupe {

gpu::KernelSource name_plot_kernel(const Scene& scene);

// Each visible photon adds its flux, in units of the mean photon's largest channel, to its pixel.
Image plot_photons(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers, const PhotonMap& photons,
                   const shared::CameraFrame& camera, std::uint32_t width, std::uint32_t height,
                   const Progress& progress);

} // namespace photonloupe
