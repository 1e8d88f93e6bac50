// SPDX-License-Identifier: Apache-2.0
// Packs and unpacks the map's columns.
#include "photons/map_columns.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include <glm/vec4.hpp>

#include "core/error.h"
#include "shared/trace.h"

namespace photonloupe {
namespace {

// As for scenes: a map whose center is farther away than this many of its own radii is kept relative to the center.
constexpr double FAR_RADII = 8.0;

// Along axes that are far themselves, so that each coordinate comes back as it was.
std::array<double, 3> choose_origin(std::span<const float> positions) {
    std::array<double, 3> center{}, origin{};
    double radius2 = 0, distance2 = 0;
    for (std::size_t axis = 0; axis < 3 && !positions.empty(); ++axis) {
        float lo = positions[axis], hi = positions[axis];
        for (std::size_t i = axis; i < positions.size(); i += 3) {
            lo = std::min(lo, positions[i]);
            hi = std::max(hi, positions[i]);
        }
        center[axis] = 0.5 * (static_cast<double>(lo) + hi);
        if (std::abs(center[axis]) > FAR_RADII * 0.5 * (static_cast<double>(hi) - lo))
            origin[axis] = center[axis];
        radius2 += 0.25 * (static_cast<double>(hi) - lo) * (static_cast<double>(hi) - lo);
        distance2 += center[axis] * center[axis];
    }
    return distance2 > FAR_RADII * FAR_RADII * radius2 ? origin : std::array<double, 3>{};
}

std::int32_t name_object(std::uint32_t bits) {
    return bits == shared::NO_OBJECT ? -1 : static_cast<std::int32_t>(bits);
}

// Applies `read` to each packed element of a column.
template <class T, class Read>
std::vector<T> unpack(const gpu::Buffer& buffer, std::uint64_t count, const Read& read) {
    std::vector<T> values;
    values.reserve(count);
    for (const glm::vec4& packed : buffer.read<glm::vec4>(count))
        values.push_back(read(packed));
    return values;
}

std::vector<float> unpack_positions(const gpu::Buffer& buffer, std::uint64_t count,
                                    const std::array<double, 3>& origin) {
    std::vector<float> values;
    values.reserve(count * 3);
    for (const glm::vec4& packed : buffer.read<glm::vec4>(count))
        for (int axis = 0; axis < 3; ++axis)
            values.push_back(static_cast<float>(packed[axis] + origin[axis]));
    return values;
}

} // namespace

PhotonMap make_map(gpu::Device& device, const MapColumns& columns) {
    PhotonMap map;
    map.count = columns.emitter.size();
    map.origin = choose_origin(columns.positions);
    std::vector<glm::vec4> position(map.count), normal(map.count), power(map.count);
    bool is_long = false;
    for (std::size_t i = 0; i < map.count; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            position[i][axis] = static_cast<float>(columns.positions[3 * i + axis] - map.origin[axis]);
            normal[i][axis] = columns.normals[3 * i + axis];
            power[i][axis] = columns.power[3 * i + axis];
        }
        position[i].w = std::bit_cast<float>(columns.emitter[i]);
        normal[i].w = std::bit_cast<float>(static_cast<std::uint32_t>(columns.emitted_index[i]));
        is_long |= columns.emitted_index[i] > std::numeric_limits<std::uint32_t>::max();
        const bool has_object = columns.object[i] >= 0;
        power[i].w =
            std::bit_cast<float>(has_object ? static_cast<std::uint32_t>(columns.object[i]) : shared::NO_OBJECT);
    }
    if (is_long)
        map.long_indices.assign(columns.emitted_index.begin(), columns.emitted_index.end());
    map.position_emitter = gpu::make_buffer(device, position, "photon positions");
    map.normal_index = gpu::make_buffer(device, normal, "photon normals");
    map.power_object = gpu::make_buffer(device, power, "photon powers");
    return map;
}

PathColumns make_paths(gpu::Device& device, const PathArrays& arrays, const std::array<double, 3>& origin) {
    PathColumns paths;
    paths.vertex_count = arrays.vertices.size() / 3;
    if (paths.vertex_count > std::numeric_limits<std::uint32_t>::max())
        throw Error("the paths have " + std::to_string(paths.vertex_count) + " vertices; at most 2^32 - 1 fit");
    const std::vector<std::uint32_t> starts(arrays.offsets.begin(), arrays.offsets.end());
    std::vector<glm::vec4> vertices(paths.vertex_count), normals(paths.vertex_count, glm::vec4(0.0f));
    for (std::size_t i = 0; i < vertices.size(); ++i) {
        for (int axis = 0; axis < 3; ++axis)
            vertices[i][axis] = static_cast<float>(arrays.vertices[3 * i + axis] - origin[axis]);
        const std::uint32_t interaction = arrays.interactions.empty() ? 0u : arrays.interactions[i];
        const bool has_object = !arrays.objects.empty() && arrays.objects[i] >= 0;
        const std::uint32_t object = has_object ? static_cast<std::uint32_t>(arrays.objects[i]) : shared::NO_OBJECT;
        vertices[i].w = std::bit_cast<float>(interaction << 24 | object);
        for (int axis = 0; axis < 3 && !arrays.normals.empty(); ++axis)
            normals[i][axis] = arrays.normals[3 * i + axis];
        normals[i].w = arrays.scatter.empty() ? 0.0f : arrays.scatter[i];
    }
    paths.starts = gpu::make_buffer(device, starts, "path starts");
    paths.vertices = gpu::make_buffer(device, vertices, "path vertices");
    paths.normals = gpu::make_buffer(device, normals, "path normals");
    paths.has_normals = !arrays.normals.empty() || vertices.empty();
    paths.has_interactions = !arrays.interactions.empty() || vertices.empty();
    paths.has_objects = !arrays.objects.empty() || vertices.empty();
    paths.has_scatter = !arrays.scatter.empty() || vertices.empty();
    return paths;
}

void set_colors(gpu::Device& device, PhotonMap& map, std::vector<float> values) {
    const std::size_t count = map.parameters ? map.parameters->count : 0;
    std::vector<glm::vec4> packed(values.size() / 3, glm::vec4(UNSET_GREY, UNSET_GREY, UNSET_GREY, 0.0f));
    for (std::size_t i = 0; i < packed.size(); ++i) {
        const std::span<const float> own =
            count ? std::span(*map.parameters->given).subspan(i * count, count) : std::span<const float>{};
        if (!std::isnan(values[3 * i]) && std::none_of(own.begin(), own.end(), [](float v) { return std::isnan(v); }))
            packed[i] = {values[3 * i], values[3 * i + 1], values[3 * i + 2], 1.0f};
    }
    map.colors = gpu::make_buffer(device, packed, "photon colors");
    map.given_colors = std::make_shared<const std::vector<float>>(std::move(values));
}

PathColumns share_paths(const PathColumns& paths) {
    return {paths.vertex_count, paths.starts.share(),   paths.vertices.share(), paths.normals.share(),
            paths.has_normals,  paths.has_interactions, paths.has_objects,      paths.has_scatter};
}

PhotonMap share_map(const PhotonMap& map) {
    PhotonMap shared;
    shared.count = map.count;
    shared.origin = map.origin;
    shared.position_emitter = map.position_emitter.share();
    shared.normal_index = map.normal_index.share();
    shared.power_object = map.power_object.share();
    shared.long_indices = map.long_indices;
    if (map.paths)
        shared.paths = share_paths(*map.paths);
    if (const auto& parameters = map.parameters)
        shared.parameters = {parameters->count, parameters->values.share(), parameters->given, parameters->periods,
                             parameters->axes};
    if (map.colors)
        shared.colors = map.colors->share();
    shared.given_colors = map.given_colors;
    return shared;
}

std::vector<float> read_vectors(const gpu::Buffer& buffer, std::uint64_t count) {
    std::vector<float> values;
    values.reserve(3 * count);
    for (const glm::vec4& packed : buffer.read<glm::vec4>(count))
        values.insert(values.end(), {packed.x, packed.y, packed.z});
    return values;
}

std::vector<float> read_positions(const PhotonMap& photons) {
    return unpack_positions(photons.position_emitter, photons.count, photons.origin);
}

std::vector<std::int32_t> read_emitters(const PhotonMap& photons) {
    return unpack<std::int32_t>(photons.position_emitter, photons.count,
                                [](const glm::vec4& v) { return std::bit_cast<std::int32_t>(v.w); });
}

std::vector<std::uint64_t> read_emitted_indices(const PhotonMap& photons) {
    if (!photons.long_indices.empty())
        return photons.long_indices;
    return unpack<std::uint64_t>(photons.normal_index, photons.count,
                                 [](const glm::vec4& v) { return std::bit_cast<std::uint32_t>(v.w); });
}

std::vector<std::int32_t> read_objects(const PhotonMap& photons) {
    return unpack<std::int32_t>(photons.power_object, photons.count,
                                [](const glm::vec4& v) { return name_object(std::bit_cast<std::uint32_t>(v.w)); });
}

std::vector<std::int64_t> read_path_offsets(const PathColumns& paths, std::uint64_t photon_count) {
    const std::vector<std::uint32_t> starts = paths.starts.read<std::uint32_t>(photon_count + 1);
    return {starts.begin(), starts.end()};
}

std::vector<float> read_path_vertices(const PathColumns& paths, const std::array<double, 3>& origin) {
    return unpack_positions(paths.vertices, paths.vertex_count, origin);
}

std::vector<std::uint8_t> read_path_interactions(const PathColumns& paths) {
    return unpack<std::uint8_t>(paths.vertices, paths.vertex_count, [](const glm::vec4& v) {
        return static_cast<std::uint8_t>(std::bit_cast<std::uint32_t>(v.w) >> 24);
    });
}

std::vector<std::int32_t> read_path_objects(const PathColumns& paths) {
    return unpack<std::int32_t>(paths.vertices, paths.vertex_count, [](const glm::vec4& v) {
        return name_object(std::bit_cast<std::uint32_t>(v.w) & shared::NO_OBJECT);
    });
}

std::vector<float> read_path_scatter(const PathColumns& paths) {
    return unpack<float>(paths.normals, paths.vertex_count, [](const glm::vec4& v) { return v.w; });
}

std::vector<glm::vec4> localize_points(const PhotonMap& photons, std::span<const double> points) {
    std::vector<glm::vec4> local(points.size() / 3);
    for (std::size_t i = 0; i < local.size(); ++i)
        for (int axis = 0; axis < 3; ++axis)
            local[i][axis] = static_cast<float>(points[3 * i + axis] - photons.origin[axis]);
    return local;
}

} // namespace photonloupe
