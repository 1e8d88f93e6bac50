// SPDX-License-Identifier: Apache-2.0
// Between the device's packed columns and the plain arrays that users see.
#pragma once

#include <span>

#include <glm/vec4.hpp>

#include "photons/photon_map.h"

namespace photonloupe {

// Plain columns of a map made elsewhere: 3 floats a position, normal, power; checked by the caller for lengths,
// finiteness and ranges.
struct MapColumns {
    std::span<const float> positions; // world, metres
    std::span<const float> normals;
    std::span<const float> power;
    std::span<const std::int32_t> emitter;
    std::span<const std::uint64_t> emitted_index;
    std::span<const std::int32_t> object; // -1: none
};

// Plain columns of paths; those that are empty but starts and vertices are filled with nothing (0, object -1).
struct PathArrays {
    std::span<const std::int64_t> offsets;
    std::span<const float> vertices; // world, metres
    std::span<const float> normals;
    std::span<const std::uint8_t> interactions;
    std::span<const std::int32_t> objects; // -1: none
    std::span<const float> scatter;
};

// Packs the columns and uploads them. The map is kept relative to its own center when that lies far away.
PhotonMap make_map(gpu::Device& device, const MapColumns& columns);

// The paths of that map's photons. Throws Error when they have more vertices than 32 bits count.
PathColumns make_paths(gpu::Device& device, const PathArrays& arrays, const std::array<double, 3>& origin);

// Gives a map false colors, 3 floats a photon; photons of NaN, or without one of their parameters, are shown in
// UNSET_GREY with w 0.
constexpr float UNSET_GREY = 0.5f;
void set_colors(gpu::Device& device, PhotonMap& map, std::vector<float> values);

// A map of the same columns in the same memory.
PhotonMap share_map(const PhotonMap& map);
PathColumns share_paths(const PathColumns& paths);

// The first three of each four floats.
std::vector<float> read_vectors(const gpu::Buffer& buffer, std::uint64_t count);

// World positions: 3 floats a photon.
std::vector<float> read_positions(const PhotonMap& photons);
std::vector<std::int32_t> read_emitters(const PhotonMap& photons);
std::vector<std::uint64_t> read_emitted_indices(const PhotonMap& photons);
std::vector<std::int32_t> read_objects(const PhotonMap& photons); // -1: none

std::vector<std::int64_t> read_path_offsets(const PathColumns& paths, std::uint64_t photon_count);
std::vector<float> read_path_vertices(const PathColumns& paths, const std::array<double, 3>& origin);
std::vector<std::uint8_t> read_path_interactions(const PathColumns& paths);
std::vector<std::int32_t> read_path_objects(const PathColumns& paths); // -1: none
std::vector<float> read_path_scatter(const PathColumns& paths);

// Points given in world coordinates (3 doubles each) relative to the map's origin; w 0.
std::vector<glm::vec4> localize_points(const PhotonMap& photons, std::span<const double> points);

} // namespace photonloupe
