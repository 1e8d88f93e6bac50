// SPDX-License-Identifier: Apache-2.0
// The photons of a map that were stored inside of media: their tree, and the fluence they tell of (METHODS §13).
#pragma once

#include <span>

#include "estimate/settings.h"
#include "photons/kd_tree.h"
#include "scene/scene.h"

namespace photonloupe {

// Those alone; their ids are not the map's.
struct MediaPhotons {
    PhotonMap map;
    KdTree tree;
};

// In the order of their ids in the map.
std::vector<std::uint32_t> list_media_photons(const PhotonMap& map);

MediaPhotons take_media_photons(gpu::Device& device, const PhotonMap& map, const Progress& progress = {});

// Extinction of the medium inside of an object, 1/m; 0 where there is none.
glm::vec3 find_extinction(const Scene& scene, std::uint32_t object);
// The share of it that is scattered, 0 where there is none.
glm::vec3 find_albedo(const Scene& scene, std::uint32_t object);

// Fluence in W/m² at points relative to the map's origin, from the k nearest photons in space.
gpu::Buffer estimate_fluence_at(gpu::Device& device, const Scene& scene, const MediaPhotons& photons,
                                std::span<const glm::vec4> points, std::uint32_t k, const Progress& progress = {});

} // namespace photonloupe
