// SPDX-License-Identifier: Apache-2.0
// One photon's path on the host, and what is measured along it ([SJL15] eqs. 1, 2; METHODS §4).
#pragma once

#include <span>
#include <string>
#include <vector>

#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "photons/photon_map.h"

namespace photonloupe::inspect {

// From the emitter to the storage point, as PathColumns packs them.
struct PathView {
    std::span<const glm::vec4> vertices;
    std::span<const glm::vec4> normals;
};

// The paths of all photons, read at once.
struct HostPaths {
    std::vector<std::uint32_t> starts;
    std::vector<glm::vec4> vertices;
    std::vector<glm::vec4> normals;
    PathView view(std::size_t photon) const;
};

HostPaths read_paths(const PhotonMap& photons);
// Those of some photons: photon `ids[i]` is path i. The map must have paths.
HostPaths read_paths_of(const PhotonMap& photons, std::span<const std::uint32_t> ids);

// 1 reflected, 2 transmitted, 3 scattered by a medium, 0 at the ends.
std::uint32_t read_interaction(const glm::vec4& vertex);
// From vertex i to the next.
glm::dvec3 find_segment(const PathView& path, std::size_t i);

// Below, what a path is too short for, or a segment without length leaves undefined, is NaN.
double measure_length(const PathView& path);
double measure_tortuosity(const PathView& path);   // [SJL15] eq. 1
double encode_signature(const PathView& path);     // [SJL15] eq. 2: least digit first
std::string spell_signature(const PathView& path); // the same as letters, R, T and V, first interaction first
glm::dvec3 find_arrival(const PathView& path);     // unit vector along the last segment
// Azimuth about y of the normal at the first specular vertex, [SJL15] figure 9 f: 0 towards -z, π/2 towards x.
double measure_normal_angle(const PathView& path);

// Ids of the photons that went through just these interactions between emitter and storage point.
std::vector<std::uint32_t> find_signature(const PhotonMap& photons, std::span<const std::uint8_t> interactions);

} // namespace photonloupe::inspect
