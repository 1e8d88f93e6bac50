// SPDX-License-Identifier: Apache-2.0
// Drives the photon plot and turns its fixed-point sums into an image.
#include "estimate/plot_photons.h"

#include <algorithm>

#include "gpu/commands.h"

namespace photonloupe {
namespace {

// Summed in double and in photon order: the same on every run.
double find_mean_flux(const PhotonMap& photons) {
    double sum = 0;
    for (const glm::vec4& power : photons.power_object.read<glm::vec4>(photons.count))
        sum += std::max({power.r, power.g, power.b});
    return sum / static_cast<double>(std::max<std::uint64_t>(photons.count, 1));
}

} // namespace

gpu::KernelSource name_plot_kernel(const Scene& scene) {
    return {"estimate/plot_photons.comp", 64, list_passing_defines(scene), {}};
}

Image plot_photons(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers, const PhotonMap& photons,
                   const shared::CameraFrame& camera, std::uint32_t width, std::uint32_t height,
                   const Progress& progress) {
    const std::uint64_t values = std::uint64_t{width} * height * 3;
    gpu::Buffer plot(device, values * sizeof(std::uint32_t), "photon plot");
    gpu::fill(device, "plot photons", plot, 0);
    const double mean = find_mean_flux(photons);
    shared::PlotSettings push{camera, 0, 0, width, height, mean > 0 ? static_cast<float>(1 / mean) : 0.0f};
    gpu::dispatch_in_chunks(
        device, "plot photons", name_plot_kernel(scene),
        buffers.bind(
            {{"position_emitter", photons.position_emitter}, {"power_object", photons.power_object}, {"plot", plot}}),
        push, photons.count, 4096, progress);
    Image image{width, height, {}, {}};
    for (std::uint32_t value : plot.read<std::uint32_t>(values))
        image.rgb.push_back(static_cast<float>(value) / shared::PLOT_UNIT);
    return image;
}

} // namespace photonloupe
