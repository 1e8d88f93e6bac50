// SPDX-License-Identifier: Apache-2.0
// Drawn curves against naive twins: counts pixel by pixel, areas by sampling.
#include "inspect/parallel_plot.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "inspect/colormap.h"
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
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, inspect::select_all(count));
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
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, inspect::select_all(500), 0);
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
    const std::size_t count = 3 * std::size_t{shared::LARGEST_PART};
    Plot plot{{make_column(std::vector<float>(count, 0.5f)), make_column(std::vector<float>(count, 0.5f))}, {}, {}, {}};
    plot.axes = make_axes(plot.columns);
    plot.layout = place_axes(plot.axes, 64, 40, {10, 10, 5, 5});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, inspect::select_all(count));
    const Counts counts = count_on_device(plot, 1, {1u << 20, 1});
    EXPECT_EQ(std::count(counts.begin(), counts.end(), count), 44) << "one row of the gap's columns";
    EXPECT_EQ(std::count(counts.begin(), counts.end(), 0u), 64 * 40 - 44);
}

TEST(ParallelPlot, most_parts_of_the_highest_band_are_summed_whole) {
    const Plot plot = make_plot(900, 60, shared::LARGEST_BAND);
    EXPECT_EQ(count_on_device(plot, 1, {100, 1000}), count_naively(plot));
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
    }
}

TEST(ParallelPlot, without_curves_or_gaps_the_background_stays) {
    const std::vector<std::uint8_t> blue{0, 0, 128, 255};
    const CurveStyle style{.background = {0, 0, 0.502f, 1}};
    Plot single{make_columns(1, 50), {}, {}, {}};
    single.axes = make_axes(single.columns);
    single.layout = place_axes(single.axes, 300, 120);
    single.curves = build_curves(single.columns, single.axes, single.layout, inspect::select_all(50));
    for (const Plot& plot : {make_plot(0), single})
        for (std::uint32_t most : {2000u, 0u}) {
            CurveStyle asked = style;
            asked.most_curves = most;
            const std::vector<std::uint8_t> pixels = draw(plot, asked);
            for (std::size_t i = 0; i < pixels.size(); ++i)
                ASSERT_EQ(pixels[i], blue[i % 4]) << i;
        }
}

// Share of the pixel from `row` to `row` + 1 in a strip whose middle runs from `left` to `right` over the column.
double sample_area(double left, double right, double thickness, double row) {
    constexpr int SLICES = 400;
    double area = 0;
    for (int i = 0; i < SLICES; ++i) {
        const double middle = left + (right - left) * (i + 0.5) / SLICES;
        const double top = std::max(middle - thickness / 2, row), bottom = std::min(middle + thickness / 2, row + 1);
        area += std::max(bottom - top, 0.0) / SLICES;
    }
    return area;
}

using Canvas = std::vector<glm::dvec4>;

void blend_column(const Plot& plot, std::size_t curve, std::size_t gap, std::uint32_t column, double line_width,
                  const glm::dvec4& color, Canvas& canvas) {
    const glm::vec2 from = plot.curves.points[curve * plot.axes.size() + gap];
    const glm::vec2 to = plot.curves.points[curve * plot.axes.size() + gap + 1];
    const double first = std::max<double>(column, from.x), last = std::min<double>(column + 1, to.x);
    if (std::isnan(from.x) || std::isnan(to.x) || !(last > first))
        return;
    const double left = find_height(plot.curves, curve, gap, float(first));
    const double right = find_height(plot.curves, curve, gap, float(last));
    const double slope = (right - left) / (last - first);
    const double thickness = line_width * std::sqrt(1 + slope * slope);
    const double middle = (left + right) / 2, reach = std::abs(right - left) / 2 + thickness / 2 + 1;
    for (double row = std::max(std::floor(middle - reach), 0.0);
         row < std::min<double>(middle + reach, plot.layout.height); ++row) {
        const double opacity = color.a * (last - first) * sample_area(left, right, thickness, row);
        glm::dvec4& pixel = canvas[std::size_t(row) * plot.layout.width + column];
        pixel = glm::dvec4(glm::dvec3(color), 1) * opacity + pixel * (1 - opacity);
    }
}

Canvas blend_naively(const Plot& plot, const std::vector<glm::vec3>& colors, const CurveStyle& style) {
    Canvas canvas(std::size_t{plot.layout.width} * plot.layout.height, style.background);
    for (std::size_t curve = 0; curve < plot.curves.count(); ++curve)
        for (std::size_t gap = 0; gap < plot.curves.gap_count(); ++gap)
            for (std::uint32_t column = 0; column < plot.layout.width; ++column)
                blend_column(plot, curve, gap, column, style.line_width, glm::dvec4(colors[curve], style.opacity),
                             canvas);
    return canvas;
}

TEST(ParallelPlot, few_curves_are_blended_as_naively) {
    // Of 255: rounding to bytes, areas by slices, single precision where curves are steep.
    constexpr double TOLERANCE = 1.5;
    const std::vector<std::pair<std::uint32_t, std::uint32_t>> sizes{{300, 120}, {80, shared::LARGEST_BAND + 200}};
    for (const auto& [width, height] : sizes) {
        const Plot plot = make_plot(40, width, height);
        std::vector<glm::vec3> colors;
        for (std::size_t i = 0; i < 40; ++i)
            colors.push_back({float(i % 3) / 2, float(i % 5) / 4, float(i % 7) / 6});
        const CurveStyle style{.background = {0.9f, 0.8f, 0.7f, 1}, .opacity = 0.7f, .line_width = 1.5f};
        const auto pixels = read_pixels(draw_curves(get_device(), plot.layout, {}, plot.curves, colors, style));
        const Canvas expected = blend_naively(plot, colors, style);
        double worst = 0;
        for (std::size_t i = 0; i < pixels.size(); ++i)
            worst = std::max(worst, std::abs(expected[i / 4][i % 4] * 255 - pixels[i]));
        EXPECT_LT(worst, TOLERANCE) << width << " x " << height;
    }
}

// A chunk of curves goes on where the one before it ended.
TEST(ParallelPlot, many_blended_curves_are_the_naive_ones_too) {
    const Plot plot = make_plot(700, 60, 50);
    const std::vector<glm::vec3> colors(700, {0.2f, 0.3f, 0.4f});
    const CurveStyle style{.opacity = 0.05f};
    const auto pixels = read_pixels(draw_curves(get_device(), plot.layout, {}, plot.curves, colors, style));
    const Canvas expected = blend_naively(plot, colors, style);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        ASSERT_NEAR(pixels[i], expected[i / 4][i % 4] * 255, 2) << i;
}

// All loops of an invocation together may turn 65,535 times on the software device: these would 200,000 times.
TEST(ParallelPlot, curves_that_cover_whole_columns_are_all_drawn) {
    constexpr std::size_t COUNT = 400;
    std::vector<float> up(COUNT), down(COUNT);
    for (std::size_t i = 0; i < COUNT; ++i) {
        up[i] = float(i % 2);
        down[i] = 1 - up[i];
    }
    Plot plot{{make_column(up), make_column(down), make_column(up)}, {}, {}, {}};
    plot.axes = make_axes(plot.columns);
    plot.layout = place_axes(plot.axes, 24, 1000, {5, 5, 5, 5});
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, inspect::select_all(COUNT));
    const std::vector<glm::vec3> colors(COUNT, {0.2f, 0.3f, 0.4f});
    const CurveStyle style{.opacity = 0.01f};
    const auto pixels = read_pixels(draw_curves(get_device(), plot.layout, {}, plot.curves, colors, style));
    const Canvas expected = blend_naively(plot, colors, style);
    for (std::size_t i = 0; i < pixels.size(); ++i)
        ASSERT_NEAR(pixels[i], expected[i / 4][i % 4] * 255, 2) << i;
}

// The share of a color on the logarithmic scale.
double find_share_of(std::uint32_t count, std::uint32_t most) {
    return most > 1 ? std::log(double(count)) / std::log(double(most)) : 0;
}

TEST(ParallelPlot, density_is_colored_on_a_logarithmic_scale_over_the_context) {
    const Plot plot = make_plot(60);
    const Counts selected = count_naively(plot);
    Plot other = make_plot(200);
    other.columns = make_columns(4, 200, 9);
    other.curves = build_curves(other.columns, other.axes, other.layout, inspect::select_all(200));
    const Counts context = count_naively(other);
    const CurveStyle style{.background = {1, 1, 1, 1}, .context_color = {0, 0.5f, 0}, .most_curves = 0};
    const std::vector<std::uint8_t> pixels = draw(plot, style, other.curves);
    const std::uint32_t most = *std::max_element(selected.begin(), selected.end());
    const std::uint32_t most_context = *std::max_element(context.begin(), context.end());
    std::size_t context_alone = 0;
    for (std::size_t i = 0; i < selected.size(); ++i) {
        glm::vec3 expected(1);
        if (selected[i] > 0) {
            expected = map_color(Colormap::viridis, float(find_share_of(selected[i], most)));
        } else if (context[i] > 0) {
            ++context_alone;
            const auto opacity = float(0.25 + 0.75 * find_share_of(context[i], most_context));
            expected = opacity * style.context_color + (1 - opacity) * glm::vec3(1);
        }
        for (std::size_t k = 0; k < 3; ++k) // one entry of the color map to either side
            ASSERT_NEAR(pixels[4 * i + k], expected[k] * 255, 5) << i;
    }
    EXPECT_GT(context_alone, 20u);
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
    plot.curves = build_curves(plot.columns, plot.axes, plot.layout, inspect::select_all(2500));
    const Counts counts = count_on_device(plot);
    EXPECT_EQ(counts, count_naively(plot));
    for (std::uint32_t count : counts)
        EXPECT_TRUE(count == 0 || count == 2500) << count;
}

} // namespace
} // namespace photonloupe::test
