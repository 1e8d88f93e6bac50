// SPDX-License-Identifier: Apache-2.0
// What the language's mathematics mean: 32-bit floats, NaN spreads through everything, each result rounded once where
// stated. shaders/script/ computes the same within stated ulps.
#pragma once

#include <cstdint>
#include <span>

namespace photonloupe::script {

// min, max and clamp: any NaN gives NaN, -0 < +0.
float compute_minimum(float a, float b);
float compute_maximum(float a, float b);
float compute_clamp(float x, float low, float high); // min(max(x, low), high)

float compute_sign(float x);                  // -1, 1, or x itself when it is a zero or NaN
float compute_round(float x);                 // to the nearest whole number, halves away from zero
float compute_fract(float x);                 // x - floor(x)
float compute_mod(float x, float y);          // x - y floor(x / y): y's sign; mod(x, 0) is NaN
float compute_mix(float a, float b, float t); // a (1 - t) + b t
float compute_step(float edge, float x);      // 0 below the edge, else 1; NaN if either is
float compute_smoothstep(float low, float high, float x);
float compute_power(float x, float y); // rounded once; any NaN gives NaN (pow(NaN, 0) too)
float compute_arc_sine(float x);       // x outside [-1, 1] by at most ARC_TOLERANCE is clamped
float compute_arc_cosine(float x);
float compute_magnitude(std::span<const float> v); // without overflow or underflow on the way
float compute_dot(std::span<const float> ab);      // a's numbers, then b's; products summed in order
float compute_hue(float angle, float channel);     // 1/2 + 1/2 cos(angle - 2 pi channel / 3)  [SJL15] section 4.2

// Cosines of angles between rounded unit vectors overshoot 1 by a few ulps; more is a mistake in the script.
constexpr float ARC_TOLERANCE = 1e-5f;

// The operator %: truncates like C. Reals: x - y trunc(x / y), x itself for an infinite y and finite x.
// By 0 it is 0, which the caller reports.
float compute_remainder(float x, float y);
std::int32_t compute_remainder(std::int32_t x, std::int32_t y);

// Integers wrap.
std::int32_t add_wrapping(std::int32_t a, std::int32_t b);
std::int32_t subtract_wrapping(std::int32_t a, std::int32_t b);
std::int32_t multiply_wrapping(std::int32_t a, std::int32_t b);
std::int32_t compute_mod(std::int32_t x, std::int32_t y); // y's sign; by 0 it is 0

// A real number as an integer: towards zero; what does not fit is the nearest integer there is, NaN is 0.
struct IntegerResult {
    std::int32_t value = 0;
    bool fits = true; // else it is reported
};
IntegerResult convert_to_integer(float x);
IntegerResult raise_integer(std::int32_t base, std::int32_t exponent); // exponent >= 0

// random(i, salt): uniform in [0, 1), from the run's seed.
float draw_random(std::uint32_t seed, std::int32_t index, std::int32_t salt);

} // namespace photonloupe::script
