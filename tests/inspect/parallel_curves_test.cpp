// SPDX-License-Identifier: Apache-2.0
// Curves: monotone between axes, straight without tension, broken where a value is missing.
#include "inspect/parallel_curves.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "inspect/made_columns.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

// Pixels: rounding of single precision on an image of some hundred.
constexpr float ROUNDING = 1e-3f;
constexpr std::size_t COUNT = 300;

struct Plot {
    std::vector<Column> columns = make_columns(5, COUNT);
    std::vector<Axis> axes = make_axes(columns);
    AxisLayout layout;
    Curves curves;

    explicit Plot(float tension = 1, bool has_closed = false) {
        axes[2].is_closed = axes[3].is_closed = has_closed;
        layout = place_axes(axes, 700, 300);
        curves = build_curves(columns, axes, layout, inspect::select_all(COUNT), tension);
    }
    glm::vec2 point(std::size_t i, std::size_t axis) const { return curves.points[i * axes.size() + axis]; }
};

template <class Check>
void for_each_gap(const Plot& plot, const Check& check) {
    for (std::size_t i = 0; i < plot.curves.count(); ++i)
        for (std::size_t gap = 0; gap < plot.curves.gap_count(); ++gap)
            check(i, gap);
}

TEST(ParallelCurves, never_swing_beyond_the_values_they_join) {
    for (float tension : {1.0f, 0.6f})
        for (bool has_closed : {false, true}) {
            const Plot plot(tension, has_closed);
            for_each_gap(plot, [&](std::size_t i, std::size_t gap) {
                const glm::vec2 from = plot.point(i, gap), to = plot.point(i, gap + 1);
                float before = from.y;
                for (int step = 1; step <= 50; ++step) {
                    const float x = from.x + (to.x - from.x) * float(step) / 50;
                    const float y = find_height(plot.curves, i, gap, x);
                    ASSERT_GE((y - before) * (to.y > from.y ? 1 : -1), -ROUNDING) << "curve " << i << " gap " << gap;
                    before = y;
                }
            });
        }
}

TEST(ParallelCurves, pass_through_their_points_without_a_kink) {
    const Plot plot;
    for_each_gap(plot, [&](std::size_t i, std::size_t gap) {
        EXPECT_NEAR(find_height(plot.curves, i, gap, plot.point(i, gap).x), plot.point(i, gap).y, ROUNDING);
        if (gap > 0) {
            EXPECT_EQ(plot.curves.tangents[i * 4 + gap - 1].y, plot.curves.tangents[i * 4 + gap].x);
        }
    });
}

TEST(ParallelCurves, are_level_at_an_extreme) {
    const std::vector<Column> columns{make_column({0}), make_column({1}), make_column({0.2f})};
    const std::vector<Axis> axes = make_axes(columns);
    const Curves curves = build_curves(columns, axes, place_axes(axes, 500, 300), {0});
    EXPECT_EQ(curves.tangents[0].y, 0);
    EXPECT_EQ(curves.tangents[1].x, 0);
    EXPECT_LT(curves.tangents[0].x, 0) << "rises on the screen";
}

TEST(ParallelCurves, without_tension_are_straight_lines) {
    const Plot plot(0, true);
    for_each_gap(plot, [&](std::size_t i, std::size_t gap) {
        const glm::vec2 from = plot.point(i, gap), to = plot.point(i, gap + 1);
        const float x = from.x + 0.3f * (to.x - from.x);
        EXPECT_NEAR(find_height(plot.curves, i, gap, x), from.y + 0.3f * (to.y - from.y), ROUNDING);
    });
}

TEST(ParallelCurves, tension_blends_between_straight_and_smooth) {
    const Plot straight(0), half(0.5f), smooth(1);
    float largest = 0;
    for_each_gap(half, [&](std::size_t i, std::size_t gap) {
        for (int end = 0; end < 2; ++end) {
            const auto tangent = [&](const Plot& plot) { return plot.curves.tangents[i * 4 + gap][std::size_t(end)]; };
            EXPECT_NEAR(tangent(half), (tangent(straight) + tangent(smooth)) / 2, ROUNDING);
            largest = std::max(largest, std::abs(tangent(straight) - tangent(smooth)));
        }
    });
    EXPECT_GT(largest, 0.1f);
}

TEST(ParallelCurves, break_where_a_value_is_missing) {
    std::vector<Column> columns = make_columns(5, 3);
    columns[2].values[1] = NAN;
    columns[0].values[2] = INFINITY;
    const std::vector<Axis> axes = make_axes(columns);
    const Curves curves = build_curves(columns, axes, place_axes(axes, 700, 300), inspect::select_all(3));
    EXPECT_EQ(curves.broken_count, 2u);
    std::vector<bool> has_curve;
    for (glm::vec2 tangent : curves.tangents)
        has_curve.push_back(!std::isnan(tangent.x) && !std::isnan(tangent.y));
    EXPECT_EQ(has_curve, (std::vector<bool>{1, 1, 1, 1, 1, 0, 0, 1, 0, 1, 1, 1}));
}

TEST(ParallelCurves, bezier_handles_stand_a_third_into_the_gap) {
    const Plot plot(1, true);
    const auto [from, from_handle, to_handle, to] = find_bezier(plot.curves, 7, 2);
    EXPECT_EQ(from, plot.point(7, 2));
    EXPECT_EQ(to, plot.point(7, 3));
    EXPECT_NEAR(from_handle.x, from.x + (to.x - from.x) / 3, ROUNDING);
    EXPECT_NEAR((to.y - to_handle.y) / (to.x - to_handle.x), plot.curves.tangents[7 * 4 + 2].y, ROUNDING);
}

TEST(ParallelCurves, many_are_the_same_as_few) {
    const std::size_t many = 20000;
    const std::vector<Column> columns = make_columns(4, many);
    const std::vector<Axis> axes = make_axes(columns);
    const AxisLayout layout = place_axes(axes, 700, 300);
    const Curves all = build_curves(columns, axes, layout, inspect::select_all(many));
    const Curves one = build_curves(columns, axes, layout, {17321});
    for (std::size_t gap = 0; gap < 3; ++gap)
        EXPECT_EQ(all.tangents[17321 * 3 + gap], one.tangents[gap]);
}

} // namespace
} // namespace photonloupe::test
