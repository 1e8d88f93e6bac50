// SPDX-License-Identifier: Apache-2.0
// Finds the loupe's photons with the queries of PhotonMap.neighbors, and describes its center.
#include "inspect/loupe.h"

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "inspect/path_view.h"
#include "photons/map_columns.h"
#include "photons/neighbor_queries.h"
#include "photons/select_photons.h"

namespace photonloupe::inspect {
namespace {

// Of the nearest photons the first of the point's own surface becomes the center.
constexpr std::uint32_t CENTER_CANDIDATES = 64;
// Least cosine between normals of one surface (METHODS §2).
constexpr float SAME_SIDE = 0.7f;

void require_photon(const Photons& photons, std::uint32_t id) {
    if (id >= photons.map.count)
        throw Error("loupe: photon " + std::to_string(id) + " is not in the map; it has " +
                    std::to_string(photons.map.count) + " photons");
}

void require_query(const Photons& photons, const LoupeQuery& query) {
    require_k(query.k);
    for (const std::optional<std::uint32_t>& id : {query.photon, query.pinned})
        if (id)
            require_photon(photons, *id);
    for (const double coordinate : query.point)
        if (!query.photon && !std::isfinite(coordinate))
            throw Error("loupe: the point is not finite; give world coordinates in metres");
    if (query.space == SearchSpace::world)
        return;
    const std::size_t count = require_parameters(photons.map).count;
    if (query.low.size() != query.high.size() || (!query.low.empty() && query.low.size() != count))
        throw Error("loupe: ranges of " + std::to_string(query.low.size()) + " parameters were given; the map has " +
                    std::to_string(count));
}

// One look: the query with its point in the map's coordinates.
struct Look {
    gpu::Device& device;
    Photons& photons;
    const LoupeQuery& query;
    const Progress& progress;
    std::vector<glm::vec4> place; // the point

    std::optional<std::uint32_t> find_center() const;
    Neighbors find_found(std::uint32_t center) const;
    void take_found(LoupeView& view, const Neighbors& found) const;
    void describe_center(LoupeView& view) const;
    void describe_constraint(LoupeView& view) const;
    void describe_path(LoupeView& view) const;
    void list_ellipses(LoupeView& view) const;
};

std::optional<std::uint32_t> Look::find_center() const {
    if (query.photon)
        return query.photon;
    const std::uint32_t count = query.normal ? CENTER_CANDIDATES : 1;
    std::vector<std::int32_t> near =
        find_neighbors(device, photons, {.places = place, .k = count}, progress).ids.read<std::int32_t>(count);
    std::erase(near, -1);
    if (near.empty())
        return std::nullopt;
    const std::vector<std::uint32_t> ids(near.begin(), near.end());
    if (query.normal) {
        const auto normals = read_rows<glm::vec4>(photons.map.normal_index, photons.map.count, ids);
        for (std::size_t i = 0; i < ids.size(); ++i)
            if (glm::dot(glm::vec3(normals[i]), *query.normal) > SAME_SIDE)
                return ids[i];
    }
    return ids[0];
}

Neighbors Look::find_found(std::uint32_t center) const {
    NearestQuery asked{query.space, {}, place, {}, query.k, static_cast<float>(query.beta)};
    const bool is_locked = query.space == SearchSpace::constrained && (query.pinned || !query.low.empty());
    if (query.space == SearchSpace::parameter || (query.photon && !is_locked))
        asked.ids = std::span(&center, 1);
    else if (query.low.empty())
        asked.center = query.pinned.value_or(center);
    asked.low = query.low;
    asked.high = query.high;
    return find_neighbors(device, photons, asked, progress);
}

void Look::take_found(LoupeView& view, const Neighbors& found) const {
    const std::vector<std::int32_t> ids = found.ids.read<std::int32_t>(query.k);
    const std::vector<float> distances = found.distances.read<float>(query.k);
    for (std::size_t i = 0; i < ids.size() && ids[i] >= 0; ++i) {
        view.ids.push_back(static_cast<std::uint32_t>(ids[i]));
        view.distances.push_back(distances[i]);
    }
    for (const glm::vec4& position : read_rows<glm::vec4>(photons.map.position_emitter, photons.map.count, view.ids)) {
        view.positions.emplace_back(position);
        view.radius = std::max(view.radius, glm::distance(view.positions.back(), view.place));
    }
    if (photons.map.colors)
        for (const glm::vec4& color : read_rows<glm::vec4>(*photons.map.colors, photons.map.count, view.ids))
            view.colors.emplace_back(color);
}

void Look::describe_center(LoupeView& view) const {
    const std::uint32_t center = *view.center;
    const glm::vec4 position = photons.map.position_emitter.read<glm::vec4>(1, center)[0];
    view.center_position = glm::vec3(position);
    view.center_normal = glm::vec3(photons.map.normal_index.read<glm::vec4>(1, center)[0]);
    view.numbers.power = glm::vec3(photons.map.power_object.read<glm::vec4>(1, center)[0]);
    for (int axis = 0; axis < 3; ++axis)
        view.numbers.position[axis] = static_cast<double>(position[axis]) + photons.map.origin[axis];
    if (!photons.map.parameters)
        return;
    const ParameterColumns& columns = *photons.map.parameters;
    const auto values = columns.values.read<float>(columns.count, std::uint64_t{center} * 4 * columns.count_rows());
    for (std::uint32_t i = 0; i < columns.count; ++i)
        view.numbers.parameters.emplace_back(columns.axes[i].name, values[i]);
}

glm::vec3 take_vector(const std::vector<float>& values, std::size_t at) {
    return {values[at], values[at + 1], values[at + 2]};
}

void Look::describe_constraint(LoupeView& view) const {
    view.spread = measure_spread(view.positions, view.center_normal);
    const std::size_t center = *view.center;
    const RelaxedState* state = photons.state.get();
    view.has_constraint = state && !state->basis.empty();
    view.along = view.has_constraint ? take_vector(state->basis, 6 * center) : view.spread.along;
    view.across = view.has_constraint ? take_vector(state->basis, 6 * center + 3) : view.spread.across;
    view.freedom_along = view.has_constraint ? 1 - state->weights[2 * center] : 1;
    view.freedom_across = view.has_constraint ? 1 - state->weights[2 * center + 1] : 1;
    const auto find = [&](std::vector<float> RelaxedState::* field) {
        return state && !(state->*field).empty() ? (state->*field)[center] : UNKNOWN;
    };
    view.numbers.one_sidedness = find(&RelaxedState::one_sidedness);
    view.numbers.pressure = find(&RelaxedState::pressure);
    view.numbers.drift = state && !state->drift.empty() ? glm::length(take_vector(state->drift, 3 * center)) : UNKNOWN;
}

void Look::describe_path(LoupeView& view) const {
    LoupeNumbers& numbers = view.numbers;
    if (!photons.map.paths)
        return;
    const std::uint32_t ids[] = {*view.center};
    const HostPaths paths = read_paths_of(photons.map, ids);
    numbers.interactions = spell_signature(paths.view(0));
    numbers.signature = encode_signature(paths.view(0));
    numbers.tortuosity = measure_tortuosity(paths.view(0));
    numbers.path_length = measure_length(paths.view(0));
}

void Look::list_ellipses(LoupeView& view) const {
    const RelaxedState* state = photons.state.get();
    if (!state || state->basis.empty() || state->drift.empty())
        return;
    for (const std::size_t id : view.ids) {
        DriftEllipse ellipse{take_vector(state->basis, 6 * id), take_vector(state->basis, 6 * id + 3)};
        const glm::vec3 drift = take_vector(state->drift, 3 * id);
        ellipse.half_along = std::abs(glm::dot(drift, ellipse.along));
        ellipse.half_across = std::abs(glm::dot(drift, ellipse.across));
        view.ellipses.push_back(ellipse);
    }
}

} // namespace

LoupeView look_through_loupe(gpu::Device& device, Photons& photons, const LoupeQuery& query, const Progress& progress) {
    require_query(photons, query);
    Look look{device, photons, query, progress, localize_points(photons.map, query.point)};
    if (query.photon)
        look.place = {glm::vec4(glm::vec3(photons.map.position_emitter.read<glm::vec4>(1, *query.photon)[0]), 0.0f)};
    LoupeView view;
    view.origin = photons.map.origin;
    view.place = glm::vec3(look.place[0]);
    view.center = look.find_center();
    if (!view.center)
        return view;
    look.take_found(view, look.find_found(*view.center));
    look.describe_center(view);
    look.describe_constraint(view);
    look.describe_path(view);
    look.list_ellipses(view);
    return view;
}

std::vector<PathLine> read_path_lines(const Photons& photons, std::span<const std::uint32_t> ids) {
    if (!photons.map.paths)
        throw Error("loupe: the map has no paths; record them when tracing, or give them to from_arrays");
    for (const std::uint32_t id : ids)
        require_photon(photons, id);
    const HostPaths paths = read_paths_of(photons.map, ids);
    std::vector<PathLine> lines;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        PathLine line;
        for (const glm::vec4& vertex : paths.view(i).vertices) {
            line.points.emplace_back(vertex);
            line.interactions.push_back(static_cast<std::uint8_t>(read_interaction(vertex)));
        }
        lines.push_back(std::move(line));
    }
    return lines;
}

} // namespace photonloupe::inspect
