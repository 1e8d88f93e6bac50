// SPDX-License-Identifier: Apache-2.0
// Packs and orders queries.
#include "photons/neighbor_queries.h"

#include <bit>

#include <glm/common.hpp>

#include "photons/select_photons.h"

namespace photonloupe {
namespace {

constexpr std::uint32_t NOBODY = 0xffffffffu;

std::uint32_t spread_bits(std::uint32_t x) {
    x = (x | x << 16) & 0x030000ffu;
    x = (x | x << 8) & 0x0300f00fu;
    x = (x | x << 4) & 0x030c30c3u;
    return (x | x << 2) & 0x09249249u;
}

// What decides about the order: the place, or where there is only a row the first parameters.
std::vector<glm::vec4> list_keys(const NeighborQueries& queries) {
    if (queries.rows.empty() || std::any_of(queries.points.begin(), queries.points.end(),
                                            [](const glm::vec4& point) { return glm::vec3(point) != glm::vec3(0.0f); }))
        return queries.points;
    std::vector<glm::vec4> keys;
    for (std::size_t i = 0; i < queries.rows.size(); i += queries.row_count) {
        const glm::vec4& row = queries.rows[i];
        keys.emplace_back(row.y, row.z, row.w, 0.0f);
    }
    return keys;
}

template <class T>
gpu::Buffer upload_in_order(gpu::Device& device, const std::vector<T>& values, std::size_t width,
                            std::span<const std::uint32_t> order) {
    if (values.empty())
        return {};
    std::vector<T> ordered(values.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        std::copy_n(&values[order[i] * width], width, &ordered[i * width]);
    return gpu::make_buffer(device, ordered, "queries");
}

} // namespace

NeighborQueries ask_about(const PhotonMap& photons, std::span<const std::uint32_t> ids) {
    for (std::size_t row = 0; row < ids.size(); ++row)
        if (ids[row] >= photons.count)
            throw Error("photon id " + std::to_string(ids[row]) + " at row " + std::to_string(row) +
                        " is out of range; the map has " + std::to_string(photons.count) + " photons");
    NeighborQueries queries;
    queries.points = read_rows<glm::vec4>(photons.position_emitter, photons.count, ids);
    for (std::size_t i = 0; i < ids.size(); ++i)
        queries.points[i].w = std::bit_cast<float>(ids[i]);
    return queries;
}

NeighborQueries ask_at(std::span<const glm::vec4> points) {
    NeighborQueries queries;
    queries.points.assign(points.begin(), points.end());
    for (glm::vec4& point : queries.points)
        point.w = std::bit_cast<float>(NOBODY);
    return queries;
}

NeighborQueries ask_with_rows(const PhotonMap& photons, const ParameterRows& parameters,
                              std::span<const std::uint32_t> ids) {
    NeighborQueries queries = ask_about(photons, ids);
    queries.row_count = parameters.rows.count_rows();
    queries.rows = read_rows<glm::vec4>(parameters.rows.values, photons.count, ids, queries.row_count);
    return queries;
}

NeighborQueries ask_parameters_at(const ParameterRows& parameters, std::span<const double> values) {
    const std::uint32_t count = parameters.rows.axis_count - 1;
    NeighborQueries queries;
    queries.row_count = parameters.rows.count_rows();
    for (std::size_t first = 0; first < values.size(); first += count) {
        std::vector<glm::vec4> row(queries.row_count, glm::vec4(0.0f)); // number 0: any layer that is set
        for (std::uint32_t i = 0; i < count; ++i)
            row[(i + 1) / 4][static_cast<int>((i + 1) % 4)] = static_cast<float>(values[first + i]);
        queries.rows.insert(queries.rows.end(), row.begin(), row.end());
        queries.points.emplace_back(0.0f, 0.0f, 0.0f, std::bit_cast<float>(NOBODY));
    }
    return queries;
}

void seek_in_layer(NeighborQueries& queries, std::span<const glm::vec4> row, float reach2) {
    queries.row_count = static_cast<std::uint32_t>(row.size());
    queries.rows.clear();
    for (std::size_t i = 0; i < queries.points.size(); ++i)
        queries.rows.insert(queries.rows.end(), row.begin(), row.end());
    queries.reach2.assign(queries.points.size(), reach2);
}

void seek_in_intervals(NeighborQueries& queries, std::span<const float> low, std::span<const float> high) {
    queries.row_count = static_cast<std::uint32_t>((low.size() + 4) / 4);
    queries.intervals.assign(2 * queries.row_count, glm::vec4(0.0f));
    queries.intervals[0].x = std::numeric_limits<float>::min(); // layer numbers of photons that have parameters
    queries.intervals[queries.row_count].x = std::numeric_limits<float>::infinity();
    for (std::size_t i = 0; i < low.size(); ++i) {
        queries.intervals[(i + 1) / 4][static_cast<int>((i + 1) % 4)] = low[i];
        queries.intervals[queries.row_count + (i + 1) / 4][static_cast<int>((i + 1) % 4)] = high[i];
    }
}

float scale_reach2(float radius2, float beta) {
    return beta > 0 ? beta * beta * radius2 : 0.0f;
}

Queries OrderedQueries::view() const {
    const auto show = [](const gpu::Buffer& buffer) { return buffer.is_empty() ? nullptr : &buffer; };
    return {count, show(points), nullptr, show(rows), show(reach2), false};
}

OrderedQueries order_queries(gpu::Device& device, const NeighborQueries& queries) {
    const std::vector<std::uint32_t> order = order_points(list_keys(queries));
    OrderedQueries ordered;
    ordered.count = order.size();
    ordered.points = upload_in_order(device, queries.points, 1, order);
    ordered.rows = upload_in_order(device, queries.rows, queries.row_count, order);
    ordered.reach2 = upload_in_order(device, queries.reach2, 1, order);
    if (!queries.intervals.empty())
        ordered.intervals = gpu::make_buffer(device, queries.intervals, "intervals");
    ordered.result_rows = gpu::make_buffer(device, order, "query order");
    return ordered;
}

std::vector<std::uint32_t> order_points(std::span<const glm::vec4> points) {
    constexpr double CELLS = 1024; // 10 bits an axis
    glm::dvec3 lo(std::numeric_limits<double>::max()), hi(std::numeric_limits<double>::lowest());
    for (const glm::vec4& point : points) {
        lo = glm::min(lo, glm::dvec3(point));
        hi = glm::max(hi, glm::dvec3(point));
    }
    const glm::dvec3 extent = hi - lo;
    const double scale = std::max({extent.x, extent.y, extent.z, 1e-300});
    std::vector<std::uint64_t> keys(points.size()); // Morton code above, index below
    for (std::size_t i = 0; i < points.size(); ++i) {
        const glm::dvec3 cell = glm::min((glm::dvec3(points[i]) - lo) / scale * CELLS, glm::dvec3(CELLS - 1));
        const std::uint64_t code = spread_bits(static_cast<std::uint32_t>(cell.x)) |
                                   spread_bits(static_cast<std::uint32_t>(cell.y)) << 1 |
                                   spread_bits(static_cast<std::uint32_t>(cell.z)) << 2;
        keys[i] = code << 32 | i;
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order(points.size());
    std::transform(keys.begin(), keys.end(), order.begin(),
                   [](std::uint64_t key) { return static_cast<std::uint32_t>(key); });
    return order;
}

} // namespace photonloupe
