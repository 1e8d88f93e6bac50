// SPDX-License-Identifier: Apache-2.0
// Histograms, scatter plots, spreads and error maps of a few numbers that are known.
#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "core/error.h"
#include "inspect/error_map.h"
#include "inspect/histogram.h"
#include "inspect/photon_colors.h"
#include "inspect/scatter.h"
#include "inspect/spread.h"

namespace photonloupe::test {
namespace {

using namespace inspect;

// Pixels: a period is a 32-bit float.
constexpr double ANGLE_ROUNDING = 1e-4;
constexpr float NO_VALUE = std::numeric_limits<float>::quiet_NaN();

Column make_column(std::vector<float> values, float low, float high, float period = 0) {
    return {"c", "c", std::move(values), low, high, period, false};
}

TEST(ColumnHistogram, counts_edges_once_and_what_lies_outside) {
    const Column column = make_column({-1, 0, 0.5f, 1, 1.5f, 2, 3, NO_VALUE, INFINITY}, 0, 2);
    const ColumnHistogram histogram = count_column(column, 2);
    EXPECT_EQ(histogram.counts, (std::vector<std::uint64_t>{2, 3}));
    EXPECT_EQ(histogram.edges, (std::vector<double>{0, 1, 2}));
    EXPECT_EQ(histogram.below, 1u);
    EXPECT_EQ(histogram.above, 1u);
    EXPECT_EQ(histogram.non_finite, 2u);
    EXPECT_EQ(histogram.cdf, (std::vector<double>{3.0 / 7, 6.0 / 7}));
}

TEST(ColumnHistogram, refuses_what_is_no_range) {
    const Column column = make_column({1}, 1, 1);
    EXPECT_EQ(count_column(column, 1).counts[0], 1u); // widened
    EXPECT_THROW(count_column(column, 0), Error);
    EXPECT_THROW(count_column(column, 1, std::pair(2.0, 1.0)), Error);
    EXPECT_THROW(count_column(column, 1, std::pair(0.0, double{INFINITY})), Error);
}

TEST(Quantile, lies_between_neighbours) {
    const std::vector<float> values{4, NO_VALUE, 1, 2, 3};
    EXPECT_EQ(find_quantile(values, 0), 1);
    EXPECT_EQ(find_quantile(values, 1), 4);
    EXPECT_EQ(find_quantile(values, 0.5), 2.5);
    EXPECT_TRUE(std::isnan(find_quantile(std::vector{NO_VALUE}, 0.5)));
    EXPECT_EQ(find_share_above(values, 3), 0.25);
}

TEST(ScatterFrame, maps_back_what_it_maps) {
    constexpr float PI = std::numbers::pi_v<float>;
    const Column x = make_column({}, -PI, PI, 2 * PI), y = make_column({}, 0.25f, 2);
    for (const bool is_polar : {false, true}) {
        ScatterSettings settings;
        settings.height = 300;
        settings.is_polar = is_polar;
        const ScatterFrame frame(x, y, settings);
        for (const double angle : {-3.0, -1.0, 0.0, 0.5, 3.1})
            for (const double radius : {0.3, 1.0, 1.9}) {
                const glm::dvec2 data = frame.to_data(frame.to_pixel(angle, radius));
                EXPECT_NEAR(data.x, angle, 1e-9);
                EXPECT_NEAR(data.y, radius, 1e-9);
            }
    }
}

TEST(ScatterFrame, polar_angles_run_from_the_top_to_the_right) {
    constexpr float PI = std::numbers::pi_v<float>;
    ScatterSettings settings;
    settings.width = settings.height = 104;
    settings.point_radius = 2;
    settings.is_polar = true;
    const ScatterFrame frame(make_column({}, -PI, PI, 2 * PI), make_column({}, 0, 1), settings);
    const glm::dvec2 up = frame.to_pixel(0, 1), right = frame.to_pixel(std::numbers::pi / 2, 0.5);
    EXPECT_NEAR(up.x, 52, ANGLE_ROUNDING);
    EXPECT_NEAR(up.y, 2, ANGLE_ROUNDING);
    EXPECT_NEAR(right.x, 77, ANGLE_ROUNDING);
    EXPECT_NEAR(right.y, 52, ANGLE_ROUNDING);
}

// The byte of a channel at a pixel.
int read_byte(const ScatterPlot& plot, glm::uvec2 pixel, int channel) {
    return plot.rgba[4 * (std::size_t{pixel.y} * plot.width + pixel.x) + static_cast<std::size_t>(channel)];
}

TEST(Scatter, draws_each_photon_in_its_color_where_its_values_lie) {
    ScatterSettings settings;
    settings.width = settings.height = 20;
    settings.point_radius = 0;
    const Column x = make_column({0.025f, 0.525f, NO_VALUE}, 0, 1), y = make_column({0.975f, 0.025f, 0.5f}, 0, 1);
    const std::vector<glm::vec3> colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const ScatterPlot plot = plot_scatter(x, y, colors, nullptr, settings);
    EXPECT_EQ(plot.drawn_count, 2u);
    EXPECT_EQ(read_byte(plot, {0, 0}, 0), 255);
    EXPECT_EQ(read_byte(plot, {10, 19}, 1), 255);
    EXPECT_EQ(read_byte(plot, {10, 19}, 0), 0);
    int opaque = 0;
    for (std::size_t at = 3; at < plot.rgba.size(); at += 4)
        opaque += plot.rgba[at] == 255;
    EXPECT_EQ(opaque, 2);
}

TEST(Scatter, lays_the_selection_over_grey_context) {
    ScatterSettings settings;
    settings.width = settings.height = 21;
    const Column x = make_column({0.25f, 0.25f, 0.75f}, 0, 1), y = make_column({0.5f, 0.5f, 0.5f}, 0, 1);
    const std::vector<glm::vec3> colors{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Selection first{0};
    const ScatterPlot plot = plot_scatter(x, y, colors, &first, settings);
    const glm::uvec2 chosen(plot.frame.to_pixel(0.25, 0.5)), other(plot.frame.to_pixel(0.75, 0.5));
    EXPECT_EQ(read_byte(plot, chosen, 0), 255);
    EXPECT_EQ(read_byte(plot, chosen, 1), 0);
    EXPECT_EQ(read_byte(plot, other, 0), read_byte(plot, other, 2));
    EXPECT_LT(read_byte(plot, other, 2), 128);
}

TEST(Scatter, of_many_points_is_as_opaque_as_they_are_dense) {
    ScatterSettings settings;
    settings.width = settings.height = 20;
    settings.dense_from = 4;
    const Column x = make_column({0.25f, 0.25f, 0.25f, 0.75f}, 0, 1), y = make_column({0.5f, 0.5f, 0.5f, 0.5f}, 0, 1);
    const std::vector<glm::vec3> colors(4, glm::vec3(1));
    const ScatterPlot plot = plot_scatter(x, y, colors, nullptr, settings);
    ASSERT_TRUE(plot.is_dense);
    EXPECT_EQ(read_byte(plot, glm::uvec2(plot.frame.to_pixel(0.25, 0.5)), 3), 255);
    EXPECT_EQ(read_byte(plot, glm::uvec2(plot.frame.to_pixel(0.75, 0.5)), 3),
              std::lround(255 * std::log(2.0) / std::log(4.0)));
}

TEST(Scatter, refuses_columns_of_different_maps) {
    const std::vector<glm::vec3> colors(2);
    EXPECT_THROW(plot_scatter(make_column({1, 2}, 0, 1), make_column({1}, 0, 1), colors, nullptr, {}), Error);
}

TEST(Lasso, takes_what_lies_within_a_concave_polygon) {
    ScatterSettings settings;
    settings.width = settings.height = 104;
    settings.point_radius = 2;
    const Column x = make_column({10, 50, 90, 50, NO_VALUE}, 0, 100), y = make_column({50, 90, 50, 20, 50}, 0, 100);
    const ScatterFrame frame(x, y, settings);
    // A V that is open at the top: the point between its legs is out.
    const std::vector<glm::dvec2> letter{frame.to_pixel(0, 100),  frame.to_pixel(20, 100),  frame.to_pixel(50, 30),
                                         frame.to_pixel(80, 100), frame.to_pixel(100, 100), frame.to_pixel(95, 45),
                                         frame.to_pixel(50, 0),   frame.to_pixel(5, 45)};
    EXPECT_EQ(find_in_lasso(x, y, frame, letter), (Selection{0, 2, 3}));
    EXPECT_TRUE(find_in_lasso(x, y, frame, {}).empty());
}

TEST(Spread, of_an_ellipse_has_its_axes) {
    std::vector<glm::vec3> points;
    const glm::dvec3 along = glm::dvec3(0.6, 0, 0.8), across(-0.8, 0, 0.6);
    for (int i = 0; i < 360; ++i) {
        const double angle = i * std::numbers::pi / 180;
        points.emplace_back(3.0 * std::cos(angle) * along + 0.5 * std::sin(angle) * across + glm::dvec3(5, 1, 7));
    }
    const Spread spread = measure_spread(points, {0, 1, 0});
    EXPECT_NEAR(spread.along_variance, 4.5, 1e-5);
    EXPECT_NEAR(spread.across_variance, 0.125, 1e-5);
    EXPECT_NEAR(spread.isotropy, 1.0 / 6, 1e-5);
    EXPECT_NEAR(std::abs(spread.along.x * 0.6 + spread.along.z * 0.8), 1.0, 1e-5);
    EXPECT_TRUE(std::isnan(measure_spread(std::vector<glm::vec3>(9, glm::vec3(1)), {0, 1, 0}).isotropy));
    EXPECT_TRUE(std::isnan(measure_spread({}, {0, 1, 0}).isotropy));
}

TEST(ErrorMap, has_the_numbers_of_its_definition) {
    const Image a{2, 1, {1, 1, 1, 3, 0, 0}, {}}, b{2, 1, {1, 1, 1, 1, 0, 0}, {}};
    const ErrorMap map = measure_errors(a, b);
    const double floor = 0.01 * std::pow(4.0 / 6, 2);
    EXPECT_EQ(map.absolute[0], 0.0f);
    EXPECT_NEAR(map.absolute[1], 2 * 0.2126, 1e-6);
    EXPECT_NEAR(map.relative[1], 2 * 0.2126 / std::sqrt(1 + floor), 1e-6);
    EXPECT_NEAR(map.rmse, std::sqrt(4.0 / 6), 1e-12);
    EXPECT_NEAR(map.relmse, 4 / (1 + floor) / 6, 1e-12);
    const Image painted = paint_errors(map, false);
    EXPECT_EQ((glm::vec3{painted.rgb[3], painted.rgb[4], painted.rgb[5]}), linearize(map_color(Colormap::viridis, 1)));
}

TEST(ErrorMap, refuses_what_cannot_be_compared) {
    const Image a{1, 1, {1, 1, 1}, {}}, wide{2, 1, std::vector<float>(6), {}}, odd{1, 1, {1, NO_VALUE, 1}, {}};
    EXPECT_THROW(measure_errors(a, wide), Error);
    EXPECT_THROW(measure_errors(odd, a), Error);
    EXPECT_EQ(measure_errors(a, a).relmse, 0);
}

TEST(ColumnColors, wrap_where_the_column_does) {
    const std::vector<glm::vec3> colors = list_column_colors(make_column({0, 1, 2, NO_VALUE}, 0, 2, 2));
    EXPECT_EQ(colors[0], colors[2]);
    EXPECT_NE(colors[0], colors[1]);
    EXPECT_EQ(colors[3], linearize(UNSET_COLOR));
}

} // namespace
} // namespace photonloupe::test
