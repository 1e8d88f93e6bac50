// SPDX-License-Identifier: Apache-2.0
// Measures every photon for a query in the kernels' own order of operations, and keeps the k nearest.
#include "photons/scan_photons.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace photonloupe {
namespace {

// Queries between two reports of progress.
constexpr std::size_t REPORT_EVERY = 16;

class Scan {
public:
    Scan(const KdTree& tree, const ScanShape& shape, const NeighborQueries& queries)
        : m_shape(shape), m_queries(queries), m_rows((shape.parameter_count + 3) / 4),
          m_positions(tree.positions.read<glm::vec4>(tree.count)), m_normals(tree.normals.read<glm::vec4>(tree.count)) {
        if (shape.parameters)
            m_parameters = shape.parameters->read<glm::vec4>(tree.count * m_rows);
        if (shape.periods)
            m_periods = shape.periods->read<float>(shape.parameter_count);
    }

    struct Found {
        float measure;
        std::uint32_t id;
        bool operator<(const Found& other) const {
            return measure != other.measure ? measure < other.measure : id < other.id;
        }
    };

    std::vector<Found> find(std::uint32_t row, std::uint32_t k, bool exclude_self) const {
        const std::uint32_t self = std::bit_cast<std::uint32_t>(m_queries.points[row].w);
        std::vector<Found> found;
        for (std::size_t at = 0; at < m_positions.size(); ++at) {
            const std::uint32_t id = std::bit_cast<std::uint32_t>(m_positions[at].w);
            const float measure = exclude_self && id == self ? INFINITY : measure_photon(row, at);
            if (measure < INFINITY)
                found.push_back({measure, id});
        }
        const auto end = found.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(k, found.size()));
        std::partial_sort(found.begin(), end, found.end());
        found.erase(end, found.end());
        return found;
    }

private:
    float parameter(const std::vector<glm::vec4>& rows, std::size_t first, std::uint32_t i) const {
        return rows[first + i / 4][i % 4];
    }

    bool is_unset(const std::vector<glm::vec4>& rows, std::size_t first) const {
        for (std::uint32_t i = 0; i < m_shape.parameter_count; ++i)
            if (std::isnan(parameter(rows, first, i)))
                return true;
        return false;
    }

    float measure_parameters(std::uint32_t row, std::size_t at) const {
        return photonloupe::measure_parameters(m_shape.parameter_count, m_periods,
                                               {&m_queries.parameters[row * m_rows], m_rows},
                                               {&m_parameters[at * m_rows], m_rows});
    }

    bool is_in_ranges(std::size_t at) const {
        for (std::uint32_t i = 0; i < m_shape.parameter_count; ++i) {
            const float q = parameter(m_parameters, at * m_rows, i);
            const float low = parameter(m_queries.parameters, 0, i), high = parameter(m_queries.range_ends, 0, i);
            if (!(low <= high ? q >= low && q <= high : q >= low || q <= high))
                return false;
        }
        return true;
    }

    bool is_in_layer(std::uint32_t row, std::size_t at) const {
        if (!m_queries.range_ends.empty())
            return is_in_ranges(at);
        if (!has_emitter(row, at))
            return false;
        return is_unset(m_queries.parameters, row * m_rows) ? is_unset(m_parameters, at * m_rows)
                                                            : measure_parameters(row, at) <= m_queries.layers[row].y;
    }

    bool has_emitter(std::uint32_t row, std::size_t at) const {
        const std::uint32_t emitter = std::bit_cast<std::uint32_t>(m_queries.layers[row].x);
        return emitter == shared::ANY_EMITTER || emitter == std::bit_cast<std::uint32_t>(m_normals[at].w);
    }

    float measure_photon(std::uint32_t row, std::size_t at) const {
        if (m_shape.space == shared::SPACE_PARAMETER)
            return has_emitter(row, at) ? measure_parameters(row, at) : INFINITY;
        if (m_shape.space == shared::SPACE_CONSTRAINED && !is_in_layer(row, at))
            return INFINITY;
        const float x = m_positions[at].x - m_queries.points[row].x;
        const float y = m_positions[at].y - m_queries.points[row].y;
        const float z = m_positions[at].z - m_queries.points[row].z;
        return x * x + y * y + z * z;
    }

    const ScanShape& m_shape;
    const NeighborQueries& m_queries;
    std::uint32_t m_rows;
    std::vector<glm::vec4> m_positions, m_normals, m_parameters;
    std::vector<float> m_periods;
};

} // namespace

void scan_photons(const KdTree& tree, const ScanShape& shape, const NeighborQueries& queries,
                  std::span<const std::uint32_t> rows, std::uint32_t k, bool exclude_self, Neighbors& neighbors,
                  const Progress& progress) {
    const Scan scan(tree, shape, queries);
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (i % REPORT_EVERY == 0)
            progress.report("find neighbors", static_cast<double>(i) / static_cast<double>(rows.size()));
        std::vector<std::int32_t> ids(k, -1);
        std::vector<float> distances(k, INFINITY);
        const std::vector<Scan::Found> found = scan.find(rows[i], k, exclude_self);
        for (std::size_t rank = 0; rank < found.size(); ++rank) {
            ids[rank] = static_cast<std::int32_t>(found[rank].id);
            distances[rank] = std::sqrt(found[rank].measure);
        }
        neighbors.ids.upload(ids.data(), k * sizeof(std::int32_t), std::uint64_t{rows[i]} * k * sizeof(std::int32_t));
        neighbors.distances.upload(distances.data(), k * sizeof(float), std::uint64_t{rows[i]} * k * sizeof(float));
    }
}

} // namespace photonloupe
