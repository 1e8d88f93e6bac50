// SPDX-License-Identifier: Apache-2.0
// Picks rows on the host and uploads them.
#include "photons/select_photons.h"

#include <limits>

#include <glm/vec4.hpp>

#include "core/error.h"
#include "photons/map_columns.h"

namespace photonloupe {
namespace {

gpu::Buffer select_packed(gpu::Device& device, const gpu::Buffer& column, std::uint64_t photon_count,
                          std::span<const std::uint32_t> ids, std::size_t width, const char* purpose) {
    return gpu::make_buffer(device, select_rows(column.read<glm::vec4>(photon_count * width), photon_count, ids),
                            purpose);
}

SharedFloats select_shared(const SharedFloats& column, std::uint64_t photon_count, std::span<const std::uint32_t> ids) {
    return column ? std::make_shared<const std::vector<float>>(select_rows(*column, photon_count, ids)) : nullptr;
}

bool are_all(std::uint64_t photon_count, std::span<const std::uint32_t> ids) {
    for (std::size_t i = 0; i < ids.size(); ++i)
        if (ids[i] != i)
            return false;
    return ids.size() == photon_count;
}

} // namespace

PathColumns select_paths(gpu::Device& device, const PathColumns& paths, std::uint64_t photon_count,
                         std::span<const std::uint32_t> ids, const std::array<double, 3>& shift) {
    if (are_all(photon_count, ids) && shift == std::array<double, 3>{})
        return share_paths(paths);
    const std::vector<std::uint32_t> starts = paths.starts.read<std::uint32_t>(photon_count + 1);
    const std::vector<glm::vec4> vertices = paths.vertices.read<glm::vec4>(paths.vertex_count);
    const std::vector<glm::vec4> normals = paths.normals.read<glm::vec4>(paths.vertex_count);
    std::vector<std::uint32_t> some_starts{0};
    std::vector<glm::vec4> some_vertices, some_normals;
    for (const std::uint32_t id : ids) {
        for (std::uint32_t i = starts[id]; i < starts[id + 1]; ++i) {
            some_vertices.push_back(vertices[i]);
            for (int axis = 0; axis < 3; ++axis)
                some_vertices.back()[axis] = static_cast<float>(vertices[i][axis] + shift[axis]);
            some_normals.push_back(normals[i]);
        }
        if (some_vertices.size() > std::numeric_limits<std::uint32_t>::max())
            throw Error("the paths of these photons have more than 2^32 - 1 vertices; take fewer");
        some_starts.push_back(static_cast<std::uint32_t>(some_vertices.size()));
    }
    PathColumns some{some_vertices.size(), {}, {}, {}, paths.has_normals, paths.has_interactions, paths.has_objects,
                     paths.has_scatter};
    some.starts = gpu::make_buffer(device, some_starts, "path starts");
    some.vertices = gpu::make_buffer(device, some_vertices, "path vertices");
    some.normals = gpu::make_buffer(device, some_normals, "path normals");
    return some;
}

PhotonMap select_photons(gpu::Device& device, const PhotonMap& map, std::span<const std::uint32_t> ids) {
    PhotonMap some;
    some.count = ids.size();
    some.origin = map.origin;
    some.position_emitter = select_packed(device, map.position_emitter, map.count, ids, 1, "photon positions");
    some.normal_index = select_packed(device, map.normal_index, map.count, ids, 1, "photon normals");
    some.power_object = select_packed(device, map.power_object, map.count, ids, 1, "photon powers");
    some.long_indices = select_rows(map.long_indices, map.count, ids);
    if (map.paths)
        some.paths = select_paths(device, *map.paths, map.count, ids);
    if (const auto& all = map.parameters)
        some.parameters = ParameterColumns{
            all->count, select_packed(device, all->values, map.count, ids, all->count_rows(), "parameters"),
            select_shared(all->given, map.count, ids), all->periods, all->axes};
    if (map.colors)
        some.colors = select_packed(device, *map.colors, map.count, ids, 1, "photon colors");
    some.given_colors = select_shared(map.given_colors, map.count, ids);
    return some;
}

} // namespace photonloupe
