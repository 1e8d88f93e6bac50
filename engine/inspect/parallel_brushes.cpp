// SPDX-License-Identifier: Apache-2.0
// Selects photons by the intervals brushed on the axes: or-ed on an axis, and-ed between axes.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "inspect/parallel_axes.h"

namespace photonloupe::inspect {
namespace {

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
    const double turn = (double(axis.high) - axis.low) / axis.periods;
    return std::any_of(axis.brushes.begin(), axis.brushes.end(), [&](const Interval& brush) {
        return axis.is_closed ? is_in_arc(brush, turn, value) : value >= brush.low && value <= brush.high;
    });
}

} // namespace

Selection select_brushed(std::span<const Axis> axes, std::span<const Column> columns, const Selection& within) {
    Selection chosen = within;
    if (within.empty() && !columns.empty()) {
        chosen.resize(columns[0].values.size());
        std::iota(chosen.begin(), chosen.end(), 0u);
    }
    for (const Axis& axis : axes) {
        if (axis.brushes.empty())
            continue;
        const std::vector<float>& values = columns[axis.column].values;
        std::erase_if(chosen, [&](std::uint32_t photon) { return !is_brushed(axis, values[photon]); });
    }
    return chosen;
}

} // namespace photonloupe::inspect
