// SPDX-License-Identifier: Apache-2.0
// A curve per photon through its points on the axes: monotone cubics, one a gap between two axes, so that no curve
// swings beyond the values it joins ([SJL15] section 4.4).
#pragma once

#include <array>

#include "inspect/parallel_axes.h"

namespace photonloupe::inspect {

// Curves in the order of their photons; with a axes there are a - 1 gaps.
struct Curves {
    Selection photons;
    std::size_t axis_count = 0;
    std::vector<glm::vec2> points;   // by curve and axis, pixels; NaN: the photon has no value there
    std::vector<glm::vec2> tangents; // by curve and gap: dy/dx at its two ends; NaN: it has no curve there
    std::size_t broken_count = 0;    // photons that lack a value on an axis

    std::size_t count() const { return photons.size(); }
    std::size_t gap_count() const { return axis_count > 1 ? axis_count - 1 : 0; }
};

// Photons by id, ascending. `tension` 1 gives Fritsch and Butland's tangents (1984), 0 straight lines, between them
// blends.
Curves build_curves(std::span<const Column> columns, std::span<const Axis> axes, const AxisLayout& layout,
                    Selection photons, float tension = 1);

// Control points of one curve's cubic in a gap; NaN where it has none.
std::array<glm::vec2, 4> find_bezier(const Curves& curves, std::size_t curve, std::size_t gap);

} // namespace photonloupe::inspect
