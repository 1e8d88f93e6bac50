// SPDX-License-Identifier: Apache-2.0
// Intervals brushed on the axes: the photons they select, or-ed on an axis and and-ed between axes, and their outlines.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "inspect/parallel_axes.h"

namespace photonloupe::inspect {
namespace {

// Straight pieces of a brush's outline on an ellipse.
constexpr int ARC_STEPS = 64;

double wrap_difference(double value, double turn) {
    return value - turn * std::floor(value / turn);
}

// On a closed axis an interval is an arc from its low end onwards.
bool is_in_arc(const Interval& brush, double turn, float value) {
    const double length = double(brush.high) - brush.low;
    if (!(turn > 0) || length >= turn)
        return true;
    return wrap_difference(double(value) - brush.low, turn) <= wrap_difference(length, turn);
}

bool is_brushed(const Axis& axis, float value) {
    if (!std::isfinite(value))
        return false;
    const double turn = axis.turn();
    return std::any_of(axis.brushes.begin(), axis.brushes.end(), [&](const Interval& brush) {
        return axis.is_closed ? is_in_arc(brush, turn, value) : value >= brush.low && value <= brush.high;
    });
}

// First and last share of an interval, the last beyond 1 where it goes through a closed axis's ends.
struct ShareRange {
    double first, last;
};

ShareRange find_range(const Axis& axis, const Interval& brush) {
    const double turn = axis.turn();
    if (!axis.is_closed || !(turn > 0))
        return {find_share(axis, std::clamp(brush.low, axis.low, axis.high)),
                find_share(axis, std::clamp(brush.high, axis.low, axis.high))};
    const double first = find_share(axis, brush.low), length = double(brush.high) - brush.low;
    return {first, first + (length >= turn ? 1 : wrap_difference(length, turn) / turn)};
}

} // namespace

glm::vec2 find_outward(const AxisPlace& place, glm::vec2 point) {
    if (place.rx == 0)
        return {1, 0};
    const glm::vec2 offset = point - place.center;
    return glm::normalize(offset / glm::vec2(place.rx * place.rx, place.ry * place.ry));
}

std::vector<glm::vec2> outline_brush(const Axis& axis, const AxisPlace& place, const Interval& brush, float width) {
    const bool is_outside = !axis.is_closed && (brush.low > axis.high || brush.high < axis.low);
    if (is_outside || (!axis.is_closed && brush.low > brush.high))
        return {};
    const auto [first, last] = find_range(axis, brush);
    std::vector<glm::vec2> outer, outline;
    const int steps = axis.is_closed ? ARC_STEPS : 1;
    for (int i = 0; i <= steps; ++i) {
        const glm::vec2 point = find_point(axis, place, first + (last - first) * i / steps);
        outer.push_back(point + width * find_outward(place, point));
        outline.push_back(point - width * find_outward(place, point));
    }
    outline.insert(outline.end(), outer.rbegin(), outer.rend());
    return outline;
}

Selection select_brushed(std::span<const Axis> axes, std::span<const Column> columns, const Selection& within) {
    Selection chosen = within.empty() && !columns.empty() ? select_all(columns[0].values.size()) : within;
    for (const Axis& axis : axes) {
        if (axis.brushes.empty())
            continue;
        const std::vector<float>& values = columns[axis.column].values;
        std::erase_if(chosen, [&](std::uint32_t photon) { return !is_brushed(axis, values[photon]); });
    }
    return chosen;
}

} // namespace photonloupe::inspect
