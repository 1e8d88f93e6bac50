// SPDX-License-Identifier: Apache-2.0
// The picture: eye paths through mirrors and glass, direct light with shadow rays, and the photon map's irradiance.
#pragma once

#include "estimate/camera_frame.h"
#include "estimate/estimate_irradiance.h"
#include "image/image.h"
#include "scene/scene_buffers.h"
#include "trace/trace_photons.h"

namespace photonloupe {

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
                   const CameraChoice& looks, const RenderSettings& settings, const Progress& progress = {});

} // namespace photonloupe
