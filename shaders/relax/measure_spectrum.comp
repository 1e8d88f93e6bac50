// SPDX-License-Identifier: Apache-2.0
// Adds the waves exp(2πi k·x) of a block of points to the sum of each frequency k; an invocation owns one frequency.
// Inputs: points (two a texel), frequencies. In and out: sums (xy the sum, zw what rounding added to it).
#include "shared/prelude.glsl"
#include "shared/math.glsl"
#pragma binding texel points
#pragma binding readonly uvec2 frequencies
#pragma binding vec4 sums

layout(push_constant) uniform Push { uint frequency_first; uint frequency_count; uint pair_first; uint pair_end; };

// Points added plainly before the compensated sum takes them: of so few, rounding loses less than 1e-5.
const uint PLAIN_PAIRS = 64u;

// Whole turns overflow, so the fraction that is left of k·x is exact.
vec2 find_wave(uvec2 frequency, uvec2 point) {
    vec2 wave;
    sin_cos_turn(frequency.x * point.x + frequency.y * point.y, wave.y, wave.x);
    return wave;
}

vec2 add_waves(uvec2 frequency, uint first, uint end) {
    vec2 sum = vec2(0.0);
    for (uint pair = first; pair < end; ++pair) {
        // The upper three bits make the coordinates normal floats; what is below are 29-bit fractions.
        uvec4 fractions = floatBitsToUint(points_at(pair)) << 3u;
        sum += find_wave(frequency, fractions.xy) + find_wave(frequency, fractions.zw);
    }
    return sum;
}

// Kahan's step.
vec4 add_compensated(vec4 sum, vec2 part) {
    precise vec2 term = part - sum.zw;
    precise vec2 total = sum.xy + term;
    precise vec2 gained = total - sum.xy;
    precise vec2 excess = gained - term;
    return vec4(total, excess);
}

void main() {
    if (gl_GlobalInvocationID.x >= frequency_count) return;
    uint index = frequency_first + gl_GlobalInvocationID.x;
    uvec2 frequency = frequencies[index];
    vec4 sum = sums[index];
    for (uint first = pair_first; first < pair_end; first += PLAIN_PAIRS)
        sum = add_compensated(sum, add_waves(frequency, first, min(first + PLAIN_PAIRS, pair_end)));
    sums[index] = sum;
}
