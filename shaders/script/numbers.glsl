// SPDX-License-Identifier: Apache-2.0
// Arithmetic as scripts have it: NaN spreads, integers wrap, nothing is undefined.

bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }

// Any NaN gives NaN, -0 < +0.
float minimum_of(float a, float b) {
    float least = a < b || (a == b && floatBitsToUint(a) == 0x80000000u) ? a : b;
    return is_nan(a) || is_nan(b) ? NAN : least;
}
float maximum_of(float a, float b) {
    float most = a > b || (a == b && floatBitsToUint(b) == 0x80000000u) ? a : b;
    return is_nan(a) || is_nan(b) ? NAN : most;
}
int minimum_of(int a, int b) { return min(a, b); }
int maximum_of(int a, int b) { return max(a, b); }

float magnitude_bits(float x) { return uintBitsToFloat(floatBitsToUint(x) & 0x7fffffffu); }

// C's remainder: truncates, has the sign of a, is 0 by 0.
int modulo(int a, int b, uint site) {
    fault_if(b == 0, site);
    uint size = uint(abs(a)), by = b == 0 ? 1u : uint(abs(b));
    int rest = int(size % by);
    return a < 0 ? -rest : rest;
}

// The exact remainder of positive finite numbers, eight bits of the quotient at a time.
float find_remainder(float a, float b) {
    uint a_bits = floatBitsToUint(a), b_bits = floatBitsToUint(b);
    int a_exponent = max(int(a_bits >> 23u), 1), b_exponent = max(int(b_bits >> 23u), 1);
    uint rest = (a_bits & 0x7fffffu) | (a_bits >= 0x800000u ? 0x800000u : 0u);
    uint by = (b_bits & 0x7fffffu) | (b_bits >= 0x800000u ? 0x800000u : 0u);
    int shift = a_exponent - b_exponent;
    if (shift < 0) return a;
    rest %= by;
    for (; shift > 0 && take_turn(); shift -= 8) rest = (rest << uint(min(shift, 8))) % by;
    // rest · 2^(b_exponent - 150), in two exact factors
    return float(rest) * uintBitsToFloat(uint(b_exponent) << 23u) * uintBitsToFloat(0x34000000u);
}
float modulo(float a, float b, uint site) {
    fault_if(b == 0.0, site);
    float size = magnitude_bits(a), by = magnitude_bits(b);
    if (is_nan(a) || is_nan(b) || !is_finite(a)) return NAN;
    if (b == 0.0) return 0.0;
    float rest = is_finite(b) ? find_remainder(size, by) : size;
    return uintBitsToFloat(floatBitsToUint(rest) | (floatBitsToUint(a) & 0x80000000u));
}
