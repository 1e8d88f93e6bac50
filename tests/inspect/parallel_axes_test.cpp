// SPDX-License-Identifier: Apache-2.0
// Axes: from values to points and back, layout, ordering.
#include "inspect/parallel_axes.h"

#include <cmath>

#include <glm/geometric.hpp>

#include <gtest/gtest.h>

#include "core/error.h"
#include "inspect/made_columns.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

const AxisPlace LINE{{100, 150}, 0, 100};
const AxisPlace ELLIPSE{{100, 150}, 25, 100};
// A pixel is 1/200 of these axes; a round trip loses a few roundings of it.
constexpr float ROUNDING = 1e-4f;

Axis make_open(float low, float high) {
    return {.low = low, .high = high};
}

Axis make_closed(float low, float high, std::uint32_t periods = 1) {
    return {.low = low, .high = high, .is_closed = true, .periods = periods};
}

TEST(ParallelAxes, open_axis_runs_upwards_from_low_to_high) {
    const Axis axis = make_open(-2, 6);
    EXPECT_EQ(find_value_point(axis, LINE, -2), glm::vec2(100, 250));
    EXPECT_EQ(find_value_point(axis, LINE, 6), glm::vec2(100, 50));
    EXPECT_EQ(find_value_point(axis, LINE, 0), glm::vec2(100, 200));
}

TEST(ParallelAxes, closed_axis_runs_counterclockwise_from_its_lowest_point) {
    const Axis axis = make_closed(0, 4);
    const glm::vec2 expected[] = {{100, 250}, {125, 150}, {100, 50}, {75, 150}};
    for (int quarter = 0; quarter < 4; ++quarter)
        EXPECT_LT(glm::distance(find_value_point(axis, ELLIPSE, float(quarter)), expected[quarter]), ROUNDING)
            << quarter;
}

TEST(ParallelAxes, ends_of_a_closed_axis_are_one_point) {
    for (std::uint32_t periods : {1u, 2u, 7u})
        for (bool is_flipped : {false, true}) {
            Axis axis = make_closed(-3, 0.7f, periods);
            axis.is_flipped = is_flipped;
            EXPECT_EQ(find_value_point(axis, ELLIPSE, -3), find_value_point(axis, ELLIPSE, 0.7f)) << periods;
        }
}

TEST(ParallelAxes, range_winds_round_the_ellipse_as_often_as_it_has_periods) {
    const Axis axis = make_closed(0, 6, 3);
    EXPECT_LT(glm::distance(find_value_point(axis, ELLIPSE, 0.5f), find_value_point(axis, ELLIPSE, 4.5f)), ROUNDING);
    EXPECT_LT(glm::distance(find_value_point(axis, ELLIPSE, 1), glm::vec2(100, 50)), ROUNDING);
    // Points three times as far apart along the ellipse.
    EXPECT_NEAR(find_share(axis, 0.5f) - find_share(axis, 0.25f), 3 * 0.25 / 6, 1e-12);
}

TEST(ParallelAxes, flipped_axis_mirrors_it) {
    Axis open = make_open(0, 1), closed = make_closed(0, 1);
    open.is_flipped = closed.is_flipped = true;
    EXPECT_EQ(find_value_point(open, LINE, 0), glm::vec2(100, 50));
    EXPECT_LT(glm::distance(find_value_point(closed, ELLIPSE, 0.25f), glm::vec2(75, 150)), ROUNDING);
}

TEST(ParallelAxes, value_to_point_and_back_is_the_value) {
    for (bool is_flipped : {false, true})
        for (int i = 1; i < 20; ++i) {
            const float value = -2 + 8 * float(i) / 20;
            Axis open = make_open(-2, 6), closed = make_closed(-2, 6), wound = make_closed(-2, 6, 4);
            open.is_flipped = closed.is_flipped = wound.is_flipped = is_flipped;
            EXPECT_NEAR(find_value(open, LINE, find_value_point(open, LINE, value)), value, ROUNDING);
            EXPECT_NEAR(find_value(closed, ELLIPSE, find_value_point(closed, ELLIPSE, value)), value, ROUNDING);
            EXPECT_NEAR(find_value(wound, ELLIPSE, find_value_point(wound, ELLIPSE, value), value + 0.3f), value,
                        ROUNDING);
        }
}

TEST(ParallelAxes, pixel_beside_an_axis_has_the_value_of_its_height_or_angle) {
    EXPECT_EQ(find_value(make_open(0, 1), LINE, {140, 100}), 0.75f);
    EXPECT_EQ(find_value(make_open(0, 1), LINE, {100, 900}), 0.0f);
    EXPECT_NEAR(find_value(make_closed(0, 1), ELLIPSE, {300, 150}), 0.25f, ROUNDING);
}

TEST(ParallelAxes, values_without_a_place_have_no_point) {
    for (float value : {NAN, INFINITY, -INFINITY}) {
        EXPECT_TRUE(std::isnan(find_value_point(make_open(0, 1), LINE, value).x));
        EXPECT_TRUE(std::isnan(find_value_point(make_closed(0, 1), ELLIPSE, value).y));
    }
}

TEST(ParallelAxes, values_far_beyond_the_ends_keep_finite_points) {
    EXPECT_EQ(find_value_point(make_open(0, 1), LINE, 1e30f).y, 50 - 8 * 200);
    EXPECT_EQ(find_value_point(make_open(0, 1), LINE, -1e30f).y, 250 + 8 * 200);
    EXPECT_TRUE(std::isfinite(find_value_point(make_open(-3e38f, 3e38f), LINE, 2e38f).y));
    const glm::vec2 point = find_value_point(make_closed(0, 1e-30f), ELLIPSE, 1e30f);
    EXPECT_LE(std::abs(point.x - 100), 25);
    EXPECT_LE(std::abs(point.y - 150), 100);
    EXPECT_EQ(find_share(make_closed(0, 1), -1e-30f), 0) << "not 1, by rounding";
}

TEST(ParallelAxes, axis_without_extent_shows_its_value_half_way) {
    EXPECT_EQ(find_value_point(make_open(5, 5), LINE, 5), glm::vec2(100, 150));
    EXPECT_EQ(find_value(make_open(5, 5), LINE, {100, 60}), 5);
    EXPECT_EQ(find_value(make_closed(5, 5), ELLIPSE, {100, 60}, 5.0f), 5);
}

TEST(ParallelAxes, axes_stand_evenly_on_borders_between_pixels) {
    std::vector<Axis> axes(4);
    axes[2].is_closed = true;
    const AxisLayout layout = place_axes(axes, 700, 300, {50, 50, 30, 20});
    for (std::size_t i = 0; i < 4; ++i)
        EXPECT_EQ(layout.places[i].center, glm::vec2(50 + 200 * i, 155));
    EXPECT_EQ(layout.places[0].rx, 0);
    EXPECT_GT(layout.places[2].rx, 20);
    EXPECT_EQ(layout.places[2].ry, 125);
}

TEST(ParallelAxes, single_axis_stands_in_the_middle) {
    EXPECT_EQ(place_axes(std::vector<Axis>(1), 400, 300, {50, 50, 50, 50}).places[0].center, glm::vec2(200, 150));
}

TEST(ParallelAxes, image_without_room_is_refused) {
    EXPECT_THROW(place_axes(std::vector<Axis>(3), 90, 300, {40, 40, 10, 10}), Error);
    EXPECT_THROW(place_axes(std::vector<Axis>(3), 900, 60, {40, 40, 30, 30}), Error);
}

TEST(ParallelAxes, nearest_axis_within_reach_is_found) {
    std::vector<Axis> axes(3);
    axes[1].is_closed = true;
    const AxisLayout layout = place_axes(axes, 500, 300, {50, 50, 50, 50});
    EXPECT_EQ(find_axis(layout, {56, 100}, 8), 0u);
    EXPECT_EQ(find_axis(layout, {50 + 9, 100}, 8), std::nullopt);
    const float rx = layout.places[1].rx;
    EXPECT_EQ(find_axis(layout, {250 + rx + 3, 150}, 8), 1u);
    EXPECT_EQ(find_axis(layout, {250, 150}, 8), std::nullopt) << "the middle of the ellipse";
    EXPECT_NEAR(find_distance(layout.places[1], {250 + rx + 3, 150}), 3, 0.3);
}

TEST(ParallelAxes, column_that_repeats_makes_a_closed_axis_over_one_period) {
    Column angle = make_column({0.5f}, 0.5f, 0.5f);
    angle.period = 6;
    const Axis axis = make_axis(std::vector{angle}, 0);
    EXPECT_TRUE(axis.is_closed);
    EXPECT_EQ(axis.high - axis.low, 6);
}

TEST(ParallelAxes, axes_that_make_no_sense_are_refused_by_name) {
    const std::vector<Column> columns{make_column({0})};
    const auto expect_refused = [&](const Axis& axis, const char* reason) {
        try {
            check_axes(columns, std::vector{axis});
            FAIL() << reason;
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << error.what();
        }
    };
    expect_refused({.column = 3}, "column 3");
    expect_refused({.low = 0, .high = INFINITY}, "limit");
    expect_refused({.low = 1, .high = 0}, "from high to low");
    expect_refused({.periods = 0}, "0 periods");
    expect_refused({.brushes = {{0, NAN}}}, "brush");
    EXPECT_NO_THROW(check_axes(columns, std::vector{make_closed(0, 1, 3)}));
}

Selection select(const Axis& axis, std::vector<float> values, const Selection& within = {}) {
    return select_brushed(std::vector{axis}, std::vector{make_column(std::move(values))}, within);
}

TEST(ParallelBrushes, intervals_of_an_axis_are_ored_and_include_their_ends) {
    Axis axis = make_open(0, 10);
    axis.brushes = {{1, 2}, {5, 6}};
    EXPECT_EQ(select(axis, {0, 1, 2, 3, 5, 5.5f, 7, NAN}), (Selection{1, 2, 4, 5}));
}

TEST(ParallelBrushes, axes_are_anded) {
    const std::vector<Column> columns{make_column({0, 1, 0, 1}), make_column({0, 0, 1, 1})};
    std::vector<Axis> axes = make_axes(columns);
    axes[0].brushes = {{0.5f, 1}};
    axes[1].brushes = {{0, 0.5f}};
    EXPECT_EQ(select_brushed(axes, columns, {}), (Selection{1}));
}

TEST(ParallelBrushes, interval_on_a_closed_axis_goes_on_through_the_ends) {
    Axis axis = make_closed(0, 360);
    axis.brushes = {{350, 10}};
    EXPECT_EQ(select(axis, {0, 5, 10, 11, 349, 350, 360, -5, 365}), (Selection{0, 1, 2, 5, 6, 7, 8}));
    axis.is_closed = false;
    EXPECT_EQ(select(axis, {0, 5, 355}), Selection{}) << "an open axis does not";
}

TEST(ParallelBrushes, interval_on_a_wound_axis_selects_in_every_turn) {
    Axis axis = make_closed(0, 6, 3);
    axis.brushes = {{0.5f, 1}};
    EXPECT_EQ(select(axis, {0.75f, 2.75f, 4.75f, 1.5f, 0.25f}), (Selection{0, 1, 2}));
    axis.brushes = {{0, 2}};
    EXPECT_EQ(select(axis, {0.75f, 1.9f, NAN}), (Selection{0, 1})) << "a whole turn";
}

TEST(ParallelBrushes, nothing_brushed_selects_all_that_is_asked_about) {
    const Axis axis = make_open(0, 1);
    EXPECT_EQ(select(axis, {0, NAN, 1}), (Selection{0, 1, 2}));
    EXPECT_EQ(select(axis, {0, NAN, 1}, {0, 2}), (Selection{0, 2}));
}

TEST(ParallelBrushes, outline_lies_along_its_interval) {
    Axis axis = make_open(0, 1);
    const std::vector<glm::vec2> outline = outline_brush(axis, LINE, {0.25f, 0.5f}, 4);
    for (glm::vec2 point : outline) {
        EXPECT_EQ(std::abs(point.x - 100), 4);
        EXPECT_GE(point.y, 150 - ROUNDING);
        EXPECT_LE(point.y, 200 + ROUNDING);
    }
    EXPECT_FALSE(outline.empty());
    EXPECT_TRUE(outline_brush(axis, LINE, {2, 3}, 4).empty());
}

} // namespace
} // namespace photonloupe::test
