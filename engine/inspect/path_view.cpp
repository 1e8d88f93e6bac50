// SPDX-License-Identifier: Apache-2.0
// Reads paths back and measures them in double precision.
#include "inspect/path_view.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>

#include <glm/geometric.hpp>

#include "shared/trace.h"

namespace photonloupe::inspect {
namespace {

constexpr double UNDEFINED = std::numeric_limits<double>::quiet_NaN();
// Scatter of a vertex that light left in no particular direction.
constexpr float DIFFUSE = 1.0f;

} // namespace

PathView HostPaths::view(std::size_t photon) const {
    const std::size_t first = starts[photon], count = starts[photon + 1] - first;
    return {std::span(vertices).subspan(first, count), std::span(normals).subspan(first, count)};
}

HostPaths read_paths(const PhotonMap& photons) {
    const PathColumns& paths = *photons.paths;
    return {paths.starts.read<std::uint32_t>(photons.count + 1), paths.vertices.read<glm::vec4>(paths.vertex_count),
            paths.normals.read<glm::vec4>(paths.vertex_count)};
}

HostPaths read_paths_of(const PhotonMap& photons, std::span<const std::uint32_t> ids) {
    const PathColumns& paths = *photons.paths;
    HostPaths some{{0}, {}, {}};
    for (const std::uint32_t id : ids) {
        const std::vector<std::uint32_t> ends = paths.starts.read<std::uint32_t>(2, id);
        const std::vector<glm::vec4> vertices = paths.vertices.read<glm::vec4>(ends[1] - ends[0], ends[0]);
        const std::vector<glm::vec4> normals = paths.normals.read<glm::vec4>(ends[1] - ends[0], ends[0]);
        some.vertices.insert(some.vertices.end(), vertices.begin(), vertices.end());
        some.normals.insert(some.normals.end(), normals.begin(), normals.end());
        some.starts.push_back(static_cast<std::uint32_t>(some.vertices.size()));
    }
    return some;
}

std::uint32_t read_interaction(const glm::vec4& vertex) {
    return std::bit_cast<std::uint32_t>(vertex.w) >> 24;
}

glm::dvec3 find_segment(const PathView& path, std::size_t i) {
    return glm::dvec3(path.vertices[i + 1]) - glm::dvec3(path.vertices[i]);
}

double measure_length(const PathView& path) {
    if (path.vertices.size() < 2)
        return UNDEFINED;
    double length = 0;
    for (std::size_t i = 0; i + 1 < path.vertices.size(); ++i)
        length += glm::length(find_segment(path, i));
    return length;
}

double measure_tortuosity(const PathView& path) {
    const std::size_t count = path.vertices.size();
    if (count < 3)
        return UNDEFINED;
    double bent = 0;
    for (std::size_t i = 0; i + 2 < count; ++i) {
        const glm::dvec3 before = find_segment(path, i), after = find_segment(path, i + 1);
        // Without length: 0 / 0, a NaN that clamping leaves.
        const double cosine = glm::dot(before, after) / (glm::length(before) * glm::length(after));
        bent += std::acos(std::clamp(cosine, -1.0, 1.0));
    }
    return bent / (std::numbers::pi * static_cast<double>(count - 2));
}

double encode_signature(const PathView& path) {
    if (path.vertices.size() < 2)
        return UNDEFINED;
    double signature = 0, place = 1;
    for (std::size_t i = 1; i + 1 < path.vertices.size(); ++i, place *= 3) {
        const std::uint32_t interaction = read_interaction(path.vertices[i]);
        if (interaction == 0) // a map from arrays may not say
            return UNDEFINED;
        if (interaction != shared::INTERACTION_SCATTERED) // its digit is 0
            signature += place * interaction;
    }
    return signature;
}

std::string spell_signature(const PathView& path) {
    std::string letters;
    for (std::size_t i = 1; i + 1 < path.vertices.size(); ++i)
        letters += "?RTV?"[std::min(read_interaction(path.vertices[i]), 4u)];
    return letters;
}

glm::dvec3 find_arrival(const PathView& path) {
    const std::size_t count = path.vertices.size();
    if (count < 2)
        return glm::dvec3(UNDEFINED);
    const glm::dvec3 last = find_segment(path, count - 2);
    return last / glm::length(last);
}

double measure_normal_angle(const PathView& path) {
    for (std::size_t i = 1; i + 1 < path.vertices.size(); ++i) {
        const glm::dvec3 normal(path.normals[i]);
        if (path.normals[i].w >= DIFFUSE)
            continue;
        return normal.x == 0 && normal.z == 0 ? UNDEFINED : std::atan2(normal.x, -normal.z);
    }
    return UNDEFINED;
}

std::vector<std::uint32_t> find_signature(const PhotonMap& photons, std::span<const std::uint8_t> interactions) {
    const HostPaths paths = read_paths(photons);
    std::vector<std::uint32_t> ids;
    for (std::uint32_t id = 0; id < photons.count; ++id) {
        const std::span<const glm::vec4> vertices = paths.view(id).vertices;
        if (vertices.size() == interactions.size() + 2 &&
            std::equal(interactions.begin(), interactions.end(), vertices.begin() + 1,
                       [](std::uint8_t wanted, const glm::vec4& vertex) { return wanted == read_interaction(vertex); }))
            ids.push_back(id);
    }
    return ids;
}

} // namespace photonloupe::inspect
