// SPDX-License-Identifier: Apache-2.0
// Builds neighbour queries in parameter space and in layers from what a user names: photons, points, a center, ranges.
#pragma once

#include "photons/find_neighbors.h"

namespace photonloupe {

// Photons by id; points are their widest parameters.
NeighborQueries ask_parameters_of(const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::span<const std::uint32_t> ids);

// Points of parameter space, `count` values each, of any emitter.
NeighborQueries ask_parameters_at(const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::span<const double> values);

// Squared r_q of some photons, in their order: the distance to the k-th neighbour in parameter space.
std::vector<float> find_radii2_of(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::span<const std::uint32_t> ids, std::uint32_t k, const Progress& progress = {});

// Photons by id, each in its own layer; squared r_q in the same order.
NeighborQueries ask_layers_of(const PhotonMap& photons, std::span<const std::uint32_t> ids,
                              std::span<const float> radii2, float beta);

// Points (as find_neighbors takes them) in the layer of one photon.
NeighborQueries ask_layer_at(const PhotonMap& photons, std::span<const glm::vec4> points, std::uint32_t center,
                             float radius2, float beta);

// Points among the photons whose parameters lie within ranges.
NeighborQueries ask_ranges_at(std::span<const glm::vec4> points, std::span<const float> low,
                              std::span<const float> high);

} // namespace photonloupe
