// SPDX-License-Identifier: Apache-2.0
// The reference functions; transcendental ones go through double so that the float result is rounded once.
#include "script/reference_math.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "shared/script_random.h"

namespace photonloupe::script {
namespace {

constexpr float NAN_FLOAT = std::numeric_limits<float>::quiet_NaN();
constexpr float PAST_INTEGERS = 2147483648.0f; // 2^31

float clamp_cosine(float x) {
    return std::fabs(x) <= 1 + ARC_TOLERANCE ? std::clamp(x, -1.0f, 1.0f) : NAN_FLOAT;
}

} // namespace

float compute_minimum(float a, float b) {
    if (std::isnan(a) || std::isnan(b))
        return NAN_FLOAT;
    return a < b || (a == b && std::signbit(a)) ? a : b;
}

float compute_maximum(float a, float b) {
    if (std::isnan(a) || std::isnan(b))
        return NAN_FLOAT;
    return a > b || (a == b && !std::signbit(a)) ? a : b;
}

float compute_clamp(float x, float low, float high) {
    return compute_minimum(compute_maximum(x, low), high);
}

float compute_sign(float x) {
    return x > 0 ? 1.0f : x < 0 ? -1.0f : x;
}

float compute_round(float x) {
    return std::round(x);
}

float compute_fract(float x) {
    return x - std::floor(x);
}

float compute_mod(float x, float y) {
    return x - y * std::floor(x / y);
}

float compute_mix(float a, float b, float t) {
    return a * (1 - t) + b * t;
}

float compute_step(float edge, float x) {
    return std::isnan(edge) || std::isnan(x) ? NAN_FLOAT : x < edge ? 0.0f : 1.0f;
}

float compute_smoothstep(float low, float high, float x) {
    const float t = compute_clamp((x - low) / (high - low), 0, 1);
    return t * t * (3 - 2 * t);
}

float compute_power(float x, float y) {
    return std::isnan(x) || std::isnan(y) ? NAN_FLOAT : float(std::pow(double(x), double(y)));
}

float compute_arc_sine(float x) {
    return float(std::asin(double(clamp_cosine(x))));
}

float compute_arc_cosine(float x) {
    return float(std::acos(double(clamp_cosine(x))));
}

float compute_magnitude(std::span<const float> v) {
    // Squares of numbers in this range neither overflow nor lose bits; others are scaled by a power of two.
    constexpr float LEAST = 0x1p-50f, GREATEST = 0x1p50f, SCALE = 0x1p64f;
    float largest = 0;
    for (const float x : v)
        largest = compute_maximum(largest, std::fabs(x));
    const float scale = largest < LEAST ? SCALE : largest > GREATEST ? 1 / SCALE : 1.0f;
    float sum = 0;
    for (const float x : v)
        sum += (x * scale) * (x * scale);
    return std::sqrt(sum) / scale;
}

float compute_dot(std::span<const float> ab) {
    const std::size_t dimensions = ab.size() / 2;
    float sum = ab[0] * ab[dimensions];
    for (std::size_t i = 1; i < dimensions; ++i)
        sum += ab[i] * ab[dimensions + i];
    return sum;
}

float compute_hue(float angle, float channel) {
    return float(0.5 + 0.5 * std::cos(angle - 2 * std::numbers::pi * channel / 3));
}

float compute_remainder(float x, float y) {
    if (y == 0)
        return 0;
    return std::isinf(y) && std::isfinite(x) ? x : x - y * std::trunc(x / y);
}

std::int32_t compute_remainder(std::int32_t x, std::int32_t y) {
    return y == 0 || y == -1 ? 0 : x % y;
}

std::int32_t add_wrapping(std::int32_t a, std::int32_t b) {
    return std::int32_t(std::uint32_t(a) + std::uint32_t(b));
}

std::int32_t subtract_wrapping(std::int32_t a, std::int32_t b) {
    return std::int32_t(std::uint32_t(a) - std::uint32_t(b));
}

std::int32_t multiply_wrapping(std::int32_t a, std::int32_t b) {
    return std::int32_t(std::uint32_t(a) * std::uint32_t(b));
}

std::int32_t compute_mod(std::int32_t x, std::int32_t y) {
    const std::int32_t remainder = compute_remainder(x, y);
    return remainder != 0 && (remainder < 0) != (y < 0) ? remainder + y : remainder;
}

IntegerResult convert_to_integer(float x) {
    constexpr std::int32_t LEAST = std::numeric_limits<std::int32_t>::min();
    constexpr std::int32_t GREATEST = std::numeric_limits<std::int32_t>::max();
    if (std::isnan(x))
        return {0, false};
    if (x >= PAST_INTEGERS)
        return {GREATEST, false};
    if (x < -PAST_INTEGERS)
        return {LEAST, false};
    return {std::int32_t(x), true};
}

IntegerResult raise_integer(std::int32_t base, std::int32_t exponent) {
    constexpr std::int64_t LEAST = std::numeric_limits<std::int32_t>::min();
    constexpr std::int64_t GREATEST = std::numeric_limits<std::int32_t>::max();
    if (base == 1 || base == -1 || base == 0)
        return {exponent == 0 ? 1 : base == -1 && exponent % 2 == 0 ? 1 : base, true};
    std::int64_t power = 1;
    for (std::int32_t i = 0; i < exponent; ++i) {
        power *= base; // ends after 31 turns at most
        if (power > GREATEST || power < LEAST) {
            const bool is_negative = base < 0 && exponent % 2 != 0;
            return {std::int32_t(is_negative ? LEAST : GREATEST), false};
        }
    }
    return {std::int32_t(power), true};
}

float draw_random(std::uint32_t seed, std::int32_t index, std::int32_t salt) {
    return shared::draw_script_random(seed, std::uint32_t(index), std::uint32_t(salt));
}

} // namespace photonloupe::script
