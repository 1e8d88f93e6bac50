// SPDX-License-Identifier: Apache-2.0
// Counts the polygon's edges to the right of each point.
#include "inspect/lasso.h"

#include <algorithm>
#include <cmath>

namespace photonloupe::inspect {
namespace {

bool is_inside(const glm::dvec2& point, std::span<const glm::dvec2> polygon) {
    bool inside = false;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec2& a = polygon[i];
        const glm::dvec2& b = polygon[(i + 1) % polygon.size()];
        // Half open, so that a corner at the point's height counts once.
        if ((a.y > point.y) != (b.y > point.y) && point.x < a.x + (point.y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    return inside;
}

} // namespace

Selection find_in_lasso(const Column& x, const Column& y, const ScatterFrame& frame,
                        std::span<const glm::dvec2> polygon) {
    Selection selection;
    for (std::uint32_t id = 0; id < std::min(x.values.size(), y.values.size()); ++id)
        if (std::isfinite(x.values[id]) && std::isfinite(y.values[id]) &&
            is_inside(frame.to_pixel(x.values[id], y.values[id]), polygon))
            selection.push_back(id);
    return selection;
}

} // namespace photonloupe::inspect
