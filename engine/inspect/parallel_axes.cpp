// SPDX-License-Identifier: Apache-2.0
// Values to points and back, and the layout of the axes.
#include "inspect/parallel_axes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <glm/geometric.hpp>

#include "core/error.h"

namespace photonloupe::inspect {
namespace {

constexpr double TURN = 2 * std::numbers::pi;
// An ellipse's half-width: of the distance between axes, and at most of its own half-height.
constexpr float ELLIPSE_SHARE = 0.17f;
constexpr float ROUNDEST = 0.5f;
// Curves need columns of their own between two ellipses.
constexpr float LEAST_SPACING = 6;
constexpr float LEAST_HEIGHT = 8;

double wrap(double share) {
    const double rest = share - std::floor(share);
    return rest >= 1 ? 0 : rest; // NaN stays NaN
}

} // namespace

Axis make_axis(std::span<const Column> columns, std::size_t column) {
    const Column& shown = columns[column];
    const bool is_closed = shown.period > 0;
    return {.column = column,
            .low = shown.low,
            .high = is_closed ? shown.low + shown.period : shown.high,
            .is_closed = is_closed};
}

void check_axes(std::span<const Column> columns, std::span<const Axis> axes) {
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const Axis& axis = axes[i];
        const std::string where = "axis " + std::to_string(i);
        if (axis.column >= columns.size())
            throw Error(where + " shows column " + std::to_string(axis.column) + "; there are " +
                        std::to_string(columns.size()));
        const std::string named = where + " (" + columns[axis.column].name + ")";
        if (!std::isfinite(axis.low) || !std::isfinite(axis.high))
            throw Error(named + " has a limit that is not a finite number; give it low and high");
        if (axis.low > axis.high)
            throw Error(named + " runs from high to low; swap its limits and flip it");
        if (axis.periods == 0)
            throw Error(named + " has 0 periods; its range winds round at least once");
        for (const Interval& brush : axis.brushes)
            if (!std::isfinite(brush.low) || !std::isfinite(brush.high))
                throw Error(named + " has a brush whose end is not a finite number; give it two values");
    }
}

AxisLayout place_axes(std::span<const Axis> axes, std::uint32_t width, std::uint32_t height,
                      const LayoutMargins& margins) {
    AxisLayout layout{width, height, {}};
    const float room = static_cast<float>(width) - margins.left - margins.right;
    const float ry = std::floor((static_cast<float>(height) - margins.top - margins.bottom) / 2);
    const float spacing = axes.size() > 1 ? room / static_cast<float>(axes.size() - 1) : room;
    if (!(spacing >= LEAST_SPACING) || !(ry >= LEAST_HEIGHT / 2))
        throw Error("an image of " + std::to_string(width) + " x " + std::to_string(height) +
                    " pixels has no room for " + std::to_string(axes.size()) + " axes; make it larger or show fewer");
    for (std::size_t i = 0; i < axes.size(); ++i) {
        const float x = axes.size() > 1 ? margins.left + spacing * static_cast<float>(i) : margins.left + room / 2;
        const float rx = axes[i].is_closed ? std::min(ELLIPSE_SHARE * spacing, ROUNDEST * ry) : 0;
        layout.places.push_back({{std::round(x), margins.top + ry}, rx, ry});
    }
    return layout;
}

double find_share(const Axis& axis, float value) {
    if (!std::isfinite(value))
        return NAN;
    const double extent = double(axis.high) - axis.low;
    if (extent == 0)
        return 0.5;
    const double share = (double(value) - axis.low) / extent;
    return axis.is_closed ? wrap(share * axis.periods) : share;
}

glm::vec2 find_point(const Axis& axis, const AxisPlace& place, double share) {
    const double along = axis.is_flipped ? 1 - share : share;
    if (!axis.is_closed) {
        const double kept = std::clamp(along, -MOST_BEYOND, 1 + MOST_BEYOND);
        return {std::isnan(share) ? NAN : place.center.x, place.center.y + place.ry * (1 - 2 * kept)};
    }
    const double angle = TURN * wrap(along);
    return {place.center.x + place.rx * std::sin(angle), place.center.y + place.ry * std::cos(angle)};
}

glm::vec2 find_value_point(const Axis& axis, const AxisPlace& place, float value) {
    return find_point(axis, place, find_share(axis, value));
}

float find_value(const Axis& axis, const AxisPlace& place, glm::vec2 pixel, std::optional<float> near) {
    const glm::dvec2 offset = glm::dvec2(pixel) - glm::dvec2(place.center);
    const double extent = double(axis.high) - axis.low;
    if (!axis.is_closed) {
        const double along = std::clamp(0.5 - offset.y / (2.0 * place.ry), 0.0, 1.0);
        return static_cast<float>(axis.low + extent * (axis.is_flipped ? 1 - along : along));
    }
    const double along = wrap(std::atan2(offset.x / place.rx, offset.y / place.ry) / TURN);
    const double turn = axis.turn();
    const double first = axis.low + turn * (axis.is_flipped ? wrap(1 - along) : along);
    if (!near || turn == 0)
        return static_cast<float>(first);
    const double turns = std::round((*near - first) / turn);
    return static_cast<float>(first + turn * std::clamp(turns, 0.0, axis.periods - 1.0));
}

float find_distance(const AxisPlace& place, glm::vec2 pixel) {
    const glm::vec2 offset = pixel - place.center;
    if (place.rx == 0)
        return glm::length(glm::vec2(offset.x, std::max(std::abs(offset.y) - place.ry, 0.0f)));
    // To first order: the implicit equation over its gradient.
    const glm::vec2 scaled = offset / glm::vec2(place.rx, place.ry);
    const float radius = glm::length(scaled);
    const float slope = glm::length(scaled / glm::vec2(place.rx, place.ry));
    return slope > 0 ? std::abs(radius - 1) * radius / slope : std::min(place.rx, place.ry);
}

std::optional<std::size_t> find_axis(const AxisLayout& layout, glm::vec2 pixel, float reach) {
    std::optional<std::size_t> nearest;
    for (std::size_t i = 0; i < layout.places.size(); ++i) {
        const float distance = find_distance(layout.places[i], pixel);
        if (distance <= reach) {
            nearest = i;
            reach = distance;
        }
    }
    return nearest;
}

} // namespace photonloupe::inspect
