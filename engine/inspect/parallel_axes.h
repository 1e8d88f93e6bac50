// SPDX-License-Identifier: Apache-2.0
// The axes of parallel coordinates ([SJL15] section 4.4): a line between two limits, or an ellipse around which the
// range winds; where they stand in an image, and the way from a value to its point and back.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/vec2.hpp>

#include "inspect/column.h"

namespace photonloupe::inspect {

// Values from `low` to `high`, both included. On a closed axis low > high goes on through the ends.
struct Interval {
    float low = 0, high = 0;
};

// How a column is shown.
struct Axis {
    std::size_t column = 0;        // index into the columns
    float low = 0, high = 0;       // range between the ends; low ≤ high
    bool is_flipped = false;       // runs downwards, or clockwise
    bool is_closed = false;        // an ellipse whose start is its end
    std::uint32_t periods = 1;     // closed: how often the range winds round it
    std::vector<Interval> brushes; // values in any of them are selected; none: all are

    double turn() const { return (double(high) - low) / periods; } // closed: the range that winds round it once
};

// Where an axis stands, in pixels, y downwards: an open one is the line from (x, y + ry) to (x, y - ry).
struct AxisPlace {
    glm::vec2 center{0};
    float rx = 0; // 0: open; less than half the way to the next axis
    float ry = 0;
};

struct AxisLayout {
    std::uint32_t width = 0, height = 0;
    std::vector<AxisPlace> places;
};

// Pixels around the axes, for what is written there.
struct LayoutMargins {
    float left = 56, right = 56, top = 34, bottom = 30;
};

// An axis over the whole range of the column; closed where the column repeats.
Axis make_axis(std::span<const Column> columns, std::size_t column);

// Throws Error that names the axis: unknown column, limits or ends of brushes that are not finite, limits that
// stand reversed, no period.
void check_axes(std::span<const Column> columns, std::span<const Axis> axes);

// Spreads axes evenly over an image, on borders between pixels. Throws Error when there is no room for them.
AxisLayout place_axes(std::span<const Axis> axes, std::uint32_t width, std::uint32_t height,
                      const LayoutMargins& margins = {});

// Place of a value between the ends, 0 at `low` and 1 at `high`; beyond them less or more, on a closed axis wrapped
// into [0, 1). Half way on an axis without extent. NaN for a value that is not finite.
double find_share(const Axis& axis, float value);

// The point of a share: an open axis runs upwards; an ellipse counterclockwise from its lowest point. Points beyond
// the ends of an open axis keep to MOST_BEYOND lengths of it. NaN: no value.
glm::vec2 find_point(const Axis& axis, const AxisPlace& place, double share);
glm::vec2 find_value_point(const Axis& axis, const AxisPlace& place, float value);

constexpr double MOST_BEYOND = 8;

// The value nearest to a pixel: by height on an open axis, by angle on a closed one, where of the values that share a
// point the one nearest to `near` is taken (default: in the first turn).
float find_value(const Axis& axis, const AxisPlace& place, glm::vec2 pixel, std::optional<float> near = {});

// Pixels from a point to the axis.
float find_distance(const AxisPlace& place, glm::vec2 pixel);
// The nearest axis within `reach` pixels.
std::optional<std::size_t> find_axis(const AxisLayout& layout, glm::vec2 pixel, float reach);

// The area `width` pixels to either side of the axis from the interval's low end to its high one; empty where the
// interval lies beyond the ends of an open axis.
std::vector<glm::vec2> outline_brush(const Axis& axis, const AxisPlace& place, const Interval& brush, float width);
// The direction away from the axis: right of a line, along the normal of an ellipse.
glm::vec2 find_outward(const AxisPlace& place, glm::vec2 point);

// Photons that every brushed axis selects, of `within` (empty: of all). No value: never. On an ellipse that the range
// winds round several times an interval selects every value whose point lies in it.
Selection select_brushed(std::span<const Axis> axes, std::span<const Column> columns, const Selection& within);

} // namespace photonloupe::inspect
