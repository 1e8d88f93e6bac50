// SPDX-License-Identifier: Apache-2.0
// Stretches of eye paths inside of media, and what the photons there send along them (METHODS §13).
#pragma once

#include "estimate/media_photons.h"
#include "gpu/kernel_source.h"
#include "scene/scene_buffers.h"
#include "shared/render.h"

namespace photonloupe {

// Stretches of one sample: two for each glass that a fog is seen through, and as many for what is seen in it.
constexpr std::uint32_t BEAMS_PER_SAMPLE = 8;

// By stretch, then sample.
struct EyeBeams {
    std::uint64_t count = 0;
    gpu::Buffer origin, direction, weight; // as estimate/trace_eye.comp writes them
    gpu::Buffer radiance;
    gpu::Buffer cursor;
};

EyeBeams allocate_beams(gpu::Device& device, std::uint64_t count);

// What photons in media scatter, and how far each reaches: to its k-th neighbor.
struct MediaLight {
    MediaPhotons photons;
    gpu::Buffer light;   // tree order: rgb scattered flux in W, w bits: object
    gpu::Buffer radii;   // tree order, metres
    gpu::Buffer reaches; // by heap index: the largest radius below
};

MediaLight prepare_media_light(gpu::Device& device, const Scene& scene, const PhotonMap& map, std::uint32_t k,
                               const Progress& progress = {});

gpu::KernelSource name_beam_kernel(const Scene& scene);

// Fills the radiances of the first `count` stretches.
void gather_beams(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers, const MediaLight& light,
                  const EyeBeams& beams, std::uint64_t count, const Progress& progress = {});

} // namespace photonloupe
