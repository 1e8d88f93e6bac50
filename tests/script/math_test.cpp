// SPDX-License-Identifier: Apache-2.0
// The elementary functions of passes against double precision: the errors that shaders/script/functions.glsl states.
#include <bit>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include <glm/vec4.hpp>
#include <gtest/gtest.h>

#include "script/reference_math.h"
#include "support/shared_device.h"

namespace photonloupe::script {
namespace {

using test::get_device;
using test::run_probe;

constexpr float INF = std::numeric_limits<float>::infinity();
constexpr float QUIET_NAN = std::numeric_limits<float>::quiet_NaN();
constexpr int SAMPLES = 1 << 18;

std::vector<glm::vec4> evaluate(const std::string& call, const std::vector<glm::vec4>& inputs) {
    return run_probe<glm::vec4>(get_device(), "probe_script_math.comp", inputs, {"CALL " + call});
}

double measure_ulp(double exact) {
    const float rounded = std::abs(static_cast<float>(exact));
    const float spacing = std::nextafter(rounded, INF) - rounded;
    return std::isfinite(spacing) ? spacing : std::ldexp(1.0, 104);
}

// Floats of all magnitudes between two exponents of 2, both signs.
std::vector<glm::vec4> sample_magnitudes(double low, double high) {
    std::mt19937 random(17);
    std::uniform_real_distribution<double> exponent(low, high);
    std::vector<glm::vec4> inputs;
    for (int i = 0; i < SAMPLES; ++i) {
        const auto x = static_cast<float>(std::exp2(exponent(random)));
        inputs.emplace_back(i % 2 ? x : -x);
    }
    return inputs;
}

std::vector<glm::vec4> sample_range(float low, float high) {
    std::vector<glm::vec4> inputs;
    for (int i = 0; i <= SAMPLES; ++i)
        inputs.emplace_back(low + (high - low) * (static_cast<float>(i) / SAMPLES));
    return inputs;
}

using Exact = std::function<double(double, double)>;

void expect_within(const std::string& call, const std::vector<glm::vec4>& inputs, const Exact& exact, double ulps) {
    const std::vector<glm::vec4> outputs = evaluate(call, inputs);
    double worst = 0;
    std::size_t at = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double truth = exact(inputs[i].x, inputs[i].y);
        const auto rounded = static_cast<float>(truth);
        if (outputs[i].x == rounded || (std::isnan(outputs[i].x) && std::isnan(rounded)))
            continue;
        const double error = std::abs(outputs[i].x - truth) / measure_ulp(truth);
        if (!(error <= worst)) {
            worst = error;
            at = i;
        }
    }
    EXPECT_LT(worst, ulps) << call << " of " << inputs[at].x << ", " << inputs[at].y << " gives " << outputs[at].x
                           << ", not " << exact(inputs[at].x, inputs[at].y);
}

TEST(ScriptMath, sine_and_cosine_hold_for_every_size) {
    for (const auto& inputs : {sample_magnitudes(-20, 127.9), sample_magnitudes(-1, 14), sample_range(-10, 10)}) {
        expect_within("script_sin(v.x)", inputs, [](double x, double) { return std::sin(x); }, 3);
        expect_within("script_cos(v.x)", inputs, [](double x, double) { return std::cos(x); }, 3);
        expect_within("script_tan(v.x)", inputs, [](double x, double) { return std::tan(x); }, 6);
    }
}

TEST(ScriptMath, arc_functions_are_within_their_ulps) {
    for (const auto& inputs : {sample_range(-1, 1), sample_magnitudes(-60, 0)}) {
        expect_within("script_acos(v.x)", inputs, [](double x, double) { return std::acos(x); }, 4);
        expect_within("script_asin(v.x)", inputs, [](double x, double) { return std::asin(x); }, 3);
    }
    for (const auto& inputs : {sample_range(-5, 5), sample_magnitudes(-60, 60)})
        expect_within("script_atan(v.x)", inputs, [](double x, double) { return std::atan(x); }, 3);
}

TEST(ScriptMath, an_overshoot_is_forgiven_and_more_is_not) {
    for (const float x : {1.0f + 9e-6f, -1.0f - 9e-6f, 1.1f, -1.1f, 1.0f + 2e-5f, INF, QUIET_NAN}) {
        const float acos = evaluate("script_acos(v.x)", {glm::vec4(x)})[0].x;
        const float asin = evaluate("script_asin(v.x)", {glm::vec4(x)})[0].x;
        EXPECT_EQ(std::isnan(acos), std::isnan(compute_arc_cosine(x))) << x;
        EXPECT_EQ(std::isnan(asin), std::isnan(compute_arc_sine(x))) << x;
    }
}

std::vector<glm::vec4> sample_pairs(double low, double high) {
    std::vector<glm::vec4> inputs = sample_magnitudes(low, high), others = sample_magnitudes(low, high);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        inputs[i].y = (i / 2 % 2 ? 1.0f : -1.0f) * others[(i * 7919 + 1) % others.size()].x;
    return inputs;
}

TEST(ScriptMath, arc_tangent_of_two_is_within_four_ulp) {
    for (const auto& inputs : {sample_pairs(-3, 3), sample_pairs(-60, 60)})
        expect_within("script_atan2(v.x, v.y)", inputs, [](double y, double x) { return std::atan2(y, x); }, 4);
}

std::vector<glm::vec4> list_special_pairs() {
    std::vector<glm::vec4> pairs;
    const float values[] = {0.0f, -0.0f, 1.0f, -1.0f, 0.5f,      -0.5f,  2.0f,  -2.0f,
                            3.0f, -3.0f, INF,  -INF,  QUIET_NAN, 1e-45f, 3e38f, 16777217.0f};
    for (const float x : values)
        for (const float y : values)
            pairs.emplace_back(x, y, 0, 0);
    return pairs;
}

void expect_same_specials(const std::string& call, const std::function<float(float, float)>& reference) {
    const std::vector<glm::vec4> pairs = list_special_pairs(), outputs = evaluate(call, pairs);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        const float expected = reference(pairs[i].x, pairs[i].y), found = outputs[i].x;
        if (std::isnan(expected) || std::isnan(found)) {
            EXPECT_EQ(std::isnan(expected), std::isnan(found))
                << call << ' ' << pairs[i].x << ' ' << pairs[i].y << " gives " << found << " not " << expected;
            continue;
        }
        EXPECT_EQ(std::signbit(expected), std::signbit(found)) << call << ' ' << pairs[i].x << ' ' << pairs[i].y;
        if (std::isinf(expected) || expected == 0)
            EXPECT_EQ(expected, found) << call << ' ' << pairs[i].x << ' ' << pairs[i].y;
        else
            EXPECT_NEAR(found, expected, 1e-6 * std::abs(expected)) << call << ' ' << pairs[i].x << ' ' << pairs[i].y;
    }
}

TEST(ScriptMath, special_numbers_are_as_in_the_reference) {
    expect_same_specials("script_atan2(v.x, v.y)",
                         [](float y, float x) { return float(std::atan2(double(y), double(x))); });
    expect_same_specials("script_pow(v.x, v.y)", compute_power);
    expect_same_specials("script_min(v.x, v.y)", compute_minimum);
    expect_same_specials("script_max(v.x, v.y)", compute_maximum);
    expect_same_specials("script_mod(v.x, v.y)", [](float x, float y) { return compute_mod(x, y); });
    expect_same_specials("script_remainder(v.x, v.y, 0u)", [](float x, float y) { return compute_remainder(x, y); });
    expect_same_specials("script_step(v.x, v.y)", compute_step);
    expect_same_specials("script_clamp(v.x, v.y, 1.0)", [](float x, float y) { return compute_clamp(x, y, 1); });
    expect_same_specials("script_sign(v.x)", [](float x, float) { return compute_sign(x); });
    expect_same_specials("script_log(v.x)", [](float x, float) { return float(std::log(double(x))); });
    expect_same_specials("script_exp(v.x)", [](float x, float) { return float(std::exp(double(x))); });
    expect_same_specials("script_sqrt(v.x)", [](float x, float) { return std::sqrt(x); });
    expect_same_specials("script_atan(v.x)", [](float x, float) { return float(std::atan(double(x))); });
    expect_same_specials("script_sin(v.x)", [](float x, float) { return float(std::sin(double(x))); });
    expect_same_specials("script_cos(v.x)", [](float x, float) { return float(std::cos(double(x))); });
    expect_same_specials("script_fract(v.x)", [](float x, float) { return compute_fract(x); });
    expect_same_specials("script_magnitude(v.x, v.y)", [](float x, float y) {
        const float v[] = {x, y};
        return compute_magnitude(v);
    });
}

TEST(ScriptMath, logarithm_and_exponential_are_within_two_ulp) {
    for (const auto& inputs : {sample_magnitudes(-140, 127.9), sample_range(0.5f, 2)})
        expect_within("script_log(v.x)", inputs, [](double x, double) { return std::log(x); }, 2);
    expect_within("script_exp(v.x)", sample_range(-90, 88), [](double x, double) { return std::exp(x); }, 2);
}

TEST(ScriptMath, powers_are_within_three_ulp) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> base(-20, 20), result(-125, 127);
    std::vector<glm::vec4> inputs;
    for (int i = 0; i < SAMPLES; ++i) {
        const double exponent = i % 3 == 0 ? base(random) * 0.01 : base(random);
        const auto x = static_cast<float>(std::exp2(exponent));
        inputs.emplace_back(x, static_cast<float>(result(random) / exponent), 0, 0);
    }
    for (int x = -30; x <= 30; ++x)
        for (int y = -20; y <= 20; ++y)
            inputs.emplace_back(static_cast<float>(x), static_cast<float>(y), 0, 0);
    const auto exact = [](double x, double y) { return std::pow(x, y); };
    std::erase_if(inputs, [&](const glm::vec4& v) { return !std::isnormal(float(exact(v.x, v.y))); });
    expect_within("script_pow(v.x, v.y)", inputs, exact, 3);
}

TEST(ScriptMath, hue_is_within_four_ulp_of_one) {
    const std::vector<glm::vec4> inputs = sample_range(-100, 100);
    for (int channel = 0; channel < 3; ++channel) {
        const std::vector<glm::vec4> outputs = evaluate("script_hue(v.x, " + std::to_string(channel) + ".0)", inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i)
            ASSERT_NEAR(outputs[i].x, compute_hue(inputs[i].x, float(channel)), 4.0 / (1 << 23)) << inputs[i].x;
    }
}

std::vector<glm::vec4> sample_integers() {
    std::mt19937 random(3);
    std::vector<glm::vec4> inputs;
    const std::int32_t corners[] = {0,  1,  -1, 2,     -2,     3,          -3,          7,
                                    31, 32, 33, 46341, -46341, 2147483647, -2147483647, -2147483647 - 1};
    for (const std::int32_t x : corners)
        for (const std::int32_t y : corners)
            inputs.emplace_back(std::bit_cast<float>(x), std::bit_cast<float>(y), 0, 0);
    for (int i = 0; i < 4096; ++i)
        inputs.emplace_back(std::bit_cast<float>(std::uint32_t(random())),
                            std::bit_cast<float>(std::uint32_t(random() >> random() % 31)), 0, 0);
    return inputs;
}

TEST(ScriptMath, integers_are_as_in_the_reference) {
    struct Call {
        const char* text;
        std::function<std::int32_t(std::int32_t, std::int32_t)> reference;
    };
    const Call calls[] = {
        {"script_remainder(b.x, b.y, 0u)", [](std::int32_t x, std::int32_t y) { return compute_remainder(x, y); }},
        {"script_mod(b.x, b.y)", [](std::int32_t x, std::int32_t y) { return compute_mod(x, y); }},
        {"script_abs(b.x)", [](std::int32_t x, std::int32_t) { return x < 0 ? subtract_wrapping(0, x) : x; }},
        {"script_sign(b.x)", [](std::int32_t x, std::int32_t) { return (x > 0) - (x < 0); }},
        {"script_pow(b.x, b.y & 63, 0u)",
         [](std::int32_t x, std::int32_t y) { return raise_integer(x, y & 63).value; }},
    };
    const std::vector<glm::vec4> inputs = sample_integers();
    for (const Call& call : calls) {
        const std::vector<glm::vec4> outputs = evaluate(call.text, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const auto x = std::bit_cast<std::int32_t>(inputs[i].x), y = std::bit_cast<std::int32_t>(inputs[i].y);
            ASSERT_EQ(std::bit_cast<std::int32_t>(outputs[i].x), call.reference(x, y))
                << call.text << ' ' << x << ' ' << y;
        }
    }
}

TEST(ScriptMath, conversions_to_integers_are_as_in_the_reference) {
    std::vector<glm::vec4> inputs = sample_magnitudes(-5, 34);
    for (const float x : {0.5f, 1.5f, 2.5f, -0.5f, -1.5f, 0.49999997f, -0.49999997f, 8388607.5f, 8388609.0f,
                          2147483520.0f, 2147483648.0f, -2147483648.0f, -2147483904.0f, INF, -INF, QUIET_NAN})
        inputs.emplace_back(x);
    const std::pair<const char*, std::function<float(float)>> calls[] = {
        {"script_int(v.x, 0u)", [](float x) { return std::trunc(x); }},
        {"script_floor(v.x, 0u)", [](float x) { return std::floor(x); }},
        {"script_ceil(v.x, 0u)", [](float x) { return std::ceil(x); }},
        {"script_round(v.x, 0u)", [](float x) { return compute_round(x); }},
    };
    for (const auto& [call, reference] : calls) {
        const std::vector<glm::vec4> outputs = evaluate(call, inputs);
        for (std::size_t i = 0; i < inputs.size(); ++i) {
            const IntegerResult expected = convert_to_integer(reference(inputs[i].x));
            ASSERT_EQ(std::bit_cast<std::int32_t>(outputs[i].x), expected.value) << call << ' ' << inputs[i].x;
            ASSERT_EQ(outputs[i].w == 0.0f, expected.fits) << call << ' ' << inputs[i].x;
        }
    }
}

TEST(ScriptMath, random_numbers_are_those_of_the_host) {
    const std::vector<glm::vec4> inputs = sample_integers(), outputs = evaluate("script_random(b.x, b.y)", inputs);
    for (std::size_t i = 0; i < inputs.size(); ++i)
        ASSERT_EQ(outputs[i].x,
                  draw_random(7, std::bit_cast<std::int32_t>(inputs[i].x), std::bit_cast<std::int32_t>(inputs[i].y)));
}

} // namespace
} // namespace photonloupe::script
