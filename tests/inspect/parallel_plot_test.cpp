// SPDX-License-Identifier: Apache-2.0
// Drawn curves against naive twins: counts pixel by pixel, areas by sampling.
#include "inspect/parallel_plot.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "inspect/made_columns.h"
#include "inspect/parallel_columns.h"
#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

struct Plot {
    std::vector<Column> columns;
    std::vector<Axis> axes;
    AxisLayout layout;
    Curves curves;
};

// Axes 1 and 2 are closed; photons 3 and 5 lack values, 7 lies far beyond an end.
Plot make_plot(std::size_t count, std::uint32_t width = 300, std::uint32_t height = 120) {
    Plot plot{make_columns(4, count), {}, {}, {}};
    if (count > 7) {
        plot.columns[2].values[3] = NAN;
        plot.columns[0].values[5] = INFINITY;
        plot.columns[3].values[7] = 1e30f;
    }
    plot.axes = make_axes(plot.columns);
    plot.axes[1].is_closed = plot.axes[2].is_closed = true;
    plot.axes[0].high = 0.8f; // some curves leave the axis, others the image
    plot.layout = place_axes(plot.axes, width, height, {20, 20, 10, 10});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, list_ids(count));
    return plot;
}

using Counts = std::vector<std::uint32_t>;

// One curve, one column of pixels at a time.
Counts count_naively(const Plot& plot) {
    Counts counts(std::size_t{plot.layout.width} * plot.layout.height);
    const Polynomials fitted = fit_polynomials(plot.curves, plot.layout);
    const std::vector<GapColumns> gaps = find_gap_columns(plot.layout);
    for (std::size_t at = 0; at < fitted.coefficients.size(); ++at) {
        const glm::vec4 c = fitted.coefficients[at], extent = fitted.extents[at];
        const GapColumns& gap = gaps[at / plot.curves.count()];
        for (std::int32_t column = gap.first; column < gap.end; ++column) {
            const float u = static_cast<float>(column - gap.first);
            const float from = std::max(u, extent.x), to = std::min(u + 1, extent.y);
            if (!(from <= to) || extent.x >= u + 1 || extent.y <= u)
                continue;
            const auto find_row = [&](float x) {
                return static_cast<std::int64_t>(std::floor(((c.x * x + c.y) * x + c.z) * x + c.w)) - 1;
            };
            const bool rises = std::bit_cast<std::uint32_t>(c.x) & 1u;
            const std::int64_t first = find_row(rises ? to : from), last = find_row(rises ? from : to);
            for (std::int64_t row = std::max<std::int64_t>(first, 0);
                 row <= std::min<std::int64_t>(last, plot.layout.height - 1); ++row)
                ++counts[static_cast<std::size_t>(row) * plot.layout.width + static_cast<std::size_t>(column)];
        }
    }
    return counts;
}

Counts count_on_device(const Plot& plot, std::size_t set = 1, const CountSplit& split = {}) {
    const Curves none;
    const Coverage coverage =
        count_coverage(get_device(), plot.layout, set == 0 ? plot.curves : none, set == 1 ? plot.curves : none, split);
    const std::size_t pixel_count = std::size_t{plot.layout.width} * plot.layout.height;
    const auto both = coverage.counts.read<glm::uvec2>(pixel_count);
    const auto largest = coverage.largest.read<std::uint32_t>(2);
    Counts counts;
    for (const glm::uvec2& pixel : both)
        counts.push_back(pixel[set]);
    EXPECT_EQ(largest[set], counts.empty() ? 0 : *std::max_element(counts.begin(), counts.end()));
    EXPECT_EQ(largest[1 - set], 0u);
    return counts;
}

TEST(ParallelPlot, counts_are_the_naive_ones) {
    for (std::size_t count : {1u, 2u, 300u, 3000u}) {
        const Plot plot = make_plot(count);
        const Counts expected = count_naively(plot);
        EXPECT_GT(*std::max_element(expected.begin(), expected.end()), 0u);
        EXPECT_EQ(count_on_device(plot), expected) << count;
        EXPECT_EQ(count_on_device(plot, 0), expected) << count << " as context";
    }
}

TEST(ParallelPlot, counts_of_straight_lines_are_the_naive_ones) {
    Plot plot = make_plot(500);
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, list_ids(500), 0);
    EXPECT_EQ(count_on_device(plot), count_naively(plot));
}

TEST(ParallelPlot, counts_do_not_depend_on_how_they_are_cut) {
    const Plot plot = make_plot(3000);
    const Counts expected = count_on_device(plot);
    for (const CountSplit& split : {CountSplit{1000, 1}, CountSplit{77, 1}, CountSplit{100, 7}, CountSplit{65535, 3}})
        EXPECT_EQ(count_on_device(plot, 1, split), expected) << split.part_size << " x " << split.part_count;
}

TEST(ParallelPlot, image_higher_than_a_band_is_counted_whole) {
    const Plot plot = make_plot(60, 80, shared::LARGEST_BAND + 300);
    const Counts counts = count_on_device(plot);
    EXPECT_EQ(counts, count_naively(plot));
    EXPECT_TRUE(std::any_of(counts.end() - 300 * 80, counts.end(), [](std::uint32_t count) { return count > 0; }));
}

TEST(ParallelPlot, more_curves_than_a_part_holds_do_not_overflow) {
    const std::size_t count = shared::LARGEST_PART + 10;
    Plot plot{{make_column(std::vector<float>(count, 0.5f)), make_column(std::vector<float>(count, 0.5f))}, {}, {}, {}};
    plot.axes = make_axes(plot.columns);
    plot.layout = place_axes(plot.axes, 64, 40, {10, 10, 5, 5});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, list_ids(count));
    const Counts counts = count_on_device(plot, 1, {1u << 20, 1});
    EXPECT_EQ(std::count(counts.begin(), counts.end(), count), 44) << "one row of the gap's columns";
    EXPECT_EQ(std::count(counts.begin(), counts.end(), 0u), 64 * 40 - 44);
}

TEST(ParallelPlot, every_curve_covers_every_column_without_holes) {
    Plot plot = make_plot(1);
    plot.columns = {make_column({0}), make_column({1}), make_column({0}), make_column({1})};
    plot.axes = make_axes(plot.columns);
    plot.layout = place_axes(plot.axes, 60, 500, {10, 10, 10, 10});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, {0});
    const Counts counts = count_on_device(plot);
    for (std::uint32_t row = 11; row < 489; ++row) {
        const auto first = counts.begin() + row * 60;
        EXPECT_GE(std::accumulate(first, first + 60, 0u), 3u) << row;
    }
}

std::vector<std::uint8_t> draw(const Plot& plot, const CurveStyle& style = {}, const Curves& context = {}) {
    return read_pixels(draw_curves(get_device(), plot.layout, context, plot.curves, {}, style));
}

TEST(ParallelPlot, same_bits_in_two_runs) {
    for (std::size_t count : {2000u, 2001u}) {
        const Plot plot = make_plot(count);
        EXPECT_EQ(draw(plot), draw(plot));
    }
}

TEST(ParallelPlot, beyond_the_most_curves_a_density_is_drawn) {
    for (std::size_t count : {2000u, 2001u}) {
        const Plot plot = make_plot(count);
        const CurveImage image = draw_curves(get_device(), plot.layout, {}, plot.curves);
        EXPECT_EQ(image.is_density, count == 2001);
        const Counts counts = count_naively(plot);
        EXPECT_EQ(image.largest_selected, count == 2001 ? *std::max_element(counts.begin(), counts.end()) : 0);
    }
}

TEST(ParallelPlot, without_curves_or_gaps_the_background_stays) {
    const std::vector<std::uint8_t> blue{0, 0, 128, 255};
    const CurveStyle style{.background = {0, 0, 0.502f, 1}};
    Plot single{make_columns(1, 50), {}, {}, {}};
    single.axes = make_axes(single.columns);
    single.layout = place_axes(single.axes, 300, 120);
    single.curves = build_curves(single.columns, single.axes, single.layout, list_ids(50));
    for (const Plot& plot : {make_plot(0), single})
        for (std::uint32_t most : {2000u, 0u}) {
            CurveStyle asked = style;
            asked.most_curves = most;
            const std::vector<std::uint8_t> pixels = draw(plot, asked);
            for (std::size_t i = 0; i < pixels.size(); ++i)
                ASSERT_EQ(pixels[i], blue[i % 4]) << i;
        }
}

// Share of a pixel within half a line's width of the curve, by sampling its middle points.
double sample_area(const Plot& plot, std::size_t gap, double x, double y, double half_width) {
    constexpr int SIDE = 16;
    int inside = 0;
    for (int i = 0; i < SIDE * SIDE; ++i) {
        const double px = x + (i % SIDE + 0.5) / SIDE, py = y + (i / SIDE + 0.5) / SIDE;
        const auto height = [&](double at) { return double(find_height(plot.curves, 0, gap, float(at))); };
        const double slope = (height(px + 0.5) - height(px - 0.5));
        inside += std::abs(py - height(px)) <= half_width * std::sqrt(1 + slope * slope);
    }
    return double(inside) / (SIDE * SIDE);
}

TEST(ParallelPlot, curve_has_in_each_pixel_the_area_it_covers) {
    Plot plot{{make_column({0.1f}), make_column({0.9f}), make_column({0.85f}), make_column({0.2f})}, {}, {}, {}};
    plot.axes = make_axes(plot.columns);
    plot.layout = place_axes(plot.axes, 320, 200, {10, 10, 10, 10});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, {0});
    const CurveStyle style{.background = {0, 0, 0, 1}, .selected_color = {1, 1, 1}, .opacity = 1, .line_width = 1.5f};
    const std::vector<std::uint8_t> pixels = draw(plot, style);
    double worst = 0, total = 0;
    for (std::uint32_t column = 12; column < 308; ++column)
        for (std::uint32_t row = 0; row < 200; ++row) {
            const std::size_t gap = (column - 10) / 100;
            const double expected =
                (column - 10) % 100 < 2 || (column - 10) % 100 > 97 ? -1 : sample_area(plot, gap, column, row, 0.75);
            if (expected < 0)
                continue;
            worst = std::max(worst, std::abs(expected - pixels[4 * (row * 320 + column)] / 255.0));
            total += expected;
        }
    EXPECT_GT(total, 300);
    EXPECT_LT(worst, 0.07) << "sampling and the strip's straightness";
}

TEST(ParallelPlot, later_curves_lie_over_earlier_ones_and_the_selection_over_the_context) {
    Plot plot{{make_column({0.5f, 0.5f}), make_column({0.5f, 0.5f})}, {}, {}, {}};
    plot.axes = make_axes(plot.columns);
    plot.layout = place_axes(plot.axes, 100, 60, {10, 10, 10, 10});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, {0, 1});
    const CurveStyle style{.opacity = 1, .context_opacity = 1, .line_width = 4};
    const std::vector<glm::vec3> colors{{1, 0, 0}, {0, 1, 0}};
    const Curves context = build_curves(plot.columns, plot.axes, plot.layout, {1});
    const auto pixels = read_pixels(draw_curves(get_device(), plot.layout, context, plot.curves, colors, style));
    const std::size_t middle = 4 * (30 * 100 + 50);
    EXPECT_EQ(std::vector<std::uint8_t>(&pixels[middle], &pixels[middle] + 4),
              (std::vector<std::uint8_t>{0, 255, 0, 255}));
}

TEST(ParallelPlot, clear_background_gives_premultiplied_pixels) {
    const Plot plot = make_plot(40);
    const std::vector<std::uint8_t> pixels = draw(plot, {.background = {0, 0, 0, 0}});
    int covered = 0;
    for (std::size_t i = 0; i < pixels.size(); i += 4) {
        covered += pixels[i + 3] > 0;
        EXPECT_LE(std::max({pixels[i], pixels[i + 1], pixels[i + 2]}), pixels[i + 3]);
    }
    EXPECT_GT(covered, 1000);
}

TEST(ParallelPlot, equal_values_are_one_line) {
    Plot plot{{make_column(std::vector<float>(2500, 0.4f), 0.4f, 0.4f), make_column(std::vector<float>(2500, 0.7f))},
              {},
              {},
              {}};
    plot.axes = make_axes(plot.columns);
    plot.layout = place_axes(plot.axes, 100, 60, {10, 10, 10, 10});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, list_ids(2500));
    const Counts counts = count_on_device(plot);
    EXPECT_EQ(counts, count_naively(plot));
    for (std::uint32_t count : counts)
        EXPECT_TRUE(count == 0 || count == 2500) << count;
}

} // namespace
} // namespace photonloupe::test
