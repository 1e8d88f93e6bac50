// SPDX-License-Identifier: Apache-2.0
// Densities along axes against the sum of kernels itself.
#include "inspect/parallel_density.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include <gtest/gtest.h>

#include "inspect/made_columns.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

// Of the peak: what binning and cutting kernels off at five deviations cost.
constexpr double BINNING = 1e-3;

std::vector<float> draw_values(std::size_t count, float middle, float spread, std::uint32_t seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<float> normal(middle, spread);
    std::vector<float> values(count);
    std::generate(values.begin(), values.end(), [&] { return normal(random); });
    return values;
}

AxisDensity estimate(const Column& column, const Axis& axis) {
    return estimate_density(column, axis, inspect::select_all(column.values.size()));
}

// Every kernel at every place, and its copies a turn to either side.
void expect_kernel_sum(const Column& column, const Axis& axis, double turn) {
    const AxisDensity density = estimate(column, axis);
    ASSERT_EQ(density.shares.size(), DENSITY_SAMPLES);
    for (std::size_t i = 0; i < density.shares.size(); i += 8) {
        const double place = axis.low + (double(axis.high) - axis.low) / axis.periods * density.shares[i];
        double sum = 0;
        for (float value : column.values)
            for (int copy = turn > 0 ? -120 : 0; copy <= (turn > 0 ? 120 : 0); ++copy) {
                const double offset = (place - value + copy * turn) / density.bandwidth;
                sum += std::exp(-0.5 * offset * offset);
            }
        sum /= density.bandwidth * std::sqrt(2 * std::numbers::pi) * double(column.values.size());
        EXPECT_NEAR(density.heights[i] * density.peak, sum, BINNING * density.peak) << density.shares[i];
    }
}

TEST(ParallelDensity, is_the_sum_of_kernels) {
    expect_kernel_sum(make_column(draw_values(400, 3, 1), 0, 6), {.low = 0, .high = 6}, 0);
}

TEST(ParallelDensity, of_one_value_is_its_kernel) {
    expect_kernel_sum(make_column({0.3f}), {.low = 0, .high = 1}, 0);
}

TEST(ParallelDensity, of_a_zoomed_range_counts_what_lies_beyond_it) {
    const Column column = make_column(draw_values(400, 3, 1), 0, 6);
    expect_kernel_sum(column, {.low = 2.9f, .high = 3.1f}, 0);
    expect_kernel_sum(column, {.low = 4, .high = 4.0001f}, 0);
}

TEST(ParallelDensity, wraps_on_a_closed_axis) {
    const Column column = make_column(draw_values(200, 0.3f, 1), 0, 6);
    const Axis axis{.low = 0, .high = 6, .is_closed = true};
    expect_kernel_sum(column, axis, 6);
    const AxisDensity density = estimate(column, axis);
    EXPECT_NEAR(density.heights.front(), density.heights.back(), 1e-6);
    EXPECT_GT(density.heights.front(), 0.5f);
}

TEST(ParallelDensity, of_a_wound_axis_is_over_one_turn) {
    expect_kernel_sum(make_column(draw_values(300, 3, 0.2f), 0, 6),
                      {.low = 0, .high = 6, .is_closed = true, .periods = 3}, 2);
}

TEST(ParallelDensity, of_an_axis_wound_sixty_times_is_over_one_turn) {
    expect_kernel_sum(make_column(draw_values(50, 3, 1), 0, 6), {.low = 0, .high = 6, .is_closed = true, .periods = 60},
                      0.1);
}

TEST(ParallelDensity, cluster_across_the_seam_is_as_narrow_as_elsewhere) {
    const Axis axis{.low = 0, .high = 6, .is_closed = true};
    std::vector<float> middle = draw_values(200, 3, 0.1f), seam = middle;
    for (float& value : seam)
        value += value < 3 ? 3.0f : -3.0f;
    const float expected = estimate(make_column(middle, 0, 6), {.low = 0, .high = 6}).bandwidth;
    EXPECT_NEAR(estimate(make_column(seam, 0, 6), axis).bandwidth, expected, 1e-5);
    EXPECT_NEAR(estimate(make_column(middle, 0, 6), axis).bandwidth, expected, 1e-5);
}

TEST(ParallelDensity, bandwidth_is_silvermans) {
    std::vector<float> values(101);
    std::iota(values.begin(), values.end(), 0.0f);
    const Axis axis{.low = 0, .high = 100};
    const double deviation = std::sqrt(101.0 * 102 / 12), by_n = std::pow(101.0, -0.2);
    EXPECT_NEAR(estimate(make_column(values), axis).bandwidth, 0.9 * deviation * by_n, 1e-4);
    for (int i = 0; i < 60; ++i)
        values[std::size_t(20 + i)] = 50 + 0.01f * float(i); // quartiles come close, the deviation stays
    std::vector<float> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    const double range = (double(sorted[75]) - sorted[25]) / 1.34;
    EXPECT_NEAR(estimate(make_column(values), axis).bandwidth, std::max(0.9 * range * by_n, 100.0 / 256), 1e-4);
}

TEST(ParallelDensity, equal_values_are_a_spike_that_a_sample_meets) {
    const AxisDensity density = estimate(make_column(std::vector<float>(50, 0.3f)), {.low = 0, .high = 1});
    const auto peak = std::max_element(density.heights.begin(), density.heights.end());
    EXPECT_EQ(*peak, 1);
    EXPECT_NEAR(density.shares[std::size_t(peak - density.heights.begin())], 0.3, 1.0 / 256);
    EXPECT_EQ(density.heights.front(), 0);
}

TEST(ParallelDensity, extremes_keep_heights_finite) {
    const std::vector<std::vector<float>> cases{
        {}, {1}, {NAN, NAN}, {1e30f, -1e30f, 0}, {3e38f, -3e38f}, {INFINITY, 0.5f}};
    for (const std::vector<float>& values : cases)
        for (const Axis& axis : {Axis{.low = 0, .high = 1}, Axis{.low = 0.5f, .high = 0.5f},
                                 Axis{.low = -3e38f, .high = 3e38f}, Axis{.low = 0, .high = 1, .is_closed = true}}) {
            const AxisDensity density = estimate(make_column(values), axis);
            EXPECT_EQ(density.heights.size(), density.shares.size());
            for (float height : density.heights)
                EXPECT_TRUE(height >= 0 && height <= 1) << height;
        }
}

TEST(ParallelDensity, photons_without_a_value_do_not_count) {
    Column column = make_column({0.2f, NAN, 0.3f, 0.4f});
    const AxisDensity with = estimate(column, {.low = 0, .high = 1});
    column.values = {0.2f, 0.3f, 0.4f};
    EXPECT_EQ(with.heights, estimate(column, {.low = 0, .high = 1}).heights);
}

TEST(ParallelDensity, discrete_values_have_bars) {
    Column column = make_column({2, 3, 3, 3, 5, 9, NAN}, 2, 9);
    column.is_discrete = true;
    const AxisDensity density = estimate(column, {.low = 2, .high = 6});
    EXPECT_TRUE(density.has_bars);
    EXPECT_EQ(density.shares, (std::vector<float>{0, 0.25f, 0.75f}));
    EXPECT_EQ(density.heights, (std::vector<float>{1.0f / 3, 1, 1.0f / 3}));
    EXPECT_EQ(density.peak, 3);
}

TEST(ParallelDensity, outline_is_as_deep_as_asked_at_the_peak) {
    const Column column = make_column(draw_values(100, 0.5f, 0.1f));
    const AxisPlace line{{50, 60}, 0, 40}, ellipse{{50, 60}, 10, 40};
    const Axis open{.low = 0, .high = 1}, closed{.low = 0, .high = 1, .is_closed = true};
    float deepest = 0;
    const auto beside = outline_density(open, line, estimate(column, open), 20);
    for (glm::vec2 point : beside.at(0))
        deepest = std::max(deepest, point.x - 50);
    EXPECT_NEAR(deepest, 20, 1e-4);
    float highest = 60;
    const auto around = outline_density(closed, ellipse, estimate(column, closed), 20);
    for (glm::vec2 point : around.at(0))
        highest = std::min(highest, point.y);
    EXPECT_NEAR(highest, 0, 0.2) << "out of the top, where the middle of the range lies";
}

} // namespace
} // namespace photonloupe::test
