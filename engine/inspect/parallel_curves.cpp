// SPDX-License-Identifier: Apache-2.0
// Points and tangents of the curves.
#include "inspect/parallel_curves.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/split_work.h"

namespace photonloupe::inspect {
namespace {

// Curves below which another thread costs more than it saves.
constexpr std::size_t LEAST_PART = 4096;

// Weighted harmonic mean of the two slopes, 0 at an extreme: Fritsch and Butland 1984, within Fritsch and Carlson's
// bounds (1980) for a monotone cubic.
float find_inner_tangent(float before, float after, float width_before, float width_after) {
    if (!(before * after > 0))
        return 0;
    const float weight_before = width_before + 2 * width_after;
    const float weight_after = 2 * width_before + width_after;
    return (weight_before + weight_after) / (weight_before / before + weight_after / after);
}

// Where a run of points ends the curve does not bend; at most 1.5 times the slope, so monotone too.
float find_end_tangent(float slope, float inner) {
    return (3 * slope - inner) / 2;
}

// Exactly `smooth` at tension 1: there are no kinks then.
float blend(float straight, float smooth, float tension) {
    return (1 - tension) * straight + tension * smooth;
}

// What `build_curves` works on for one photon, over the gaps of a run without missing values.
struct Run {
    std::span<const glm::vec2> points;
    std::span<glm::vec2> tangents;
    float tension;

    float width(std::size_t gap) const { return points[gap + 1].x - points[gap].x; }
    float slope(std::size_t gap) const { return (points[gap + 1].y - points[gap].y) / width(gap); }
};

void set_tangents(const Run& run) {
    const std::size_t gap_count = run.tangents.size();
    for (std::size_t gap = 0; gap < gap_count; ++gap)
        run.tangents[gap] = glm::vec2(run.slope(gap));
    if (gap_count < 2 || run.tension == 0)
        return;
    float before = run.tangents[0].x;
    for (std::size_t gap = 1; gap < gap_count; ++gap) {
        const float after = run.tangents[gap].x;
        const float inner = find_inner_tangent(before, after, run.width(gap - 1), run.width(gap));
        run.tangents[gap - 1].y = blend(before, inner, run.tension);
        run.tangents[gap].x = blend(after, inner, run.tension);
        before = after;
    }
    run.tangents.front().x = find_end_tangent(run.slope(0), run.tangents.front().y);
    run.tangents.back().y = find_end_tangent(run.slope(gap_count - 1), run.tangents.back().x);
}

void set_tangents_between_gaps(std::span<const glm::vec2> points, std::span<glm::vec2> tangents, float tension) {
    for (std::size_t first = 0; first < points.size();) {
        std::size_t end = first;
        while (end < points.size() && !std::isnan(points[end].x))
            ++end;
        if (end > first + 1)
            set_tangents({points.subspan(first, end - first), tangents.subspan(first, end - first - 1), tension});
        first = std::max(end, first + 1);
    }
}

} // namespace

Curves build_curves(std::span<const Column> columns, std::span<const Axis> axes, const AxisLayout& layout,
                    Selection photons, float tension) {
    Curves curves{std::move(photons), axes.size(), {}, {}, 0};
    const std::size_t gap_count = curves.gap_count();
    curves.points.resize(curves.count() * axes.size());
    curves.tangents.assign(curves.count() * gap_count, glm::vec2(NAN));
    std::atomic<std::size_t> broken_count = 0;
    split_work(curves.count(), LEAST_PART, [&](std::size_t first, std::size_t end) {
        std::size_t broken = 0;
        for (std::size_t i = first; i < end; ++i) {
            const std::span points(&curves.points[i * axes.size()], axes.size());
            for (std::size_t a = 0; a < axes.size(); ++a)
                points[a] =
                    find_value_point(axes[a], layout.places[a], columns[axes[a].column].values[curves.photons[i]]);
            broken += std::any_of(points.begin(), points.end(), [](glm::vec2 p) { return std::isnan(p.x); });
            if (gap_count > 0)
                set_tangents_between_gaps(points, {&curves.tangents[i * gap_count], gap_count}, tension);
        }
        broken_count += broken;
    });
    curves.broken_count = broken_count;
    return curves;
}

std::array<glm::vec2, 4> find_bezier(const Curves& curves, std::size_t curve, std::size_t gap) {
    const glm::vec2 tangents = curves.tangents[curve * curves.gap_count() + gap];
    const glm::vec2 from = curves.points[curve * curves.axis_count + gap];
    const glm::vec2 to = curves.points[curve * curves.axis_count + gap + 1];
    const float third = (to.x - from.x) / 3;
    return {from, from + third * glm::vec2(1, tangents.x), to - third * glm::vec2(1, tangents.y), to};
}

} // namespace photonloupe::inspect
