// SPDX-License-Identifier: Apache-2.0
// Builds projection maps: triangles are split until each is seen within less than a cell, then their caps are marked.
#include "trace/projection_map.h"

#include <algorithm>
#include <cmath>
#include <cstring>
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

struct Marker {
    std::uint32_t rows;
    std::uint32_t columns;
    std::vector<std::uint8_t> marks;

    explicit Marker(std::uint32_t row_count)
        : rows(row_count), columns(2 * row_count), marks(std::size_t{rows} * columns) {}

    void mark_all() { std::fill(marks.begin(), marks.end(), std::uint8_t{1}); }

    // All cells that meet the cap of directions within `radius` of `center`.
    void mark_cap(const dvec3& center, double radius) {
        const double polar = std::acos(std::clamp(center.y, -1.0, 1.0));
        const auto row_of = [&](double angle) {
            const double y = std::cos(std::clamp(angle, 0.0, std::numbers::pi));
            return std::min(rows - 1, static_cast<std::uint32_t>((1.0 - y) * 0.5 * rows));
        };
        const bool holds_pole = polar - radius <= 0 || polar + radius >= std::numbers::pi;
        const double reach =
            holds_pole ? std::numbers::pi : std::asin(std::min(1.0, std::sin(radius) / std::sin(polar))) + ANGLE_SLACK;
        const double turn = 2 * std::numbers::pi;
        const double azimuth = std::atan2(center.z, center.x);
        const auto first = static_cast<std::int64_t>(std::floor((azimuth - reach) / turn * columns));
        const auto last = static_cast<std::int64_t>(std::floor((azimuth + reach) / turn * columns));
        const std::int64_t span = std::min<std::int64_t>(last - first, columns - 1);
        for (std::uint32_t row = row_of(polar - radius); row <= row_of(polar + radius); ++row)
            for (std::int64_t step = 0; step <= span; ++step)
                marks[std::size_t{row} * columns +
                      static_cast<std::size_t>((first + step + 2 * std::int64_t{columns}) % columns)] = 1;
    }

    // `a`, `b`, `c` relative to the light.
    void mark_triangle(const dvec3& a, const dvec3& b, const dvec3& c, int splits) {
        const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        const bool at_light = la == 0 || lb == 0 || lc == 0;
        const dvec3 sum = at_light ? dvec3(0) : a / la + b / lb + c / lc;
        const double length = glm::length(sum);
        if (at_light || length < 0.5) { // wider than a hemisphere's worth: split, or give up and take everything
            if (splits == SPLIT_LIMIT)
                return mark_all();
            return split_triangle(a, b, c, splits);
        }
        const dvec3 center = sum / length;
        // Chords, not cosines: those of small angles are all 1.
        const double chord =
            std::max({glm::distance(center, a / la), glm::distance(center, b / lb), glm::distance(center, c / lc)});
        if (chord < 2.0 / rows || splits == SPLIT_LIMIT)
            return mark_cap(center, 2 * std::asin(std::min(1.0, 0.5 * chord)) + ANGLE_SLACK);
        split_triangle(a, b, c, splits);
    }

    // In two, across the longest edge: a sliver becomes a row of small pieces, not a cloud of slivers.
    void split_triangle(const dvec3& a, const dvec3& b, const dvec3& c, int splits) {
        const double ab = glm::distance(a, b), bc = glm::distance(b, c), ca = glm::distance(c, a);
        if (bc > ab && bc >= ca)
            return split_triangle(b, c, a, splits);
        if (ca > ab)
            return split_triangle(c, a, b, splits);
        const dvec3 middle = (a + b) * 0.5;
        mark_triangle(a, middle, c, splits + 1);
        mark_triangle(middle, b, c, splits + 1);
    }
};

bool is_specular(const shared::Material& material) {
    const float metallic = material.base_color_metallic.w;
    return metallic > 0 || material.emission_transmission.w > 0;
}

ProjectionMap collect_cells(const Marker& marker) {
    ProjectionMap map{marker.rows, marker.columns, {}, {}};
    for (std::uint32_t row = 0; row < marker.rows; ++row) {
        const auto first = static_cast<std::uint32_t>(map.cells.size());
        for (std::uint32_t column = 0; column < marker.columns; ++column)
            if (marker.marks[std::size_t{row} * marker.columns + column])
                map.cells.push_back(row << 16 | column);
        map.row_members.emplace_back(first, static_cast<std::uint32_t>(map.cells.size()) - first);
    }
    return map;
}

Marker mark_scene(const Scene& scene, const dvec3& light, std::uint32_t rows) {
    Marker marker(rows);
    for (const shared::Triangle& triangle : scene.triangles) {
        std::uint32_t material;
        std::memcpy(&material, &triangle.v1_material.w, sizeof material);
        if (!is_specular(scene.materials[material]))
            continue;
        marker.mark_triangle(dvec3(triangle.v0_object) - light, dvec3(triangle.v1_material) - light,
                             dvec3(triangle.v2_source) - light, 0);
    }
    return marker;
}

} // namespace

double ProjectionMap::solid_angle() const {
    return 4 * std::numbers::pi * static_cast<double>(cells.size()) / (static_cast<double>(rows) * columns);
}

ProjectionMap make_full_projection() {
    return {1, 1, {0}, {{0, 1}}};
}

ProjectionMap project_specular(const Scene& scene, const shared::Light& light) {
    const dvec3 position(light.position_kind);
    ProjectionMap map = collect_cells(mark_scene(scene, position, COARSEST_ROWS));
    std::uint32_t rows = COARSEST_ROWS;
    // Four times the cells for each doubling of the rows.
    for (std::size_t cells = map.cells.size(); cells > 0 && cells < ENOUGH_CELLS && rows < FINEST_ROWS; cells *= 4)
        rows *= 2;
    return rows == COARSEST_ROWS ? map : collect_cells(mark_scene(scene, position, rows));
}

} // namespace photonloupe
