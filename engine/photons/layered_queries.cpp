// SPDX-License-Identifier: Apache-2.0
// Packs queries in parameter space and in layers.
#include "photons/layered_queries.h"

#include <bit>
#include <cmath>

namespace photonloupe {
namespace {

// Below this share of the map, queries are few.
constexpr std::uint64_t FEW_DIVISOR = 16;

std::vector<glm::vec4> read_rows(const PhotonMap& photons, std::uint32_t id) {
    const ParameterColumns& columns = require_parameters(photons);
    return columns.values.read<glm::vec4>(columns.count_rows(), std::uint64_t{id} * columns.count_rows());
}

glm::vec4 read_position(const PhotonMap& photons, std::uint32_t id) {
    return photons.position_emitter.read<glm::vec4>(1, id)[0];
}

float scale_reach2(float radius2, float beta) {
    return beta > 0 ? beta * beta * radius2 : 0.0f;
}

// The widest parameters of packed rows, where the parameter tree has them.
glm::vec4 pick_widest(const ParameterTree& parameter_tree, std::span<const glm::vec4> rows) {
    glm::vec4 point(0.0f);
    for (std::size_t axis = 0; axis < parameter_tree.axes.size(); ++axis) {
        const std::uint32_t i = parameter_tree.axes[axis];
        point[axis] = rows[i / 4][i % 4];
    }
    return point;
}

std::vector<glm::vec4> pack_rows(std::span<const float> values) {
    std::vector<glm::vec4> rows((values.size() + 3) / 4, glm::vec4(0.0f));
    for (std::size_t i = 0; i < values.size(); ++i)
        rows[i / 4][i % 4] = values[i];
    return rows;
}

void append(std::vector<glm::vec4>& rows, const std::vector<glm::vec4>& more) {
    rows.insert(rows.end(), more.begin(), more.end());
}

} // namespace

NeighborQueries ask_parameters_of(const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::span<const std::uint32_t> ids) {
    NeighborQueries queries;
    for (const std::uint32_t id : ids) {
        const std::vector<glm::vec4> rows = read_rows(photons, id);
        glm::vec4 point = pick_widest(parameter_tree, rows);
        for (int axis = 0; axis < 3; ++axis)
            if (point[axis] != point[axis])
                point[axis] = 0.0f; // finds nobody: its parameters are unset
        point.w = std::bit_cast<float>(id);
        queries.points.push_back(point);
        append(queries.parameters, rows);
        queries.layers.push_back({read_position(photons, id).w, 0.0f, 0.0f, 0.0f});
    }
    return queries;
}

NeighborQueries ask_parameters_at(const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::span<const double> values) {
    const std::uint32_t count = require_parameters(photons).count;
    NeighborQueries queries;
    for (std::size_t first = 0; first < values.size(); first += count) {
        std::vector<float> row(values.begin() + static_cast<std::ptrdiff_t>(first),
                               values.begin() + static_cast<std::ptrdiff_t>(first + count));
        const std::vector<glm::vec4> rows = pack_rows(row);
        queries.points.push_back(pick_widest(parameter_tree, rows));
        append(queries.parameters, rows);
        queries.layers.push_back({std::bit_cast<float>(shared::ANY_EMITTER), 0.0f, 0.0f, 0.0f});
    }
    return queries;
}

std::vector<float> find_radii2_of(gpu::Device& device, const PhotonMap& photons, const ParameterTree& parameter_tree,
                                  std::span<const std::uint32_t> ids, std::uint32_t k, const Progress& progress) {
    std::vector<float> radii2(ids.size(), INFINITY);
    if (ids.size() * FEW_DIVISOR > photons.count) {
        const gpu::Buffer found = find_parameter_radii2(device, photons, parameter_tree, k, progress);
        const std::vector<float> all = found.read<float>(photons.count);
        for (std::size_t row = 0; row < ids.size(); ++row)
            radii2[row] = all[ids[row]];
        return radii2;
    }
    // Few photons: their lists name the k-th neighbour, and its distance is computed as the kernels do.
    const ParameterColumns& columns = require_parameters(photons);
    const Neighbors near = find_in_parameter_space(device, parameter_tree,
                                                   ask_parameters_of(photons, parameter_tree, ids), k, true, progress);
    for (std::size_t row = 0; row < ids.size(); ++row)
        if (const std::int32_t last = near.ids.read<std::int32_t>(1, row * k + k - 1)[0]; last >= 0)
            radii2[row] = measure_parameters(columns.count, columns.periods, read_rows(photons, ids[row]),
                                             read_rows(photons, static_cast<std::uint32_t>(last)));
    return radii2;
}

NeighborQueries ask_layers_of(const PhotonMap& photons, std::span<const std::uint32_t> ids,
                              std::span<const float> radii2, float beta) {
    NeighborQueries queries;
    for (std::size_t row = 0; row < ids.size(); ++row) {
        const glm::vec4 photon = read_position(photons, ids[row]);
        queries.points.emplace_back(glm::vec3(photon), std::bit_cast<float>(ids[row]));
        append(queries.parameters, read_rows(photons, ids[row]));
        queries.layers.push_back({photon.w, scale_reach2(radii2[row], beta), 0.0f, 0.0f});
    }
    return queries;
}

NeighborQueries ask_layer_at(const PhotonMap& photons, std::span<const glm::vec4> points, std::uint32_t center,
                             float radius2, float beta) {
    const std::vector<glm::vec4> rows = read_rows(photons, center);
    const glm::vec4 layer{read_position(photons, center).w, scale_reach2(radius2, beta), 0.0f, 0.0f};
    NeighborQueries queries;
    for (const glm::vec4& point : points) {
        queries.points.push_back(point);
        append(queries.parameters, rows);
        queries.layers.push_back(layer);
    }
    return queries;
}

NeighborQueries ask_ranges_at(std::span<const glm::vec4> points, std::span<const float> low,
                              std::span<const float> high) {
    NeighborQueries queries;
    queries.points.assign(points.begin(), points.end());
    queries.parameters = pack_rows(low);
    queries.range_ends = pack_rows(high);
    queries.layers.assign(points.size(), {std::bit_cast<float>(shared::ANY_EMITTER), 0.0f, 0.0f, 0.0f});
    return queries;
}

} // namespace photonloupe
