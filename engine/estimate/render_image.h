// SPDX-License-Identifier: Apache-2.0
// The picture: eye paths through mirrors and glass, direct light with shadow rays, and the photon map's irradiance.
#pragma once

#include "estimate/camera_frame.h"
#include "estimate/estimate_irradiance.h"
#include "image/image.h"
#include "scene/scene_buffers.h"
#include "trace/trace_photons.h"

namespace photonloupe {

enum class RenderMode {
    composite,   // emission + direct + map; without direct when the map stores direct hits too
    caustic,     // the map alone
    direct,      // emission + direct
    photons,     // stored photons as points
    false_color, // the mean color of the photons around, times the luminance of their irradiance
    voronoi,     // the cells of the photons on the surfaces seen; one sample a pixel
};

struct RenderSettings {
    CameraChoice camera;
    std::uint32_t width = 512;
    std::uint32_t height = 512;
    std::uint32_t samples = 4; // per pixel
    RenderMode mode = RenderMode::composite;
    EstimateSettings estimate;
    std::uint32_t seed = 1;
    std::uint32_t max_bounces = 16;
};

// What the renderer needs of a traced map.
struct RenderedMap {
    const PhotonMap& photons;
    const KdTree& tree;
    Store store = Store::caustic;
};

// What a picture of that scene and a map stored so dispatches.
std::vector<gpu::KernelSource> list_render_kernels(const Scene& scene, Store store, const RenderSettings& settings);

// `map` may be null for the mode `direct`. Throws Error for an image size or sample count out of range.
Image render_image(gpu::Device& device, const Scene& scene, const SceneBuffers& buffers, const RenderedMap* map,
                   const RenderSettings& settings, const Progress& progress = {});

} // namespace photonloupe
