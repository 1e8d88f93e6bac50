// SPDX-License-Identifier: Apache-2.0
// How values over photons are combined: identities, NaN, zeros, ties, wrapping; moments against double precision.
#include "script/interpret/reductions.h"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "script/reference_math.h"

namespace photonloupe::script {
namespace {

constexpr float INF = std::numeric_limits<float>::infinity();
constexpr float QUIET_NAN = std::numeric_limits<float>::quiet_NaN();
constexpr std::int32_t LARGEST = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t SMALLEST = std::numeric_limits<std::int32_t>::min();

Number real(float value) {
    Number number;
    number.real = value;
    return number;
}

Number integer(std::int32_t value) {
    Number number;
    number.integer = value;
    return number;
}

TEST(Reductions, minimum_and_maximum_spread_nan) {
    for (float other : {0.0f, INF, -INF, QUIET_NAN}) {
        EXPECT_TRUE(std::isnan(compute_minimum(QUIET_NAN, other)));
        EXPECT_TRUE(std::isnan(compute_minimum(other, QUIET_NAN)));
        EXPECT_TRUE(std::isnan(compute_maximum(QUIET_NAN, other)));
        EXPECT_TRUE(std::isnan(compute_maximum(other, QUIET_NAN)));
    }
}

TEST(Reductions, minus_zero_is_below_zero) {
    EXPECT_TRUE(std::signbit(compute_minimum(0.0f, -0.0f)));
    EXPECT_TRUE(std::signbit(compute_minimum(-0.0f, 0.0f)));
    EXPECT_FALSE(std::signbit(compute_maximum(0.0f, -0.0f)));
    EXPECT_FALSE(std::signbit(compute_maximum(-0.0f, 0.0f)));
}

TEST(Reductions, identities_change_nothing) {
    for (float value : {-3.5f, 0.0f, -0.0f, INF, -INF})
        for (Role role : {Role::minimum, Role::maximum})
            EXPECT_EQ(combine(role, Type::real, find_identity(role, Type::real), real(value)).real, value);
    for (std::int32_t value : {-3, 0, LARGEST, SMALLEST})
        for (Role role : {Role::sum, Role::minimum, Role::maximum})
            EXPECT_EQ(combine(role, Type::integer, find_identity(role, Type::integer), integer(value)).integer, value);
    EXPECT_EQ(combine(Role::sum, Type::real, find_identity(Role::sum, Type::real), real(2.5f)).real, 2.5f);
}

TEST(Reductions, integer_sums_wrap) {
    EXPECT_EQ(combine(Role::sum, Type::integer, integer(LARGEST), integer(1)).integer, SMALLEST);
}

TEST(Reductions, equal_choices_go_to_the_lower_photon) {
    for (Role role : {Role::least, Role::greatest}) {
        EXPECT_TRUE(wins(role, Type::real, {real(1), 3}, {real(1), 5}));
        EXPECT_FALSE(wins(role, Type::real, {real(1), 5}, {real(1), 3}));
        EXPECT_FALSE(wins(role, Type::integer, {integer(1), 3}, {integer(1), 3}));
        EXPECT_TRUE(wins(role, Type::real, {real(-0.0f), 1}, {real(0.0f), 2}));
    }
}

TEST(Reductions, the_better_choice_wins_whatever_its_photon) {
    EXPECT_TRUE(wins(Role::least, Type::real, {real(1), 9}, {real(2), 3}));
    EXPECT_FALSE(wins(Role::least, Type::real, {real(2), 3}, {real(1), 9}));
    EXPECT_TRUE(wins(Role::greatest, Type::integer, {integer(2), 9}, {integer(-1), 3}));
    EXPECT_FALSE(wins(Role::greatest, Type::integer, {integer(-1), 3}, {integer(2), 9}));
}

TEST(Reductions, nan_is_never_chosen_and_never_displaced) {
    for (Role role : {Role::least, Role::greatest}) {
        EXPECT_FALSE(wins(role, Type::real, {real(QUIET_NAN), 0}, {find_identity(role, Type::real)}));
        EXPECT_FALSE(wins(role, Type::real, {real(1), 0}, {real(QUIET_NAN), 7}));
    }
}

TEST(Reductions, an_infinity_does_not_beat_no_choice) {
    // Serially `if (e < s)` never holds for +inf: the lane's fresh value must lose only to what is strictly better …
    const Choice none{find_identity(Role::least, Type::real)};
    EXPECT_TRUE(wins(Role::least, Type::real, {real(1e38f), 4}, none));
    EXPECT_FALSE(wins(Role::least, Type::real, none, none));
}

using Points = std::vector<std::array<float, 3>>;

Moments push_all(const Points& points, std::size_t dimensions, std::uint32_t first = 0) {
    Moments moments;
    for (std::size_t i = 0; i < points.size(); ++i)
        push_point(moments, std::span(points[i]).first(dimensions), first + std::uint32_t(i));
    return moments;
}

Points draw_points(std::size_t count, std::array<float, 3> center, std::array<float, 3> spread) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    Points points(count);
    for (auto& point : points)
        for (int i = 0; i < 3; ++i)
            point[i] = center[i] + spread[i] * normal(random);
    return points;
}

TEST(Moments, products_are_those_of_double_precision) {
    const Points points = draw_points(5000, {100, -20, 3}, {1, 2, 0.5f});
    double mean[3] = {}, products[3] = {};
    for (const auto& point : points)
        for (int i = 0; i < 3; ++i)
            mean[i] += point[i] / double(points.size());
    for (const auto& point : points)
        for (int i = 0; i < 3; ++i)
            products[i] += (point[i] - mean[i]) * (point[i] - mean[i]);
    const Moments moments = push_all(points, 3);
    const int diagonal[3] = {0, 3, 5};
    for (int i = 0; i < 3; ++i) {
        EXPECT_NEAR(moments.mean[i], mean[i], 1e-4);
        EXPECT_NEAR(moments.products[diagonal[i]], products[i], 1e-3 * products[i]);
    }
}

TEST(Moments, merged_halves_are_the_whole) {
    const Points points = draw_points(1001, {5, 5, 5}, {1, 3, 2});
    const Points left(points.begin(), points.begin() + 400), right(points.begin() + 400, points.end());
    const Moments whole = push_all(points, 3);
    const Moments merged = merge_moments(push_all(left, 3), push_all(right, 3, 400));
    EXPECT_EQ(merged.count, whole.count);
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(merged.mean[i], whole.mean[i], 1e-5);
    for (int i = 0; i < 6; ++i)
        EXPECT_NEAR(merged.products[i], whole.products[i], 0.05);
}

TEST(Moments, an_empty_half_changes_nothing) {
    const Moments some = push_all({{1, 2, 3}, {4, 5, 6}}, 3, 8);
    for (const Moments& merged : {merge_moments(some, {}), merge_moments({}, some)}) {
        EXPECT_EQ(merged.count, 2);
        EXPECT_EQ(merged.first_photon, 8u);
        EXPECT_EQ(merged.mean[1], some.mean[1]);
    }
}

TEST(Moments, the_first_point_is_the_lowest_photons) {
    const Moments merged = merge_moments(push_all({{1, 1, 0}}, 2, 65), push_all({{2, 3, 0}}, 2, 2));
    EXPECT_EQ(merged.first_photon, 2u);
    EXPECT_EQ(merged.first_point[0], 2);
    EXPECT_EQ(merged.first_point[1], 3);
}

} // namespace
} // namespace photonloupe::script
