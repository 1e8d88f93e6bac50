// SPDX-License-Identifier: Apache-2.0
// The elementary functions of shaders/shared/math.glsl against double precision: the errors its comments state.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <random>

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <gtest/gtest.h>

#include "support/shared_device.h"

namespace photonloupe::test {
namespace {

enum Function { SIN_COS, ASIN_CORE, ACOS_EXACT, EXP_EXACT, NORMALIZE_SAFELY, SIN_COS_TURN };

constexpr float INF = std::numeric_limits<float>::infinity();
constexpr float QUIET_NAN = std::numeric_limits<float>::quiet_NaN();
constexpr float DENORMAL = std::numeric_limits<float>::denorm_min();
constexpr float SMALLEST = std::numeric_limits<float>::min();
constexpr float LARGEST = std::numeric_limits<float>::max();
constexpr int DENSE = 1 << 18;

std::vector<glm::vec4> evaluate(Function function, const std::vector<glm::vec4>& inputs) {
    return run_probe<glm::vec4>(get_device(), "probe_math.comp", inputs, {"FUNCTION " + std::to_string(function)});
}

// Evenly spaced values, and every float near the ends and near zero.
std::vector<glm::vec4> sample_range(float lo, float hi) {
    std::vector<glm::vec4> inputs;
    for (int i = 0; i <= DENSE; ++i)
        inputs.emplace_back(lo + (hi - lo) * (float(i) / DENSE));
    float up = lo, down = hi;
    for (int i = 0; i < 4096; ++i) {
        inputs.emplace_back(up);
        inputs.emplace_back(down);
        up = std::nextafter(up, hi);
        down = std::nextafter(down, lo);
    }
    for (float x = DENORMAL; x < hi; x = std::max(x * 1.03f, std::nextafter(x, INF)))
        for (float value : {x, -x})
            if (value >= lo && value <= hi)
                inputs.emplace_back(value);
    return inputs;
}

double measure_ulp(double exact) {
    const float rounded = std::abs(static_cast<float>(exact));
    const float spacing = std::nextafter(rounded, INF) - rounded;
    return std::isfinite(spacing) ? spacing : std::ldexp(1.0, 104);
}

struct Worst {
    double error = 0; // in ulp of the result, or absolute
    float input = 0;
};

Worst find_worst(Function function, const std::vector<glm::vec4>& inputs, const std::function<double(double)>& exact,
                 bool absolute = false, int component = 0) {
    const std::vector<glm::vec4> outputs = evaluate(function, inputs);
    Worst worst;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double truth = exact(inputs[i].x);
        const double error = std::abs(outputs[i][component] - truth) / (absolute ? 1.0 : measure_ulp(truth));
        if (!(error <= worst.error))
            worst = {error, inputs[i].x};
    }
    return worst;
}

float evaluate_one(Function function, float x, int component = 0) {
    return evaluate(function, {glm::vec4(x)})[0][component];
}

glm::vec3 normalize_one(float x, float y, float z) {
    return glm::vec3(evaluate(NORMALIZE_SAFELY, {{x, y, z, 0}})[0]);
}

// Absolute, as a share of 2^-23, the ulp of 1.
constexpr double ULP_OF_ONE = 1.0 / (1 << 23);

TEST(Math, sine_is_within_two_ulp_of_one) {
    const Worst worst = find_worst(SIN_COS, sample_range(-8192, 8192), [](double x) { return std::sin(x); }, true, 0);
    EXPECT_LT(worst.error, 2 * ULP_OF_ONE) << "at " << worst.input;
}

TEST(Math, cosine_is_within_two_ulp_of_one) {
    const Worst worst = find_worst(SIN_COS, sample_range(-8192, 8192), [](double x) { return std::cos(x); }, true, 1);
    EXPECT_LT(worst.error, 2 * ULP_OF_ONE) << "at " << worst.input;
}

TEST(Math, sine_of_the_smallest_numbers_is_exact) {
    for (float x : {0.0f, -0.0f, DENORMAL, -DENORMAL, SMALLEST})
        EXPECT_EQ(evaluate_one(SIN_COS, x), x);
}

TEST(Math, sine_of_what_is_not_finite_is_nan) {
    for (float x : {INF, -INF, QUIET_NAN})
        EXPECT_TRUE(std::isnan(evaluate_one(SIN_COS, x))) << x;
}

// Turns as 32-bit fractions: evenly spaced, and all near the eighths.
std::vector<std::uint32_t> sample_turns() {
    std::vector<std::uint32_t> turns;
    for (std::uint32_t i = 0; i < DENSE; ++i)
        turns.push_back(i * 16411u * 1021u);
    for (std::uint32_t eighth = 0; eighth < 8; ++eighth)
        for (std::uint32_t near = 0; near < 512; ++near)
            turns.push_back((eighth << 29) + near - 256u);
    return turns;
}

TEST(Math, sine_and_cosine_of_a_turn_are_within_one_ulp_of_one) {
    const std::vector<std::uint32_t> turns = sample_turns();
    std::vector<glm::vec4> inputs;
    for (const std::uint32_t turn : turns)
        inputs.emplace_back(std::bit_cast<float>(turn), 0, 0, 0);
    const std::vector<glm::vec4> outputs = evaluate(SIN_COS_TURN, inputs);
    double worst = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double angle = 2 * std::numbers::pi * turns[i] / 4294967296.0;
        worst = std::max({worst, std::abs(outputs[i].x - std::sin(angle)), std::abs(outputs[i].y - std::cos(angle))});
    }
    EXPECT_LT(worst, ULP_OF_ONE);
}

TEST(Math, quarter_turns_are_exact) {
    constexpr std::array SINES{0.0f, 1.0f, 0.0f, -1.0f, 0.0f};
    for (std::uint32_t quarter = 0; quarter < 4; ++quarter) {
        const glm::vec4 found = evaluate(SIN_COS_TURN, {glm::vec4(std::bit_cast<float>(quarter << 30))})[0];
        EXPECT_EQ(found.x, SINES[quarter]);
        EXPECT_EQ(found.y, SINES[quarter + 1]);
    }
}

TEST(Math, core_of_asin_is_within_two_ulp) {
    const Worst worst = find_worst(ASIN_CORE, sample_range(0, 0.5f), [](double x) { return std::asin(x); });
    EXPECT_LT(worst.error, 2.0) << "at " << worst.input;
}

TEST(Math, acos_is_within_four_ulp) {
    const Worst worst = find_worst(ACOS_EXACT, sample_range(-1, 1), [](double x) { return std::acos(x); });
    EXPECT_LT(worst.error, 4.0) << "at " << worst.input;
}

TEST(Math, acos_of_one_and_minus_one_is_exact) {
    EXPECT_EQ(evaluate_one(ACOS_EXACT, 1.0f), 0.0f);
    EXPECT_EQ(evaluate_one(ACOS_EXACT, -1.0f), static_cast<float>(std::acos(-1.0)));
}

TEST(Math, acos_outside_its_domain_is_nan) {
    for (float x : {1.0f + 1.2e-7f, -1.0f - 1.2e-7f, 2.0f, INF, -INF, QUIET_NAN})
        EXPECT_TRUE(std::isnan(evaluate_one(ACOS_EXACT, x))) << x;
}

TEST(Math, exponential_is_within_two_ulp) {
    const Worst worst = find_worst(EXP_EXACT, sample_range(-87.3f, 88.7f), [](double x) { return std::exp(x); });
    EXPECT_LT(worst.error, 2.0) << "at " << worst.input;
}

TEST(Math, exponential_reaches_the_denormal_range) {
    const Worst worst = find_worst(EXP_EXACT, sample_range(-104, -87.3f), [](double x) { return std::exp(x); });
    EXPECT_LT(worst.error, 2.0) << "at " << worst.input;
}

TEST(Math, exponential_of_large_numbers_is_infinite) {
    for (float x : {88.73f, 88.81f, 1e30f, LARGEST, INF})
        EXPECT_EQ(evaluate_one(EXP_EXACT, x), INF) << x;
}

TEST(Math, exponential_of_very_negative_numbers_is_zero) {
    for (float x : {-104.1f, -1e30f, -LARGEST, -INF})
        EXPECT_EQ(evaluate_one(EXP_EXACT, x), 0.0f) << x;
}

TEST(Math, exponential_of_nan_is_nan) {
    EXPECT_TRUE(std::isnan(evaluate_one(EXP_EXACT, QUIET_NAN)));
}

std::vector<glm::vec4> sample_vectors() {
    std::mt19937 random(5);
    std::uniform_real_distribution<float> exponent(-44.0f, 38.0f), sign(-1.0f, 1.0f);
    std::vector<glm::vec4> vectors;
    for (int i = 0; i < DENSE; ++i) {
        const float scale = std::pow(10.0f, exponent(random));
        const float x = sign(random), y = sign(random), z = sign(random);
        const glm::vec3 v = glm::vec3(x, y, z) * scale;
        if (v != glm::vec3(0.0f))
            vectors.emplace_back(v, 0.0f);
    }
    for (float tiny : {1e-45f, 1e-38f, 1e-20f, 1e-7f})
        for (float huge : {1e-38f, 1.0f, 1e20f, LARGEST})
            vectors.insert(vectors.end(), {{huge, tiny, 0, 0}, {-tiny, huge, tiny, 0}, {tiny, -0.0f, -huge, 0}});
    return vectors;
}

TEST(Math, normalized_vector_is_within_two_ulp_of_one_at_any_length) {
    const std::vector<glm::vec4> vectors = sample_vectors();
    const std::vector<glm::vec4> units = evaluate(NORMALIZE_SAFELY, vectors);
    double worst = 0;
    for (std::size_t i = 0; i < vectors.size(); ++i) {
        const glm::dvec3 exact = glm::normalize(glm::dvec3(vectors[i]));
        const double error = glm::length(glm::dvec3(units[i]) - exact);
        worst = error <= worst ? worst : error; // keeps a NaN
    }
    EXPECT_LT(worst, 2 * ULP_OF_ONE);
}

TEST(Math, normalized_zero_stays_zero) {
    EXPECT_EQ(normalize_one(0.0f, -0.0f, 0.0f), glm::vec3(0.0f));
}

TEST(Math, normalized_axis_is_exact) {
    for (float length : {DENORMAL, SMALLEST, 1.0f, LARGEST})
        EXPECT_EQ(normalize_one(0.0f, -length, 0.0f), glm::vec3(0, -1, 0)) << length;
}

TEST(Math, normalizing_what_is_not_finite_gives_nan) {
    for (float bad : {QUIET_NAN, INF, -INF})
        for (float other : {0.0f, 1.0f, bad})
            EXPECT_TRUE(std::isnan(normalize_one(bad, other, other).x)) << bad << ' ' << other;
}

} // namespace
} // namespace photonloupe::test
