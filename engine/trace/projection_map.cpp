// SPDX-License-Identifier: Apache-2.0
// Builds projection maps: triangles are split until each is seen within less than a cell, then what it covers is
// marked.
#include "trace/projection_map.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace photonloupe {
namespace {

using glm::dvec3;

constexpr std::uint32_t COARSEST_ROWS = 64;
// Cells are packed as row << 16 | column and columns are twice the rows.
constexpr std::uint32_t FINEST_ROWS = 4096;
// With this many cells the border cells, which also catch directions that miss, are a few percent.
constexpr std::size_t ENOUGH_CELLS = 4096;
// Splits of one triangle; what is still too close or too large is marked with the cap it has.
constexpr int SPLIT_LIMIT = 24;
// Rounding of positions to float, seen from the light, in radians: far below any cell, far above double rounding.
constexpr double ANGLE_SLACK = 1e-6;
// The same for starts of directional light, in cells.
constexpr double START_SLACK = 1e-2;

// The square's cells, and where geometry falls on them.
class Marker {
public:
    Marker(const EmissionFrame& frame, std::uint32_t row_count, std::int64_t& budget)
        : m_budget(budget), m_frame(frame), m_rows(row_count), m_columns(2 * row_count),
          m_marks(std::size_t{m_rows} * m_columns), m_finest(std::min(2.0, frame.widest()) / row_count) {}

    void mark_triangle(const dvec3& a, const dvec3& b, const dvec3& c) {
        if (m_frame.kind == shared::LIGHT_DIRECTIONAL)
            mark_starts(place_start(a), place_start(b), place_start(c), 0);
        else
            mark_directions(turn(a), turn(b), turn(c), 0);
    }

    ProjectionMap collect() const;

private:
    // Relative to the light, its axis along y.
    dvec3 turn(const dvec3& corner) const {
        const dvec3 d = corner - m_frame.origin;
        return {glm::dot(d, m_frame.u), glm::dot(d, m_frame.axis), glm::dot(d, m_frame.v)};
    }

    // Columns and rows, as fractions of the square.
    glm::dvec2 place_start(const dvec3& corner) const {
        const dvec3 d = corner - m_frame.origin;
        return {glm::dot(d, m_frame.u) / glm::dot(m_frame.u, m_frame.u),
                glm::dot(d, m_frame.v) / glm::dot(m_frame.v, m_frame.v)};
    }

    void mark_all() {
        std::fill(m_marks.begin(), m_marks.end(), std::uint8_t{1});
        m_is_full = true;
    }

    std::uint32_t find_row(double angle) const {
        const double share = m_frame.find_share(std::clamp(angle, 0.0, std::numbers::pi));
        return std::min(m_rows - 1, static_cast<std::uint32_t>(share * m_rows));
    }

    // All cells that meet the cap of directions within `radius` of `center`.
    void mark_cap(const dvec3& center, double radius) {
        const double polar = std::acos(std::clamp(center.y, -1.0, 1.0));
        const bool holds_pole = polar - radius <= 0 || polar + radius >= std::numbers::pi;
        const double reach =
            holds_pole ? std::numbers::pi : std::asin(std::min(1.0, std::sin(radius) / std::sin(polar))) + ANGLE_SLACK;
        const double turn = 2 * std::numbers::pi;
        const double azimuth = std::atan2(center.z, center.x);
        const auto first = static_cast<std::int64_t>(std::floor((azimuth - reach) / turn * m_columns));
        const auto last = static_cast<std::int64_t>(std::floor((azimuth + reach) / turn * m_columns));
        const std::int64_t span = std::min<std::int64_t>(last - first, m_columns - 1);
        if (!spend((span + 1) * (find_row(polar + radius) - find_row(polar - radius) + 1)))
            return;
        for (std::uint32_t row = find_row(polar - radius); row <= find_row(polar + radius); ++row)
            for (std::int64_t step = 0; step <= span; ++step)
                m_marks[std::size_t{row} * m_columns +
                        static_cast<std::size_t>((first + step + 2 * std::int64_t{m_columns}) % m_columns)] = 1;
    }

    // False: all is marked, for there is no budget for more.
    bool spend(std::int64_t cost) {
        m_budget -= cost;
        if (m_budget < 0 && !m_is_full)
            mark_all();
        return !m_is_full;
    }

    // `a`, `b`, `c` relative to the light; from anywhere on it.
    void mark_directions(const dvec3& a, const dvec3& b, const dvec3& c, int splits) {
        if (!spend(1))
            return;
        const auto split = [&](const dvec3& u, const dvec3& v, const dvec3& w) {
            mark_directions(u, v, w, splits + 1);
        };
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        const double edge = std::max({glm::distance(a, b), glm::distance(b, c), glm::distance(c, a)});
        const double nearest = std::max({la, lb, lc}) - edge; // no point of it is nearer
        const bool at_light = la == 0 || lb == 0 || lc == 0 || (m_frame.reach > 0 && nearest <= m_frame.reach);
        const dvec3 sum = at_light ? dvec3(0) : a / la + b / lb + c / lc;
        const double length = glm::length(sum);
        if (at_light || length < 0.5) { // wider than a hemisphere's worth: split, or give up and take everything
            if (splits == SPLIT_LIMIT)
                return mark_all();
            return split_longest(a, b, c, split);
        }
        const dvec3 center = sum / length;
        // Chords, not cosines: those of small angles are all 1.
        const double chord =
            std::max({glm::distance(center, a / la), glm::distance(center, b / lb), glm::distance(center, c / lc)});
        const double radius = 2 * std::asin(std::min(1.0, 0.5 * chord)) + ANGLE_SLACK +
                              (m_frame.reach > 0 ? std::asin(m_frame.reach / nearest) : 0.0);
        if (std::acos(std::clamp(center.y, -1.0, 1.0)) - radius > m_frame.widest())
            return;
        if (chord < m_finest || splits == SPLIT_LIMIT)
            return mark_cap(center, radius);
        split_longest(a, b, c, split);
    }

    void mark_starts(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, int splits) {
        if (!spend(1))
            return;
        const glm::dvec2 size(m_columns, m_rows);
        const glm::dvec2 lo = glm::min(glm::min(a, b), c) * size, hi = glm::max(glm::max(a, b), c) * size;
        if (std::max(hi.x - lo.x, hi.y - lo.y) > 1.0 && splits < SPLIT_LIMIT)
            return split_longest(a, b, c, [&](const glm::dvec2& u, const glm::dvec2& v, const glm::dvec2& w) {
                mark_starts(u, v, w, splits + 1);
            });
        const auto find_cell = [](double place, std::uint32_t count) {
            return static_cast<std::uint32_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
        };
        for (std::uint32_t row = find_cell(lo.y - START_SLACK, m_rows); row <= find_cell(hi.y + START_SLACK, m_rows);
             ++row)
            for (std::uint32_t column = find_cell(lo.x - START_SLACK, m_columns);
                 column <= find_cell(hi.x + START_SLACK, m_columns); ++column)
                m_marks[std::size_t{row} * m_columns + column] = 1;
    }

    // In two, across the longest edge: a sliver becomes a row of small pieces, not a cloud of slivers.
    template <class Corner, class Use>
    static void split_longest(const Corner& a, const Corner& b, const Corner& c, const Use& use) {
        const double ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
        if (bc > ab && bc >= ca)
            return split_longest(b, c, a, use);
        if (ca > ab)
            return split_longest(c, a, b, use);
        const Corner middle = (a + b) * 0.5;
        use(a, middle, c);
        use(middle, b, c);
    }

    std::int64_t& m_budget;
    const EmissionFrame& m_frame;
    std::uint32_t m_rows, m_columns;
    std::vector<std::uint8_t> m_marks;
    double m_finest; // chord of what is small enough
    bool m_is_full = false;
};

ProjectionMap Marker::collect() const {
    ProjectionMap map{m_rows, m_columns, {}, {}};
    for (std::uint32_t row = 0; row < m_rows; ++row) {
        const auto first = static_cast<std::uint32_t>(map.cells.size());
        for (std::uint32_t column = 0; column < m_columns; ++column)
            if (m_marks[std::size_t{row} * m_columns + column])
                map.cells.push_back(row << 16 | column);
        map.row_members.emplace_back(first, static_cast<std::uint32_t>(map.cells.size()) - first);
    }
    return map;
}

ProjectionMap mark_scene(const Scene& scene, const EmissionFrame& frame, bool only_specular, std::uint32_t rows,
                         std::int64_t& budget) {
    Marker marker(frame, rows, budget);
    visit_triangles(scene, only_specular,
                    [&](const dvec3& a, const dvec3& b, const dvec3& c) { marker.mark_triangle(a, b, c); });
    return marker.collect();
}

} // namespace

double ProjectionMap::find_share() const {
    return static_cast<double>(cells.size()) / (static_cast<double>(rows) * columns);
}

ProjectionMap make_full_projection() {
    return {1, 1, {0}, {{0, 1}}};
}

ProjectionMap project_light(const Scene& scene, const EmissionFrame& frame, bool only_specular, std::int64_t& budget) {
    ProjectionMap map = mark_scene(scene, frame, only_specular, COARSEST_ROWS, budget);
    std::uint32_t rows = COARSEST_ROWS;
    // Four times the cells for each doubling of the rows.
    for (std::size_t cells = map.cells.size(); cells > 0 && cells < ENOUGH_CELLS && rows < FINEST_ROWS; cells *= 4)
        rows *= 2;
    return rows == COARSEST_ROWS ? map : mark_scene(scene, frame, only_specular, rows, budget);
}

} // namespace photonloupe
