// SPDX-License-Identifier: Apache-2.0
// The mathematics of the language at its edges: NaN, infinities, signed zeros, halves, wrapping.
#include "script/reference_math.h"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "script/builtins.h"

namespace photonloupe::script::tests {
namespace {

constexpr float NOT_A_NUMBER = std::numeric_limits<float>::quiet_NaN();
constexpr float INF = std::numeric_limits<float>::infinity();
constexpr std::int32_t LEAST = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t GREATEST = std::numeric_limits<std::int32_t>::max();

TEST(ReferenceMath, min_max_and_clamp_spread_nan_and_tell_zeros_apart) {
    for (const auto function : {compute_minimum, compute_maximum}) {
        EXPECT_TRUE(std::isnan(function(NOT_A_NUMBER, 1)));
        EXPECT_TRUE(std::isnan(function(1, NOT_A_NUMBER)));
    }
    EXPECT_TRUE(std::signbit(compute_minimum(0.0f, -0.0f)));
    EXPECT_TRUE(std::signbit(compute_minimum(-0.0f, 0.0f)));
    EXPECT_FALSE(std::signbit(compute_maximum(0.0f, -0.0f)));
    EXPECT_FALSE(std::signbit(compute_maximum(-0.0f, 0.0f)));
    EXPECT_EQ(compute_minimum(-INF, INF), -INF);
    EXPECT_EQ(compute_clamp(5, 0, 1), 1.0f);
    EXPECT_EQ(compute_clamp(-5, 0, 1), 0.0f);
    EXPECT_TRUE(std::isnan(compute_clamp(0.5f, NOT_A_NUMBER, 1)));
    EXPECT_TRUE(std::isnan(compute_clamp(NOT_A_NUMBER, 0, 1)));
}

TEST(ReferenceMath, arc_functions_clamp_what_rounding_left_outside) {
    EXPECT_EQ(compute_arc_cosine(1 + 1e-7f), 0.0f);
    EXPECT_EQ(compute_arc_cosine(1.00001f), 0.0f);
    EXPECT_EQ(compute_arc_cosine(-1.00001f), float(std::numbers::pi));
    EXPECT_TRUE(std::isnan(compute_arc_cosine(1.0001f)));
    EXPECT_TRUE(std::isnan(compute_arc_cosine(-INF)));
    EXPECT_TRUE(std::isnan(compute_arc_cosine(NOT_A_NUMBER)));
    EXPECT_EQ(compute_arc_sine(1.00001f), float(std::numbers::pi / 2));
    EXPECT_TRUE(std::isnan(compute_arc_sine(-1.1f)));
}

TEST(ReferenceMath, halves_are_rounded_away_from_zero) {
    EXPECT_EQ(compute_round(0.5f), 1.0f);
    EXPECT_EQ(compute_round(-0.5f), -1.0f);
    EXPECT_EQ(compute_round(2.5f), 3.0f);
    EXPECT_EQ(compute_round(0.49999997f), 0.0f);
    EXPECT_EQ(compute_round(8388609.0f), 8388609.0f);
}

TEST(ReferenceMath, integers_that_do_not_fit_are_the_nearest_that_do) {
    EXPECT_EQ(convert_to_integer(-2.9f).value, -2);
    EXPECT_TRUE(convert_to_integer(-2147483648.0f).fits);
    EXPECT_EQ(convert_to_integer(2147483648.0f).value, GREATEST);
    EXPECT_FALSE(convert_to_integer(2147483648.0f).fits);
    EXPECT_EQ(convert_to_integer(-INF).value, LEAST);
    EXPECT_EQ(convert_to_integer(NOT_A_NUMBER).value, 0);
    EXPECT_FALSE(convert_to_integer(NOT_A_NUMBER).fits);
}

TEST(ReferenceMath, powers_of_integers_are_exact_while_they_fit) {
    EXPECT_EQ(raise_integer(3, 19).value, 1162261467);
    EXPECT_TRUE(raise_integer(3, 19).fits);
    EXPECT_FALSE(raise_integer(3, 20).fits);
    EXPECT_EQ(raise_integer(-2, 31).value, LEAST);
    EXPECT_TRUE(raise_integer(-2, 31).fits);
    EXPECT_EQ(raise_integer(-3, 21).value, LEAST);
    EXPECT_EQ(raise_integer(0, 0).value, 1);
    EXPECT_EQ(raise_integer(-1, GREATEST).value, -1);
    EXPECT_EQ(raise_integer(2, GREATEST).value, GREATEST);
    for (int exponent = 0; exponent <= 15; ++exponent)
        EXPECT_EQ(compute_power(3, float(exponent)), float(raise_integer(3, exponent).value));
    EXPECT_EQ(compute_power(-2, 3), -8.0f);
    EXPECT_TRUE(std::isnan(compute_power(-2, 0.5f)));
    EXPECT_TRUE(std::isnan(compute_power(NOT_A_NUMBER, 0)));
    EXPECT_EQ(compute_power(2, -1), 0.5f);
}

TEST(ReferenceMath, remainders_truncate_and_mod_floors) {
    EXPECT_EQ(compute_remainder(-7, 3), -1);
    EXPECT_EQ(compute_mod(-7, 3), 2);
    EXPECT_EQ(compute_mod(7, -3), -2);
    EXPECT_EQ(compute_remainder(LEAST, -1), 0);
    EXPECT_EQ(compute_remainder(5, 0), 0);
    EXPECT_EQ(compute_mod(5, 0), 0);
    EXPECT_EQ(compute_remainder(-7.5f, 2.0f), -1.5f);
    EXPECT_EQ(compute_mod(-7.5f, 2.0f), 0.5f);
    EXPECT_EQ(compute_remainder(5.0f, INF), 5.0f);
    EXPECT_EQ(compute_remainder(5.0f, 0.0f), 0.0f);
    EXPECT_TRUE(std::isnan(compute_remainder(INF, 2.0f)));
    EXPECT_TRUE(std::isnan(compute_mod(5.0f, 0.0f)));
}

TEST(ReferenceMath, integers_wrap) {
    EXPECT_EQ(add_wrapping(GREATEST, 1), LEAST);
    EXPECT_EQ(subtract_wrapping(LEAST, 1), GREATEST);
    EXPECT_EQ(multiply_wrapping(65536, 65536), 0);
    const std::array least{LEAST};
    EXPECT_EQ(find_builtin("abs")->reference_integer(std::span(least)), LEAST);
}

TEST(ReferenceMath, magnitude_neither_overflows_nor_underflows) {
    EXPECT_EQ(compute_magnitude(std::vector<float>{3, 4}), 5.0f);
    EXPECT_EQ(compute_magnitude(std::vector<float>{3e30f, 4e30f, 0}), 5e30f);
    EXPECT_EQ(compute_magnitude(std::vector<float>{3e-30f, 0, 4e-30f}), 5e-30f);
    EXPECT_EQ(compute_magnitude(std::vector<float>{0, -0.0f, 0}), 0.0f);
    EXPECT_EQ(compute_magnitude(std::vector<float>{-INF, 1, 0}), INF);
    EXPECT_TRUE(std::isnan(compute_magnitude(std::vector<float>{NOT_A_NUMBER, INF})));
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> exponent(-35, 35), sign(-1, 1);
    for (int i = 0; i < 10'000; ++i) {
        const double scale = std::pow(10.0, exponent(engine));
        const float x = float(sign(engine) * scale), y = float(sign(engine) * scale), z = float(sign(engine) * scale);
        const double exact = std::sqrt(double(x) * x + double(y) * y + double(z) * z);
        EXPECT_NEAR(compute_magnitude(std::vector<float>{x, y, z}) / exact, 1.0, 3e-7);
    }
}

TEST(ReferenceMath, steps_and_mixes_are_as_in_shaders_but_spread_nan) {
    EXPECT_EQ(compute_step(1, 0.5f), 0.0f);
    EXPECT_EQ(compute_step(1, 1), 1.0f);
    EXPECT_TRUE(std::isnan(compute_step(1, NOT_A_NUMBER)));
    EXPECT_EQ(compute_smoothstep(0, 2, 1), 0.5f);
    EXPECT_EQ(compute_smoothstep(0, 2, -1), 0.0f);
    EXPECT_EQ(compute_smoothstep(0, 2, 3), 1.0f);
    EXPECT_EQ(compute_mix(2, 4, 0.25f), 2.5f);
    EXPECT_EQ(compute_fract(-0.25f), 0.75f);
    EXPECT_EQ(compute_sign(-3), -1.0f);
    EXPECT_TRUE(std::isnan(compute_sign(NOT_A_NUMBER)));
    EXPECT_TRUE(std::signbit(compute_sign(-0.0f)));
    EXPECT_EQ(compute_dot(std::vector<float>{1, 2, 3, 4}), 11.0f);
    EXPECT_EQ(compute_dot(std::vector<float>{1, 2, 3, 4, 5, 6}), 32.0f);
}

TEST(ReferenceMath, hue_turns_a_third_for_each_channel) {
    EXPECT_EQ(compute_hue(0, 0), 1.0f);
    EXPECT_NEAR(compute_hue(0, 1), 0.25, 1e-6);
    EXPECT_NEAR(compute_hue(float(2 * std::numbers::pi / 3), 1), 1.0, 1e-6);
    EXPECT_NEAR(compute_hue(float(std::numbers::pi), 0), 0.0, 1e-6);
}

TEST(ReferenceMath, random_is_uniform_and_a_function_of_its_arguments) {
    EXPECT_EQ(draw_random(1, 2, 3), draw_random(1, 2, 3));
    EXPECT_NE(draw_random(1, 2, 3), draw_random(2, 2, 3));
    EXPECT_NE(draw_random(1, 2, 3), draw_random(1, 3, 2));
    std::vector<int> bins(16);
    for (int i = 0; i < 16'000; ++i) {
        const float drawn = draw_random(7, i, -1);
        ASSERT_TRUE(drawn >= 0 && drawn < 1);
        ++bins[std::size_t(drawn * 16)];
    }
    double chi_square = 0;
    for (const int count : bins)
        chi_square += (count - 1000.0) * (count - 1000.0) / 1000.0;
    EXPECT_LT(chi_square, 37.7); // 15 degrees of freedom, 0.1 %
}

} // namespace
} // namespace photonloupe::script::tests
